#pragma once

#include <vector>

#include "anatomy/patient.h"
#include "anatomy/tissue/tissue_table.h"
#include "tasks/needle.h"
#include "tasks/plan.h"
#include "tasks/task.h"
#include "telemetry/tick_sample.h"

namespace trocar::testing {

/// A body of boxes, 100 mm wide and high, voxels of 1 mm: the skin is the plane y = 0, behind it (towards the back) fat
/// to 10 mm, muscle to 20 mm, liver to 95 mm; in the liver a lesion (ball of 10 mm radius round (50, 60, 50)) and a
/// vessel (x from 20 to 25); a rib in the muscle at z from 70 to 80.
inline anatomy::VirtualPatient make_box_patient(bool has_lesion = true) {
  anatomy::VirtualPatient patient;
  volume::GridGeometry geometry;
  geometry.size = {100, 115, 100};
  geometry.origin_P = {0.5, -14.5, 0.5};
  patient.labels = volume::LabelGrid(geometry);
  patient.skin_distance_mm = volume::FloatGrid(geometry);
  patient.label_table.labels = {{1, "fat", "adipose"},        {2, "muscle", "muscle"},
                                {3, "liver", "liver"},        {4, "livertumor1", "liver_lesion"},
                                {5, "portal_vein", "vessel"}, {6, "rib_right_9", "bone"}};
  for (std::size_t i = 0; i < geometry.voxel_count(); ++i) {
    const volume::Index3 ijk = geometry.index_of(i);
    const Vec3 p_P = geometry.centre_mm(ijk);
    std::uint8_t label = 0;
    if (p_P.y() > 0.0) label = 1;
    if (p_P.y() > 10.0) label = p_P.z() > 70.0 && p_P.z() < 80.0 ? 6 : 2;
    if (p_P.y() > 20.0) label = p_P.x() > 20.0 && p_P.x() < 25.0 ? 5 : 3;
    if (has_lesion && (p_P - Vec3(50.0, 60.0, 50.0)).norm() < 10.0) label = 4;
    if (p_P.y() > 95.0) label = 0;
    patient.labels.voxels[i] = label;
    patient.skin_distance_mm.voxels[i] = static_cast<float>(-p_P.y());
  }
  return patient;
}

/// The throw reaches 22 mm beyond the tip, the notch from 1 to 18 mm.
inline tasks::Needle make_gun() {
  tasks::Needle needle;
  needle.is_biopsy = true;
  needle.throw_mm = 22.0;
  needle.notch_mm = 17.0;
  needle.dead_space_mm = 4.0;
  return needle;
}

inline tasks::Task make_box_task() {
  tasks::Task task;
  task.organ = "liver";
  task.target_tissues = {"liver_lesion"};
  task.weights = {{"target", 25.0}, {"core", 25.0},  {"risk", 20.0}, {"entry", 10.0},
                  {"angle", 10.0},  {"length", 5.0}, {"time", 5.0}};
  task.risks = {{"vessel", "", 5.0, false, tasks::Harm::kMajor}, {"bone", "", 5.0, false, tasks::Harm::kMinor}};
  return task;
}

/// Straight to the near side of the lesion: all of the notch lies in it.
inline tasks::PlannedPath make_box_plan() {
  tasks::PlannedPath plan;
  plan.line_P = {{50.0, 0.0, 50.0}, {50.0, 51.0, 50.0}};
  return plan;
}

inline anatomy::TissueTable make_box_tissues() {
  anatomy::TissueTable tissues;
  tissues.layers.resize(2);
  tissues.layers[0].name = "muscle";
  tissues.layers[1].name = "skin";
  return tissues;
}

/// An attempt along a straight line, a sample a ms: from 5 mm outside at 20 mm/s to the end and out again, with a
/// puncture of the skin `dent_mm` behind the resting skin. `fired` is the sample at the end.
struct Attempt {
  std::vector<telemetry::TickSample> samples;
  std::size_t fired = 0;
};
inline Attempt make_attempt(const Segment& line_P, double dent_mm = 0.6) {
  Attempt attempt;
  const double length_mm = line_P.length_mm();
  bool is_inside = false;
  const auto add = [&](double along_mm) {
    telemetry::TickSample sample;
    sample.time_s = 0.001 * static_cast<double>(attempt.samples.size());
    sample.tip_mm = line_P.a + along_mm * line_P.direction();
    sample.axis = line_P.direction();
    telemetry::set_at_rest(sample);
    sample.depth_mm = std::max(0.0, along_mm);
    if (!is_inside && along_mm >= dent_mm) {
      is_inside = true;
      sample.events[0] = {telemetry::EventKind::kPuncture, 1};
    }
    sample.phase = is_inside         ? telemetry::InsertionPhase::kInserted
                   : along_mm >= 0.0 ? telemetry::InsertionPhase::kLoading
                                     : telemetry::InsertionPhase::kOutside;
    if (sample.phase == telemetry::InsertionPhase::kLoading) sample.layer_displacement_mm = along_mm;
    attempt.samples.push_back(sample);
  };
  for (double along_mm = -5.0; along_mm < length_mm; along_mm += 0.02) add(along_mm);
  add(length_mm);
  attempt.fired = attempt.samples.size() - 1;
  for (double along_mm = length_mm; along_mm > -5.0; along_mm -= 0.05) add(along_mm);
  return attempt;
}

}  // namespace trocar::testing
