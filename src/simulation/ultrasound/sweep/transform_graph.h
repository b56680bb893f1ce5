#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

#include "ultrasound/sweep/tracked_sequence.h"

namespace trocar::ultrasound {

/// Named frames and the transforms between them, as a tracker and a calibration give them: PLUS' transform repository.
class TransformGraph {
 public:
  using Matrix4 = TrackedSequence::Matrix4;

  /// Adds them; one of the same name is replaced. "ProbeToTracker" joins Probe and Tracker both ways, unless its matrix
  /// has no inverse. Names that are not "<Frame>To<Frame>" are left aside.
  void add(const TrackedSequence::Transforms& transforms);
  /// Points of `from` to points of `to`, by the fewest transforms; nothing where they are not joined.
  std::optional<Matrix4> find(std::string_view from, std::string_view to) const;
  /// Explains a failed find() for the user: known transforms, and where the chain ends.
  std::string explain(std::string_view from, std::string_view to) const;

 private:
  TrackedSequence::Transforms transforms_;
};

}  // namespace trocar::ultrasound
