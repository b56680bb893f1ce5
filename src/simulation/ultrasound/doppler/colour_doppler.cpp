#include "ultrasound/doppler/colour_doppler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>

#include "core/parallel.h"
#include "core/random.h"
#include "ultrasound/doppler/detail/colour_conversion.h"
#include "ultrasound/engine/echo_engine.h"
#include "ultrasound/scanner/detail/receiver.h"

namespace trocar::ultrasound {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// Image lines per line of cells, and the length of gates: half of a pulse of four cycles at 2.5 MHz. Assumed.
constexpr double kLineStep = 2.0;
constexpr double kGate_mm = 0.6;

/// Planes across the beam's thickness, in its standard deviations (of amplitude), and their weights in power.
struct Plane {
  float zeta, weight;  ///< exp(-zeta²), normalised to a sum of 1.
};
constexpr std::array<Plane, 5> kBeamPlanes = {
    {{-1.2F, 0.0826F}, {-0.6F, 0.2432F}, {0.0F, 0.3484F}, {0.6F, 0.2432F}, {1.2F, 0.0826F}}};

/// Blood's echo relative to liver's speckle at the image frequency, as in data/acoustics.toml (vessel). Range -35..-20.
constexpr double kBlood_db = -28.0;
/// Noise relative to that of the image: a longer pulse with more energy in a narrower band. Assumed, range -12..-3.
constexpr double kLongPulse_db = -6.0;
/// Threshold of the displayed correlation between pulses, in units of the noise power, at gain 0. Assumed, range
/// 0.5..2: noise hardly ever exceeds it.
constexpr float kThreshold = 0.7F;

/// Two approximately normal numbers of variance 1, as sums of four uniform ones (within +-3.5).
std::array<float, 2> two_normals(std::uint64_t key) noexcept {
  std::array<float, 2> normals;
  for (float& normal : normals) {
    key = mix64(key);
    std::uint32_t sum = 0;
    for (int n = 0; n < 4; ++n) sum += static_cast<std::uint32_t>(key >> (16 * n) & 0xffffU);
    constexpr float kScale = 1.0F / (65536.0F * 0.57735027F);  // four of variance 1/12 each
    normal = (static_cast<float>(sum) - 2.0F * 65535.0F) * kScale;
  }
  return normals;
}

/// Power of one echo of many scatterers: exponential distribution, mean 1.
float speckle_power(std::uint64_t key) noexcept {
  const auto even = static_cast<float>((mix64(key) >> 40) + 1) * 0x1p-24F;
  return -std::log(even);
}

}  // namespace

struct ColourDoppler::Impl {
  std::shared_ptr<const VesselFlow> flow;
  ScanGeometry scan;
  DopplerSettings held;
  bool has_cells = false;
  bool has_kept = false;
  DopplerFrame frame;
  std::vector<float> raw_re, raw_im;    ///< Before smoothing.
  std::vector<float> wide_re, wide_im;  ///< Smoothed along the gates.
  std::vector<float> sigma_mm;          ///< Per gate: half the beam's thickness.
  VesselFlow::Moment moment{};
  motion::PatientMotion motion;
  detail::ColourConversion conversion;

  void set_cells(const ScanGeometry& geometry, const DopplerSettings& settings);
  struct Ray;
  Ray make_ray(const DopplerInput& input, int line) const noexcept;
  struct BloodNow {
    Vec3f velocity_P;
    float share;
  };
  BloodNow blood_at(const Vec3f& p_P) const noexcept;
  std::array<float, 2> correlate(const Ray& ray, int gate, std::size_t sample, std::uint64_t key) const noexcept;
  void measure_line(const DopplerInput& input, int line) noexcept;
  void smooth_along(int line) noexcept;
  void finish_line(int line) noexcept;
};

