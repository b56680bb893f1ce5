#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/step_history.h"
#include "ultrasound/scanner/caliper.h"

namespace trocar::ultrasound {

using Measurement = std::variant<DistanceCaliper, EllipseCaliper, AngleCaliper>;

/// What has been measured in one picture, with undo.
class Measurements {
 public:
  const std::vector<Measurement>& items() const noexcept { return history_.now(); }
  void add(const Measurement& measurement);
  /// Another one in its place; `joins`: one step of undo with the last (an end that is still held).
  void put(std::size_t item, const Measurement& measurement, bool joins);
  /// Nothing where there is none such.
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

/// The marks that it was set by: both ends; ends of the axis and a place on the outline beside its middle; corner and
/// both arms.
std::vector<Vec2> marks_T(const Measurement& measurement);
/// With one of these at another place.
Measurement with_mark(Measurement measurement, std::size_t mark, const Vec2& p_T);

/// Text of a measurement as on a scanner, one line each: "Dist 23.4 mm"; "Ell 40.2 x 31.0 mm", "Area 9.79 cm2",
/// "Circ 112.3 mm"; "Angle 43.2°". UTF-8.
std::vector<std::string> results(const Measurement& measurement);

}  // namespace trocar::ultrasound
