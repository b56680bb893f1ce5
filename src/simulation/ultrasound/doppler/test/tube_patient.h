#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "anatomy/patient.h"
#include "ultrasound/doppler/vessel_flow.h"
#include "volume/testing/centred_grid.h"

namespace trocar::testing {

/// A patient with labels only, centred on the origin. Each point has the first label whose shape contains it.
inline anatomy::VirtualPatient make_tube_patient(
    const Vec3& extent_mm, const Vec3& spacing_mm,
    const std::vector<std::pair<std::string, std::function<bool(const Vec3&)>>>& shapes) {
  anatomy::VirtualPatient patient;
  patient.name = "tubes";
  const volume::GridGeometry geometry = centred_grid(extent_mm, spacing_mm);
  patient.labels = volume::LabelGrid(geometry);
  for (std::size_t s = 0; s < shapes.size(); ++s)
    patient.label_table.labels.push_back({static_cast<std::uint8_t>(s + 1), shapes[s].first, "vessel", {}});
  for (std::size_t n = 0; n < geometry.voxel_count(); ++n) {
    const volume::Index3 at = geometry.index_of(n);
    const Vec3 p_P = geometry.centre_mm(at);
    for (std::size_t s = shapes.size(); s-- > 0;)
      if (shapes[s].second(p_P)) patient.labels.voxels[n] = static_cast<std::uint8_t>(s + 1);
  }
  return patient;
}

/// Steady flow from the head in "tube", with that speed in its middle.
inline ultrasound::FlowTable make_steady_table(double peak_cm_per_s, double profile_exponent) {
  ultrasound::FlowTable table;
  table.waveforms.push_back({"steady", {1.0, 1.0, 1.0, 1.0}, 0.0});
  ultrasound::FlowRule rule;
  rule.name = "tube";
  rule.labels = {"tube"};
  rule.at = ultrasound::FlowRule::At::kHead;
  rule.peak_cm_per_s = peak_cm_per_s;
  rule.profile_exponent = profile_exponent;
  table.rules.push_back(rule);
  return table;
}

}  // namespace trocar::testing