void ColourDoppler::Impl::set_cells(const ScanGeometry& geometry, const DopplerSettings& settings) {
  const bool is_same = has_cells && detail::is_same_scan(scan, geometry) && held.box == settings.box;
  held = settings;
  const DopplerBox& box = held.box;
  if (!is_same) {
    scan = geometry;
    const double last = geometry.lines - 1;
    frame.first_line = std::floor(box.first_line * last);
    frame.line_step = kLineStep;
    frame.lines = std::max(2, static_cast<int>((box.last_line * last - frame.first_line) / kLineStep) + 1);
    frame.lines = std::min(frame.lines, static_cast<int>((last - frame.first_line) / kLineStep) + 1);
    frame.first_mm = box.near * geometry.depth_mm + 0.5 * kGate_mm;
    frame.gate_mm = kGate_mm;
    frame.gates = std::max(2, static_cast<int>((box.far - box.near) * geometry.depth_mm / kGate_mm));
    const std::size_t cells = static_cast<std::size_t>(frame.lines) * static_cast<std::size_t>(frame.gates);
    for (auto* values : {&raw_re, &raw_im, &wide_re, &wide_im, &frame.re, &frame.im, &frame.velocity_cm_per_s})
      values->assign(cells, 0.0F);
    frame.has_flow.assign(cells, 0);
    sigma_mm.assign(static_cast<std::size_t>(frame.gates), 0.0F);
    has_kept = false;
    has_cells = true;
    conversion.forget();
  }
  frame.scale_cm_per_s = usable_scale_cm_per_s(held, frame.first_mm + frame.gate_mm * frame.gates);
}

/// One line of cells through the patient.
struct ColourDoppler::Impl::Ray {
  SoundPath way;
  Vec3f start_P, along_P, elevation_P;
  float scale_mm_per_s;
  float cut4;     ///< Fourth power of the wall filter's cutoff share.
  float lowered;  ///< Frequency relative to that of the image.
  const Beam* beam;

  float rest_mm(float depth_mm, std::size_t sample) const noexcept {
    return way.gain.empty() ? depth_mm : depth_mm - way.pressed_mm * way.dent_share[sample];
  }
  /// Power of blood relative to the noise.
  float level(float depth_mm, std::size_t sample) const noexcept {
    constexpr auto kBlood = static_cast<float>(kBlood_db - detail::kReceiverNoise_db - kLongPulse_db);
    const float way_db = way.gain.empty()
                             ? static_cast<float>(-0.2 * kPlainLoss_db_per_cm_mhz * beam->frequency_mhz) * depth_mm
                             : 20.0F * std::log10(std::max(way.gain[sample], 1e-6F));
    return std::pow(10.0F, 0.1F * (kBlood + way_db * lowered));
  }
};

ColourDoppler::Impl::Ray ColourDoppler::Impl::make_ray(const DopplerInput& input, int line) const noexcept {
  const double place = frame.first_line + frame.line_step * line;
  const Vec2 origin_T = scan.line_origin(place);
  const Vec2 direction_T = scan.line_direction(place);
  const auto cut = static_cast<float>(held.wall_filter);
  Ray ray;
  if (input.engine != nullptr) ray.way = input.engine->sound_path(static_cast<int>(place));
  ray.start_P = (input.X_PT * Vec3(origin_T.x(), origin_T.y(), 0.0)).cast<float>();
  ray.along_P = (input.X_PT.R() * Vec3(direction_T.x(), direction_T.y(), 0.0)).cast<float>();
  ray.elevation_P = input.X_PT.R().col(2).cast<float>();
  ray.scale_mm_per_s = static_cast<float>(10.0 * frame.scale_cm_per_s);
  ray.cut4 = std::max(cut * cut * cut * cut, 1e-12F);
  ray.lowered = static_cast<float>(held.frequency_mhz / input.beam.frequency_mhz);
  ray.beam = &input.beam;
  return ray;
}

