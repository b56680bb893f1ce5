#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

#include "ultrasound/sweep/tracked_sequence.h"

namespace trocar::ultrasound {

/// Named frames and the transforms between them from a tracker and a calibration, like PLUS' transform repository.
class TransformGraph {
 public:
  using Matrix4 = TrackedSequence::Matrix4;

  /// Adds transforms; replaces one of the same name. "ProbeToTracker" joins Probe and Tracker in both directions,
  /// unless its matrix has no inverse. Names that are not "<Frame>To<Frame>" are ignored.
  void add(const TrackedSequence::Transforms& transforms);
  /// Maps points of `from` to points of `to`, by the fewest transforms; empty if the frames are not joined.
  std::optional<Matrix4> find(std::string_view from, std::string_view to) const;
  /// Explains a failed find() for the user: lists the known transforms and the end of the chain.
  std::string explain(std::string_view from, std::string_view to) const;

 private:
  TrackedSequence::Transforms transforms_;
};

}  // namespace trocar::ultrasound
