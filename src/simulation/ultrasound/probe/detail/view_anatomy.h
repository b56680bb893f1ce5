#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "ultrasound/probe/probe_view.h"
#include "ultrasound/tissue/scan_ends.h"

namespace trocar::ultrasound::detail {

/// Patient data for the placement of a transducer. Frame P, mm. Refers to the patient.
struct ViewAnatomy {
  const anatomy::VirtualPatient& patient;
  std::array<bool, 256> is_bone{}, is_lung{}, is_through{};  ///< By label.
  std::vector<ScanEnd> ends;

  ViewAnatomy(const anatomy::VirtualPatient& of, const ProbeView& view);

  double skin_mm(const Vec3& p_P) const noexcept;    ///< Negative inside.
  Vec3 skin_normal(const Vec3& p_P) const noexcept;  ///< Outwards, unit, of a patch of some millimetres.
  Vec3 on_skin(Vec3 p_P) const noexcept;             ///< Projects a point onto the skin nearby.
  bool contains(const Vec3& p_P) const noexcept;     ///< True if the CT contains the point.
  std::uint8_t label_at(const Vec3& p_P) const noexcept;
  bool is_gas_at(const Vec3& p_P) const noexcept;  ///< From the HU value.
};

/// The point of the patient that a view aims at. Errors: the patient lacks the view's target.
Result<Vec3> find_target_point(const anatomy::VirtualPatient& patient, const ProbeView& view);

/// Normal form of a label's name or pattern for comparison: only lower case letters, digits and '*'.
std::string plain_name(std::string_view name);
/// True if a plain name matches a plain pattern; '*' matches any ending.
bool matches_pattern(std::string_view pattern, std::string_view name) noexcept;

}  // namespace trocar::ultrasound::detail