/// Blood at a point now; its velocity in P. What flows through a vessel stays the same where tissue stretches (Piola),
/// and the tissue carries the blood along.
ColourDoppler::Impl::BloodNow ColourDoppler::Impl::blood_at(const Vec3f& p_P) const noexcept {
  const Vec3 p_A = motion.to_rest(p_P.cast<double>());
  const VesselFlow::Blood blood = flow->at(motion.is_rest() ? p_P : p_A.cast<float>(), moment);
  if (motion.is_rest() || blood.share <= 0.0F) return {blood.velocity_A, blood.share};
  const Mat3 jacobian = motion.jacobian(p_A);
  const Vec3 carried_P = jacobian * blood.velocity_A.cast<double>() / jacobian.determinant();
  return {(carried_P + motion.velocity(p_A)).cast<float>(), blood.share};
}

/// Echo of blood at a gate in all planes of the beam, after the wall filter; 0 without blood.
std::array<float, 2> ColourDoppler::Impl::correlate(const Ray& ray, int gate, std::size_t sample,
                                                    std::uint64_t key) const noexcept {
  std::array<float, 2> sum{0.0F, 0.0F};
  const auto depth_mm = static_cast<float>(frame.first_mm + frame.gate_mm * gate);
  if (depth_mm > ray.way.mirror_depth_mm) return sum;
  const Vec3f middle_P = ray.start_P + ray.rest_mm(depth_mm, sample) * ray.along_P;
  const Vec3f thick_P = sigma_mm[static_cast<std::size_t>(gate)] * ray.elevation_P;
  for (std::size_t n = 0; n < kBeamPlanes.size(); ++n) {
    const BloodNow blood = blood_at(middle_P + kBeamPlanes[n].zeta * thick_P);
    if (blood.share <= 0.0F) continue;
    // Towards the face is positive; the phase between pulses in half turns, aliased.
    float share = -blood.velocity_P.dot(ray.along_P) / ray.scale_mm_per_s;
    share -= 2.0F * std::floor(0.5F * (share + 1.0F));
    const float share4 = share * share * share * share;
    const float passed = share4 / (share4 + ray.cut4);
    const float echo = blood.share * passed * kBeamPlanes[n].weight * speckle_power(key + n);
    sum[0] += echo * std::cos(kPi * share);
    sum[1] += echo * std::sin(kPi * share);
  }
  if (sum[0] == 0.0F && sum[1] == 0.0F) return sum;
  const float level = ray.level(depth_mm, sample);
  return {level * sum[0], level * sum[1]};
}

/// Autocorrelation of each gate of a line of cells, with noise.
void ColourDoppler::Impl::measure_line(const DopplerInput& input, int line) noexcept {
  const Ray ray = make_ray(input, line);
  const auto last = static_cast<std::size_t>(scan.samples) - 1;
  const float spread = 1.0F / std::sqrt(static_cast<float>(held.ensemble));
  for (int gate = 0; gate < frame.gates; ++gate) {
    const double depth_mm = frame.first_mm + frame.gate_mm * gate;
    const std::size_t cell = frame.at(line, gate);
    const auto sample = std::min(static_cast<std::size_t>(depth_mm / scan.sample_mm()), last);
    const std::uint64_t key = mix64(input.seed ^ mix64(cell));
    const std::array<float, 2> blood = correlate(ray, gate, sample, key);
    // Noise is uncorrelated between pulses: the mean of its products with itself and with the signal.
    const float power = std::sqrt(blood[0] * blood[0] + blood[1] * blood[1]);
    const float deviation = spread * std::sqrt(0.5F + power);
    const std::array<float, 2> normal = two_normals(key);
    raw_re[cell] = blood[0] + deviation * normal[0];
    raw_im[cell] = blood[1] + deviation * normal[1];
  }
}

