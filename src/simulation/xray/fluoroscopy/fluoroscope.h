#pragma once

#include <memory>

#include "xray/detector/detector_params.h"
#include "xray/fluoroscopy/fluoroscopy_frame.h"
#include "xray/projection/xray_volume.h"

namespace trocar::xray {

/// A fluoroscope with one patient: images, and the state between them (lag, mask and road map, window, dose). Not for
/// several threads at a time; a frame is computed on all cores.
class Fluoroscope {
 public:
  static constexpr int kMaskFrames = 4;

  explicit Fluoroscope(std::shared_ptr<const XrayVolume> volume, const DetectorParams& detector = {},
                       const ExposureLimits& limits = {});
  ~Fluoroscope();
  Fluoroscope(Fluoroscope&&) noexcept;
  Fluoroscope& operator=(Fluoroscope&&) noexcept;

  /// The image for a request. With the pedal down, a new exposure at each pulse of the pulse rate; between pulses and
  /// with the pedal up, the last image as the request displays it. The patient's masses are kept while C-arm and motion
  /// stay. The noise follows `seed`. Dose counts all pulses since the last request. Errors: an impossible C-arm or
  /// tube, source or detector inside the patient, an unknown pulse rate.
  Result<FluoroscopyFrame> frame(const FluoroscopyRequest& request, std::uint64_t seed);

  const Dose& dose() const noexcept;
  void reset_dose() noexcept;
  /// Signal of the last exposure (1: open beam), before the display; empty before the first. For files and tests.
  const std::vector<float>& signal() const noexcept;
  /// Signal before noise, blur and lag.
  const std::vector<float>& clean_signal() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::xray
