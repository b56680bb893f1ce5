#pragma once

#include <array>
#include <vector>

#include "ultrasound/probe/detail/view_anatomy.h"
#include "ultrasound/probe/probe_view.h"
#include "ultrasound/probe/scan_geometry.h"

/// Visible share of a view's subject from a pose, by straight scanlines through the labels (docs/physics.md U16).
namespace trocar::ultrasound::detail {

class ViewRays {
 public:
  /// Refers to `ground`, which must outlive it.
  ViewRays(const ViewAnatomy& ground, const ProbeView& view, const Transducer& transducer, const Vec3& target_P);

  ViewVisibility measure(const Pose& X_PT) const;

 private:
  static constexpr int kLines = 33;

  /// Cause of a scanline's end.
  enum class End : std::uint8_t { kPicture, kBone, kGas, kUnscanned };
  struct Ray {
    double end_mm = 0.0;
    End end = End::kPicture;
    double subject_mm = -1.0;  ///< First sample of the subject near the target; negative: none.
    bool has_left = false;     ///< The scanline left the CT near the target.
  };
  Ray trace(const Pose& X_PT, int line, const Vec2& target_T) const;
  double weight(double line) const noexcept;
  double penetration_share(double depth_mm) const noexcept;
  bool is_subject(const Vec3& p_P, bool& is_unscanned_there) const;
  ViewVisibility measure_area(const Pose& X_PT, const std::vector<Ray>& rays, const Vec2& target_T) const;
  ViewVisibility measure_surface(const std::vector<Ray>& rays, const Vec2& target_T) const;

  const ViewAnatomy& ground_;
  ScanGeometry scan_;
  Vec3 target_P_;
  std::array<bool, 256> is_subject_{};  ///< By label.
  bool is_surface_ = false;
  bool is_between_ribs_ = false;
  bool shows_bone_ = false;  ///< All bone is part of the subject, at any distance from the target.
  double frequency_mhz_ = 3.5;
};

}  // namespace trocar::ultrasound::detail
