#pragma once

#include <algorithm>
#include <cmath>

#include "anatomy/patient.h"
#include "storage/session_file.h"

namespace trocar::testing {

/// A body of 120x100x80 mm with a liver in it, its centre at the origin of P.
inline anatomy::VirtualPatient example_patient() {
  anatomy::VirtualPatient patient;
  patient.name = "box";
  patient.content_hash = "00112233445566778899aabbccddeeff";
  volume::GridGeometry geometry;
  geometry.size = {30, 25, 20};
  geometry.spacing_mm = {4, 4, 4};
  geometry.origin_P = {-58, -48, -38};
  patient.ct = volume::CtGrid(geometry, -1000);
  patient.labels = volume::LabelGrid(geometry, 0);
  patient.label_table.labels = {{1, "liver", "liver", {150, 68, 52}}, {2, "fat", "adipose", {240, 205, 105}}};
  for (std::size_t n = 0; n < geometry.voxel_count(); ++n) {
    const volume::Index3 ijk = geometry.index_of(n);
    const Vec3 p_P = geometry.centre_mm(ijk);
    if (p_P.cwiseAbs().maxCoeff() < 35.0) {
      patient.ct.voxels[n] = p_P.norm() < 20.0 ? std::int16_t{60} : std::int16_t{-100};
      patient.labels.voxels[n] = p_P.norm() < 20.0 ? 1 : 2;
    }
  }
  return patient;
}

/// A made-up attempt of 8 s: along +y from y = -40 mm to the origin, three layers that give way at 2, 12 and 22 mm.
inline storage::Session example_attempt() {
  constexpr double kLayerDepths_mm[] = {2.0, 12.0, 22.0};
  constexpr double kLayerForces_n[] = {2.8, 2.5, 1.5};
  storage::Session session;
  storage::SessionInfo& info = session.info;
  info.program_version = "0.1.0";
  info.started_utc = "2026-01-02T03:04:05Z";
  info.task = "liver-biopsy";
  info.patient_name = "box";
  info.patient_hash = "00112233445566778899aabbccddeeff";
  info.operator_name = "expert";
  info.needle = "biopsy-18g";
  info.tissue_table_toml = "liver.friction_mu = 0.58";
  info.plan_P = {"plan", {{0, -40, 0}, {0, 0, 0}}};
  info.tissue_names = {"air", "skin", "adipose", "muscle", "liver"};
  info.layer_names = {"skin", "muscle", "liver_capsule"};
  std::size_t layer = 0;
  for (int n = 0; n < 8000; ++n) {
    telemetry::TickSample s;
    s.time_s = 0.001 * n;
    const double way_mm = 10.0 * std::min(s.time_s, 5.0) - 10.0;  // 1 s to the skin, 4 s in, 3 s at rest
    s.tip_mm = {0.0, -40.0 + way_mm, 0.0};
    s.axis = Vec3::UnitY();
    telemetry::set_at_rest(s);
    s.depth_mm = std::max(0.0, way_mm);
    s.phase = way_mm <= 0.0 ? telemetry::InsertionPhase::kOutside : telemetry::InsertionPhase::kInserted;
    s.axial_velocity_mm_s = s.time_s < 5.0 ? 10.0 : 0.0;
    s.tissue = way_mm <= 0.0 ? 0 : static_cast<std::uint8_t>(1 + std::min(3, static_cast<int>(way_mm / 8.0)));
    if (layer > 0) s.f_friction_n = -0.1 * static_cast<double>(layer);
    if (layer == 3) s.f_cutting_n = -0.4;
    if (layer < 3 && way_mm > kLayerDepths_mm[layer] - 2.0) {
      s.phase = telemetry::InsertionPhase::kLoading;
      s.f_prepuncture_n = -kLayerForces_n[layer] * std::min(1.0, (way_mm - kLayerDepths_mm[layer] + 2.0) / 2.0);
      if (layer == 2) s.f_friction_n = -0.3;
      if (way_mm >= kLayerDepths_mm[layer] - 1e-9) {
        s.events[0] = {telemetry::EventKind::kPuncture, static_cast<std::uint8_t>(layer)};
        ++layer;
      }
    }
    s.f_total_n = s.axis * (s.f_prepuncture_n + s.f_friction_n + s.f_cutting_n);
    s.device_f_n = s.f_total_n;
    session.samples.push_back(s);
  }
  session.shots = {6000};
  scoring::Outcome outcome;
  outcome.score = 83.2;
  outcome.target_reached = true;
  outcome.parts = {{"target", "Distance to the target", 0.4, "mm", 24, 25}, {"risk", "Risks", 1, "", 0, 20}};
  outcome.hints = {{"Hold the needle flatter.", {}}};
  outcome.cores.emplace_back();
  outcome.cores.back().pieces = {{"liver", "liver", 0.0, 8.0}, {"lesion", "liver_lesion", 8.0, 19.0}};
  outcome.cores.back().target_mm = 11.0;
  outcome.cores.back().organ_mm = 8.0;
  outcome.cores.back().risks_in_throw = {"gallbladder"};
  session.outcome = outcome;
  return session;
}

}  // namespace trocar::testing
