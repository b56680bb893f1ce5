#pragma once

#include <array>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "ultrasound/probe/probe_view.h"
#include "ultrasound/tissue/scan_ends.h"

namespace trocar::ultrasound::detail {

/// A patient as the placement of a transducer sees him. Frame P, mm. Refers to the patient.
struct ViewAnatomy {
  const anatomy::VirtualPatient& patient;
  std::array<bool, 256> is_bone{}, is_lung{}, is_through{};  ///< By label.
  std::vector<ScanEnd> ends;

  ViewAnatomy(const anatomy::VirtualPatient& of, const ProbeView& view);

  double skin_mm(const Vec3& p_P) const noexcept;    ///< Negative inside.
  Vec3 skin_normal(const Vec3& p_P) const noexcept;  ///< Outwards, unit, of a patch of some millimetres.
  Vec3 on_skin(Vec3 p_P) const noexcept;             ///< The point of the skin near a point.
  bool contains(const Vec3& p_P) const noexcept;     ///< The CT does.
  std::uint8_t label_at(const Vec3& p_P) const noexcept;
  bool is_gas_at(const Vec3& p_P) const noexcept;  ///< By its HU.
};

/// The point of the patient that a view aims at. Errors: the patient lacks the view's target.
Result<Vec3> find_target_point(const anatomy::VirtualPatient& patient, const ProbeView& view);

}  // namespace trocar::ultrasound::detail
