#include "phantom/consistency.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "phantom/torso_patient.h"
#include "volume/sampling.h"

namespace trocar::phantom {
namespace {

double diagonal_mm(const anatomy::VirtualPatient& patient) {
  return patient.labels.geometry.spacing_mm.norm();
}

void check_skin(const anatomy::VirtualPatient& patient, std::vector<std::string>& found) {
  std::size_t outside = 0, missing = 0;
  for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n) {
    const bool is_inside = patient.skin_distance_mm.voxels[n] < 0.0F;
    outside += !is_inside && patient.labels.voxels[n] != 0;
    missing += is_inside && patient.labels.voxels[n] == 0;
  }
  if (outside > 0) found.push_back(fmt::format("{} labelled voxels are outside the skin", outside));
  if (missing > 0) found.push_back(fmt::format("{} voxels of the body have no label", missing));
}

/// Free fluid must be enclosed by the abdomen.
void check_fluid(const anatomy::VirtualPatient& patient, std::vector<std::string>& found) {
  std::array<bool, 256> is_fluid{}, is_leak{};
  is_leak[0] = true;
  for (const anatomy::Label& label : patient.label_table.labels) {
    is_fluid[label.id] = label.tissue == "ascites";
    is_leak[label.id] = label.tissue == "lung" || label.tissue == "skin";
  }
  const volume::LabelGrid& labels = patient.labels;
  std::size_t leaks = 0;
  for (std::size_t n = 0; n < labels.voxels.size(); ++n) {
    if (!is_fluid[labels.voxels[n]]) continue;
    const volume::Index3 at = labels.geometry.index_of(n);
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const std::int64_t step : {-1, 1}) {
        volume::Index3 next = at;
        next[axis] += step;
        leaks += !labels.geometry.contains(next) || is_leak[labels[next]];
      }
  }
  if (leaks > 0) found.push_back(fmt::format("free fluid leaks at {} faces of voxels", leaks));
}

void check_landmarks(const anatomy::VirtualPatient& patient, std::vector<std::string>& found) {
  for (const anatomy::Landmark& landmark : patient.landmarks) {
    if (landmark.name == kHilumLandmark) continue;
    const double off_mm = volume::sample_linear(patient.skin_distance_mm, landmark.p_P);
    if (std::abs(off_mm) > diagonal_mm(patient))
      found.push_back(fmt::format("the landmark \"{}\" is {:.1f} mm off the skin", landmark.name, off_mm));
  }
}

void check_path(const anatomy::VirtualPatient& patient, const anatomy::NeedlePath& path,
                std::vector<std::string>& found) {
  constexpr std::array<std::string_view, 6> kRisks{"bone", "vessel", "bowel", "lung", "kidney", "gallbladder"};
  constexpr double kStep_mm = 0.25;
  const double entry_mm = volume::sample_linear(patient.skin_distance_mm, path.line_P.a);
  if (std::abs(entry_mm) > diagonal_mm(patient))
    found.push_back(fmt::format("the path \"{}\" begins {:.1f} mm off the skin", path.name, entry_mm));
  std::array<double, kRisks.size()> within_mm{};
  for (double along = 0.0; along < path.line_P.length_mm(); along += kStep_mm) {
    const anatomy::Label* label = anatomy::find_label(patient, path.line_P.a + along * path.line_P.direction());
    if (label == nullptr) continue;
    const auto risk = std::find(kRisks.begin(), kRisks.end(), label->tissue);
    if (risk != kRisks.end()) within_mm[static_cast<std::size_t>(risk - kRisks.begin())] += kStep_mm;
  }
  for (std::size_t n = 0; n < kRisks.size(); ++n)
    if (within_mm[n] > diagonal_mm(patient))
      found.push_back(fmt::format("the path \"{}\" goes through {:.1f} mm of {}", path.name, within_mm[n], kRisks[n]));
}

}  // namespace

std::vector<std::string> find_contradictions(const anatomy::VirtualPatient& patient) {
  std::vector<std::string> found;
  check_skin(patient, found);
  check_fluid(patient, found);
  check_landmarks(patient, found);
  for (const anatomy::NeedlePath& path : patient.paths) check_path(patient, path, found);
  return found;
}

}  // namespace trocar::phantom
