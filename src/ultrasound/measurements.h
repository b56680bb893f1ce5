#pragma once

#include <string>
#include <variant>
#include <vector>

#include "ultrasound/caliper.h"

namespace trocar {

using Measurement = std::variant<DistanceCaliper, EllipseCaliper, AngleCaliper>;

/// What has been measured in one picture, with undo.
class Measurements {
 public:
  const std::vector<Measurement>& items() const noexcept { return states_[now_]; }
  void add(const Measurement& measurement);
  /// The newest; nothing where there is none.
  void remove_last();
  void clear();
  bool can_undo() const noexcept { return now_ > 0; }
  bool can_redo() const noexcept { return now_ + 1 < states_.size(); }
  void undo() noexcept { now_ -= can_undo() ? 1 : 0; }
  void redo() noexcept { now_ += can_redo() ? 1 : 0; }

 private:
  void change(std::vector<Measurement> items);

  static constexpr std::size_t kMostStates = 100;
  std::vector<std::vector<Measurement>> states_{{}};
  std::size_t now_ = 0;
};

/// What a scanner says of it, a line each: "Dist 23.4 mm"; "Ell 40.2 x 31.0 mm", "Area 9.79 cm2", "Circ 112.3 mm";
/// "Angle 43.2°". UTF-8.
std::vector<std::string> results(const Measurement& measurement);

}  // namespace trocar
