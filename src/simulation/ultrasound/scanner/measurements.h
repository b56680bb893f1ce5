#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/step_history.h"
#include "ultrasound/probe/scan_geometry.h"

/// Measurements in an image. Calipers are set in pixels and stored in mm of the image plane (x, y of T), so that they
/// are independent of image size and depth; converted back to pixels for drawing.
namespace trocar::ultrasound {

/// A straight line between two marks.
struct DistanceCaliper {
  Vec2 a_T{0.0, 0.0}, b_T{0.0, 0.0};

  double distance_mm() const noexcept { return (b_T - a_T).norm(); }
};
DistanceCaliper place_distance(const RasterGeometry& raster, const Vec2& a_pixel, const Vec2& b_pixel) noexcept;

/// An ellipse: the ends of one axis, and the distance of the outline from that axis.
struct EllipseCaliper {
  Vec2 a_T{0.0, 0.0}, b_T{0.0, 0.0};
  double half_width_mm = 0.0;  ///< Other semi-axis.

  double length_mm() const noexcept { return (b_T - a_T).norm(); }  ///< Length of the axis that was set first.
  double width_mm() const noexcept { return 2.0 * half_width_mm; }
  double area_mm2() const noexcept;
  /// Distance of a point from the line of the first axis: the other semi-axis of an ellipse whose outline extends to
  /// that distance.
  double distance_to_axis_mm(const Vec2& p_T) const noexcept;
  /// Exact, by the arithmetic-geometric mean.
  double circumference_mm() const noexcept;
  /// Points on the outline, `count` of them, evenly by angle.
  std::vector<Vec2> outline_T(int count) const;
};
/// `side_pixel` is a point beside the axis: its distance from the axis' line is the other semi-axis.
EllipseCaliper place_ellipse(const RasterGeometry& raster, const Vec2& a_pixel, const Vec2& b_pixel,
                             const Vec2& side_pixel) noexcept;

/// The angle at a corner between two arms.
struct AngleCaliper {
  Vec2 corner_T{0.0, 0.0}, a_T{0.0, 0.0}, b_T{0.0, 0.0};

  double angle_rad() const noexcept;  ///< 0..pi; 0 where an arm has no length.
};
AngleCaliper place_angle(const RasterGeometry& raster, const Vec2& corner_pixel, const Vec2& a_pixel,
                         const Vec2& b_pixel) noexcept;

using Measurement = std::variant<DistanceCaliper, EllipseCaliper, AngleCaliper>;

/// Measurements in one picture, with undo.
class Measurements {
 public:
  const std::vector<Measurement>& items() const noexcept { return history_.now(); }
  void add(const Measurement& measurement);
  /// Replaces a measurement; `joins`: shares one undo step with the last change (while the user drags a mark).
  void put(std::size_t item, const Measurement& measurement, bool joins);
  /// Has no effect if there is no such measurement.
  void remove(std::size_t item);
  void remove_last() { remove(items().size() - 1); }
  void clear();
  bool can_undo() const noexcept { return history_.can_undo(); }
  bool can_redo() const noexcept { return history_.can_redo(); }
  void undo() { history_.undo(); }
  void redo() { history_.redo(); }

 private:
  static constexpr std::size_t kMostSteps = 99;
  StepHistory<std::vector<Measurement>> history_{kMostSteps};
};

/// Marks of a measurement: both ends; ends of the axis and a point on the outline beside its middle; corner and both
/// arms.
std::vector<Vec2> marks_T(const Measurement& measurement);
/// Returns the measurement with one mark moved.
Measurement with_mark(Measurement measurement, std::size_t mark, const Vec2& p_T);

/// Text of a measurement in the form of a scanner, one string per line: "Dist 23.4 mm"; "Ell 40.2 x 31.0 mm", "Area
/// 9.79 cm2", "Circ 112.3 mm"; "Angle 43.2°". UTF-8.
std::vector<std::string> results(const Measurement& measurement);

}  // namespace trocar::ultrasound
