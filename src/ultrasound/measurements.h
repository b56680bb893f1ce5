#pragma once

#include <string>
#include <variant>
#include <vector>

#include "core/step_history.h"
#include "ultrasound/caliper.h"

namespace trocar {

using Measurement = std::variant<DistanceCaliper, EllipseCaliper, AngleCaliper>;

/// What has been measured in one picture, with undo.
class Measurements {
 public:
  const std::vector<Measurement>& items() const noexcept { return history_.now(); }
  void add(const Measurement& measurement);
  /// The newest; nothing where there is none.
  void remove_last();
  void clear();
  bool can_undo() const noexcept { return history_.can_undo(); }
  bool can_redo() const noexcept { return history_.can_redo(); }
  void undo() { history_.undo(); }
  void redo() { history_.redo(); }

 private:
  static constexpr std::size_t kMostSteps = 99;
  StepHistory<std::vector<Measurement>> history_{kMostSteps};
};

/// What a scanner says of it, a line each: "Dist 23.4 mm"; "Ell 40.2 x 31.0 mm", "Area 9.79 cm2", "Circ 112.3 mm";
/// "Angle 43.2°". UTF-8.
std::vector<std::string> results(const Measurement& measurement);

}  // namespace trocar
