#include "xray/fluoroscopy/fluoroscope.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "xray/detector/detector.h"
#include "xray/detector/scatter.h"
#include "xray/fluoroscopy/detail/patient_image.h"
#include "xray/fluoroscopy/display.h"

namespace trocar::xray {
namespace {

constexpr float kWindowPace = 0.3F;       ///< Share by which the window follows the image at each pulse.
constexpr float kLeastDifference = 0.3F;  ///< Width of a subtraction's window at least.
constexpr float kRoadMapLeast = 0.06F;    ///< Opacification from which a road map shows,
constexpr float kRoadMapFull = 0.4F;      ///< and that it shows fully.

Status check_request(const FluoroscopyRequest& request) {
  const bool is_known =
      std::find(kPulseRates_per_s.begin(), kPulseRates_per_s.end(), request.pulses_per_s) != kPulseRates_per_s.end();
  if (!is_known)
    return fail_usage(fmt::format("the pulse rate is {:g} per s", request.pulses_per_s), "fluoroscopy",
                      "choose 7.5, 15 or 30");
  if (!std::isfinite(request.time_s) || !request.motion.is_finite())
    return fail_usage("time or motion of the patient is not a finite number", "fluoroscopy", "repair the caller");
  return {};
}

}  // namespace

struct Fluoroscope::Impl {
  DetectorParams detector;
  ExposureLimits limits;
  detail::PatientImage patient;
  detail::AddedSignal added;
  Lag lag;
  Dose dose;
  std::vector<float> clean, signal;
  MaskSubtraction mask;
  RoadMap road_map;
  std::vector<float> difference;     ///< Of the last exposure, if it was subtracted.
  std::optional<GrayWindow> window;  ///< Of live images.
  bool window_is_logarithmic = true;
  std::optional<FluoroscopyFrame> last;  ///< Of the last exposure; `gray` is not used.
  bool was_pedal_down = false;
  ImageMode last_mode = ImageMode::kLive;

  Impl(std::shared_ptr<const XrayVolume> volume, const DetectorParams& params, const ExposureLimits& exposure)
      : detector(params), limits(exposure), patient(std::move(volume), params) {}

