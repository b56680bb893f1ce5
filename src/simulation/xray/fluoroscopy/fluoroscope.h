#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "motion/patient_motion.h"
#include "xray/contrast/contrast_table.h"
#include "xray/detector/detector.h"
#include "xray/fluoroscopy/display.h"
#include "xray/fluoroscopy/exposure_control.h"
#include "xray/projection/xray_volume.h"
#include "xray/tools/tool_shape.h"

namespace trocar::xray {

/// Kind of the displayed image.
enum class ImageMode {
  kLive,
  /// Digital subtraction: the first frames make the mask, later ones show what was added.
  kSubtraction,
  /// Live, with the greatest opacification of the last subtraction.
  kRoadMap
};

/// Request to a fluoroscope: present state of room and patient, and settings.
struct FluoroscopyRequest {
  CArm arm;
  Tube filters;  ///< Filtration; exposure control selects the voltage.
  DoseMode dose_mode = DoseMode::kNormal;
  double pulses_per_s = 15.0;            ///< One of kPulseRates_per_s.
  std::vector<ToolShape> tools;          ///< In P.
  std::shared_ptr<const Iodine> iodine;  ///< In the body at rest; nullptr: none. Another pointer: changed.
  motion::PatientMotion motion;          ///< Where the patient is.
  bool is_pedal_down = false;
  double time_s = 0.0;  ///< Must not decrease while one patient is examined.
  ImageMode mode = ImageMode::kLive;
  DisplaySettings display;
};

/// One image of a fluoroscope.
struct FluoroscopyFrame {
  image::GrayImage gray;  ///< Black before the first pulse.
  bool is_held = true;    ///< The pedal is up: last-image hold.
  bool is_subtracted = false;
  int mask_frames = 0;  ///< Frames in the mask of the subtraction.
  CArm arm;             ///< At the time of the pulse, as the next five.
  motion::PatientMotion motion;
  Exposure exposure;
  double time_s = 0.0;
  GrayWindow window;
  Dose dose;  ///< Of the examination so far.
  std::uint64_t number = 0;
  double took_ms = 0.0;
};

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
