#pragma once

#include <memory>
#include <optional>

#include "ultrasound/live/scan_picture.h"
#include "ultrasound/scanner/cine_loop.h"

namespace trocar::ultrasound {

/// Engine, receiver, colour and cine loop of one transducer on one patient, used by one thread: renders a request and
/// stores it in the loop, or displays a stored frame. Buffers of each detail are allocated at first use.
class PictureMaker {
 public:
  PictureMaker(std::shared_ptr<const AcousticScene> scene, Transducer transducer);
  ~PictureMaker();
  PictureMaker(PictureMaker&&) noexcept;
  PictureMaker& operator=(PictureMaker&&) noexcept;

  const Transducer& transducer() const noexcept;

  /// Renders a picture and stores it in the loop unless the loop is frozen; `seed` is the seed of the noise. The
  /// request is clamped to its ranges.
  ScanPicture make(const ScanRequest& request, ScanDetail detail, std::uint64_t seed);

  /// The loop at full detail: at most kCineFrames and kCineBytes. A change of depth begins a new loop. nullptr before
  /// the first picture.
  CineLoop* cine() noexcept;
  /// Shows the loop's selected frame with the request's gain, dynamic range, gray map, mirroring and size. Needs a loop
  /// with a frame.
  ScanPicture show_kept(const ScanRequest& request);

  static constexpr int kCineFrames = 200;
  static constexpr std::size_t kCineBytes = std::size_t{48} << 20;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::ultrasound
