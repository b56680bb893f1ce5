#pragma once

#include <memory>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "motion/breathing_choice.h"
#include "motion/motion_model.h"

namespace trocar::motion_builder {

struct BreathingOptions {
  /// How far (mm) the liver was below its place at end-expiration when the CT was taken. Range -20..40.
  double ct_inhaled_mm = 0.0;
};

/// How breathing moves a patient without 4D CT, from the labels: two regions, the wall and what slides inside of it,
/// and two modes, "diaphragm" and "chest". With the first driver at 1 the liver moves down by motion::kDeepLiver_mm on
/// average. Organs are drawn along with it, ribs turn about their necks, spine and pelvis rest; everything between is
/// an elastic body that hardly changes its volume, except for the lungs (docs/physics.md, B1 to B4). Errors: no organ
/// that breathing moves, no bone.
Result<std::shared_ptr<const motion::MotionModel>> make_breathing_model(const anatomy::VirtualPatient& patient,
                                                                        const BreathingOptions& options = {},
                                                                        const Progress& progress = {});

/// Gives a patient that has no motion model this one; a patient that cannot have one stays at rest, and the log says
/// why.
void add_breathing_model(anatomy::VirtualPatient& patient, const Progress& progress = {});

/// Mean motion (mm, frame P) of a structure where one driver is 1 and the others are 0.
struct StructureMotion {
  std::string name;
  std::vector<Vec3> by_driver_mm;
};
/// Of the organs that breathing moves, as far as they are labelled; in the order of the label table.
std::vector<StructureMotion> structure_motions(const anatomy::VirtualPatient& patient,
                                               const motion::MotionModel& model);

}  // namespace trocar::motion_builder
