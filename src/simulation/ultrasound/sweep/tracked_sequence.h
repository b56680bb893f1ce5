#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace trocar::ultrasound {

/// 2D gray images with their poses from a tracker, in the form that PLUS and 3D Slicer write as .igs.mha. The external
/// names are kept: "ProbeToTracker" maps points of Probe to Tracker and is X_TrackerProbe here. Transforms are
/// matrices, because calibrations (ImageToProbe) scale pixels to mm. Frame "Image": column, row, 0; pixel centres at
/// integers.
struct TrackedSequence {
  using Matrix4 = Eigen::Matrix4d;
  using Transforms = std::map<std::string, Matrix4, std::less<>>;  ///< "ProbeToTracker" -> matrix.

  struct Frame {
    double time_s = 0.0;    ///< On the recorder's clock.
    bool is_valid = true;   ///< ImageStatus is OK.
    Transforms transforms;  ///< Only those whose status is OK.
  };

  int columns = 0;
  int rows = 0;
  std::vector<std::uint8_t>
      pixels;  ///< Frame by frame, row by row: columns to the marked side, rows away from the face.
  std::vector<Frame> frames;

  std::size_t frame_pixels() const noexcept {
    return static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  }
  std::span<const std::uint8_t> picture(std::size_t frame) const noexcept {
    return std::span(pixels).subspan(frame * frame_pixels(), frame_pixels());
  }
};

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