  int pulses_due(const FluoroscopyRequest& request) const;
  Status expose(const FluoroscopyRequest& request, int pulses, std::uint64_t seed);
  void make_signal(const FluoroscopyRequest& request, double elapsed_s, std::uint64_t seed);
  void subtract(const FluoroscopyRequest& request, bool is_new_run);
  FluoroscopyFrame show(const FluoroscopyRequest& request, bool is_new);
};

/// Pulses since the last exposure; one at once when the pedal goes down.
int Fluoroscope::Impl::pulses_due(const FluoroscopyRequest& request) const {
  if (!request.is_pedal_down) return 0;
  if (!was_pedal_down || !last || request.time_s < last->time_s) return 1;
  constexpr double kMost = 1000.0;  // a caller that paused for minutes
  const auto number = [&](double time_s) { return std::floor(time_s * request.pulses_per_s + 1e-6); };
  return static_cast<int>(std::min(number(request.time_s) - number(last->time_s), kMost));
}

void Fluoroscope::Impl::make_signal(const FluoroscopyRequest& request, double elapsed_s, std::uint64_t seed) {
  const CArm& arm = request.arm;
  const double pixel_mm = arm.field_mm / arm.pixels;
  added.apply(request, patient, clean);
  blur_image(clean, arm.pixels, arm.pixels, focal_spot_sigma_mm(detector, arm) / pixel_mm);
  add_scatter(patient.scatter(), arm.pixels, arm.pixels, clean);
  signal = clean;
  const double photons_per_mm2 =
      at_distance(patient.beam().detected_photons(), arm.source_detector_mm) * patient.exposure().mas;
  const double photons = photons_per_mm2 * pixel_mm * pixel_mm * detector.grid_primary;
  add_quantum_noise({photons, patient.beam().noise_factor()}, seed, signal);
  blur_image(signal, arm.pixels, arm.pixels, scintillator_sigma_mm(detector) / pixel_mm);
  if (elapsed_s <= 0.0) lag.reset();
  lag.apply(detector.lag_share, elapsed_s, signal);
}

/// The mask begins anew with each run: another C-arm, another press of the pedal, the mode switched on.
void Fluoroscope::Impl::subtract(const FluoroscopyRequest& request, bool is_new_run) {
  difference.clear();
  const bool is_moved = last && !(last->arm == request.arm);
  if (is_moved) road_map.clear();
  if (request.mode != ImageMode::kSubtraction) return;
  if (is_new_run || is_moved || last_mode != ImageMode::kSubtraction) {
    mask.clear();
    road_map.clear();
  }
  if (mask.mask_frames() < kMaskFrames) mask.add_mask(signal);
  difference = mask.difference(signal);
  if (mask.mask_frames() == kMaskFrames) road_map.add(difference);
}

Status Fluoroscope::Impl::expose(const FluoroscopyRequest& request, int pulses, std::uint64_t seed) {
  TROCAR_TRY_STATUS(patient.update(request, limits));
  const bool is_new_run = !was_pedal_down || !last || request.time_s < last->time_s;
  make_signal(request, is_new_run ? 0.0 : request.time_s - last->time_s, seed);
  subtract(request, is_new_run);
  add_pulses(pulses, patient.exposure().mas, patient.beam().air_kerma_mgy(), request.arm, dose);
  dose.beam_on_s += pulses / request.pulses_per_s;
  FluoroscopyFrame made;
  made.arm = request.arm;
  made.motion = request.motion;
  made.exposure = patient.exposure();
  made.time_s = request.time_s;
  made.is_subtracted = !difference.empty();
  made.mask_frames = mask.mask_frames();
  last = std::move(made);
  last_mode = request.mode;
  return {};
}

FluoroscopyFrame Fluoroscope::Impl::show(const FluoroscopyRequest& request, bool is_new) {
  const int pixels = last->arm.pixels;
  const FieldPixels field = field_pixels(last->arm);
  FluoroscopyFrame frame = *last;
  frame.dose = dose;
  frame.is_held = !request.is_pedal_down;
  if (frame.is_subtracted) {
    GrayWindow range = window_of(difference, signal, pixels, field, kLeastDifference);
    // Half of the least width below zero, so that the background is a light gray.
    range.low = std::min(range.low, -0.5F * kLeastDifference);
    frame.window = request.display.window.value_or(range);
    frame.gray = to_gray(difference, pixels, pixels, frame.window, request.display.is_inverted, field);
    return frame;
  }
  const std::vector<float> values = shown_values(signal, pixels, pixels, request.display, field);
  const bool is_other_kind = request.display.is_logarithmic != window_is_logarithmic;
  if (is_other_kind) window.reset();
  window_is_logarithmic = request.display.is_logarithmic;
  if (is_new || !window) {
    const GrayWindow fresh = window_of(values, signal, pixels, field);
    const float pace = window ? kWindowPace : 1.0F;
    const GrayWindow former = window.value_or(fresh);
    window = GrayWindow{former.low + pace * (fresh.low - former.low), former.high + pace * (fresh.high - former.high)};
  }
  frame.window = request.display.window.value_or(*window);
  frame.gray = to_gray(values, pixels, pixels, frame.window, request.display.is_inverted, field);
  if (request.mode == ImageMode::kRoadMap) road_map.overlay(kRoadMapLeast, kRoadMapFull, frame.gray);
  return frame;
}

Fluoroscope::Fluoroscope(std::shared_ptr<const XrayVolume> volume, const DetectorParams& detector,
                         const ExposureLimits& limits)
    : impl_(std::make_unique<Impl>(std::move(volume), detector, limits)) {}
Fluoroscope::~Fluoroscope() = default;
Fluoroscope::Fluoroscope(Fluoroscope&&) noexcept = default;
Fluoroscope& Fluoroscope::operator=(Fluoroscope&&) noexcept = default;

Result<FluoroscopyFrame> Fluoroscope::frame(const FluoroscopyRequest& request, std::uint64_t seed) {
  Impl& impl = *impl_;
  TROCAR_TRY_STATUS(check_request(request));
  const int pulses = impl.pulses_due(request);
  if (pulses > 0) {
    if (!impl.was_pedal_down || (impl.last && !(impl.last->arm == request.arm))) impl.window.reset();
    TROCAR_TRY_STATUS(impl.expose(request, pulses, seed));
  }
  impl.was_pedal_down = request.is_pedal_down;
  if (impl.last) return impl.show(request, pulses > 0);
  TROCAR_TRY_STATUS(check_c_arm(request.arm));
  FluoroscopyFrame dark;
  dark.arm = request.arm;
  dark.motion = request.motion;
  dark.time_s = request.time_s;
  const auto pixels = static_cast<std::size_t>(request.arm.pixels);
  dark.gray = {request.arm.pixels, request.arm.pixels, std::vector<std::uint8_t>(pixels * pixels, 0)};
  return dark;
}

const Dose& Fluoroscope::dose() const noexcept {
  return impl_->dose;
}
void Fluoroscope::reset_dose() noexcept {
  impl_->dose = {};
}
const std::vector<float>& Fluoroscope::signal() const noexcept {
  return impl_->signal;
}
const std::vector<float>& Fluoroscope::clean_signal() const noexcept {
  return impl_->clean;
}

}  // namespace trocar::xray
