#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/step_history.h"
#include "ultrasound/scanner/caliper.h"

namespace trocar::ultrasound {

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