/// Adjacent gates overlap by half a pulse.
void ColourDoppler::Impl::smooth_along(int line) noexcept {
  const auto smooth = [&](const std::vector<float>& from, std::vector<float>& to) {
    for (int gate = 0; gate < frame.gates; ++gate) {
      const std::size_t before = frame.at(line, std::max(gate - 1, 0));
      const std::size_t after = frame.at(line, std::min(gate + 1, frame.gates - 1));
      const std::size_t at = frame.at(line, gate);
      to[at] = 0.5F * from[at] + 0.25F * (from[before] + from[after]);
    }
  };
  smooth(raw_re, wide_re);
  smooth(raw_im, wide_im);
}

/// Smooths across lines and over time, and prepares the display.
void ColourDoppler::Impl::finish_line(int line) noexcept {
  const auto kept = has_kept ? static_cast<float>(held.persistence) : 0.0F;
  const float threshold = kThreshold * static_cast<float>(std::pow(10.0, -held.gain_db / 20.0));
  const auto scale = static_cast<float>(frame.scale_cm_per_s);
  const int before_line = std::max(line - 1, 0);
  const int after_line = std::min(line + 1, frame.lines - 1);
  for (int gate = 0; gate < frame.gates; ++gate) {
    const std::size_t at = frame.at(line, gate);
    const std::size_t before = frame.at(before_line, gate);
    const std::size_t after = frame.at(after_line, gate);
    const auto blend = [&](const std::vector<float>& wide, std::vector<float>& value) {
      const float fresh = 0.5F * wide[at] + 0.25F * (wide[before] + wide[after]);
      value[at] = fresh + kept * (value[at] - fresh);
    };
    blend(wide_re, frame.re);
    blend(wide_im, frame.im);
    const float strength2 = frame.re[at] * frame.re[at] + frame.im[at] * frame.im[at];
    const bool is_shown = strength2 > threshold * threshold;
    frame.has_flow[at] = is_shown ? 1 : 0;
    frame.velocity_cm_per_s[at] = is_shown ? scale / kPi * std::atan2(frame.im[at], frame.re[at]) : 0.0F;
  }
}

ColourDoppler::ColourDoppler(std::shared_ptr<const VesselFlow> flow) : impl_(std::make_unique<Impl>()) {
  impl_->flow = std::move(flow);
}
ColourDoppler::~ColourDoppler() = default;
ColourDoppler::ColourDoppler(ColourDoppler&&) noexcept = default;
ColourDoppler& ColourDoppler::operator=(ColourDoppler&&) noexcept = default;

const DopplerFrame& ColourDoppler::render(const DopplerInput& input) noexcept {
  Impl& impl = *impl_;
  impl.set_cells(input.geometry, within_ranges(settings));
  impl.moment = impl.flow->moment(input.time_s, input.motion.phase());
  impl.motion = input.motion;
  for (std::size_t gate = 0; gate < impl.sigma_mm.size(); ++gate)
    impl.sigma_mm[gate] = static_cast<float>(
        input.beam.elevation_sigma_mm(impl.frame.first_mm + impl.frame.gate_mm * static_cast<double>(gate)));
  const auto lines = static_cast<std::size_t>(impl.frame.lines);
  constexpr std::size_t kLinesTogether = 4;
  auto measure = [&](std::size_t first, std::size_t last) {
    for (std::size_t line = first; line < last; ++line) {
      impl.measure_line(input, static_cast<int>(line));
      impl.smooth_along(static_cast<int>(line));
    }
  };
  parallel_for(lines, kLinesTogether, std::ref(measure));
  auto finish = [&](std::size_t first, std::size_t last) {
    for (std::size_t line = first; line < last; ++line) impl.finish_line(static_cast<int>(line));
  };
  parallel_for(lines, 4 * kLinesTogether, std::ref(finish));
  impl.has_kept = true;
  return impl.frame;
}

const image::RgbImage& ColourDoppler::overlay(const image::GrayImage& image, const RasterGeometry& raster) noexcept {
  Impl& impl = *impl_;
  return impl.conversion.convert(image, raster, impl.scan, impl.frame, impl.held);
}

void ColourDoppler::reset() noexcept {
  impl_->has_kept = false;
}

}  // namespace trocar::ultrasound
