#include "ultrasound/scanner/scanner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "core/parallel.h"
#include "core/result.h"
#include "ultrasound/engine/beam.h"
#include "ultrasound/scanner/detail/receiver.h"
#include "ultrasound/scanner/detail/scan_conversion.h"
#include "ultrasound/scanner/detail/scanner_kernels.h"

namespace trocar::ultrasound {
namespace {

using detail::kLevelFloor_db;
using detail::kLevelStep_db;
using detail::kMostLanes;
using detail::kMostSamples;

/// Number of levels of 1/32 dB per entry of the gray table.
constexpr int kLookupShift = 4;
constexpr std::size_t kLookupSize = (std::size_t{1} << 16) >> kLookupShift;
/// Minimum work of a thread: a sixteenth of a usual frame.
constexpr std::size_t kLinesTogether = 16;
constexpr std::size_t kRowsTogether = 32;

bool is_same(const ScanGeometry& a, const ScanGeometry& b) noexcept {
  return a.is_fan == b.is_fan && a.radius_mm == b.radius_mm && a.line_step == b.line_step && a.lines == b.lines &&
         a.samples == b.samples && a.depth_mm == b.depth_mm;
}

}  // namespace

struct Scanner::Impl {
  Impl(int columns, int rows) : conversion(columns, rows) {
    image.columns = columns;
    image.rows = rows;
    image.pixels.assign(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows), 0);
  }

  void set_scan(const ScanGeometry& new_scan, bool is_mirrored);
  void set_receiver(const Beam& beam);
  void set_near_angles(const BasebandFrame& frame);
  bool set_settings(const DisplaySettings& wanted, double frequency_mhz);  ///< True if they have changed.
  bool set_lookup(const DisplaySettings& wanted);
  void receive_line(const BasebandFrame& frame, std::size_t line, std::uint64_t seed, const Artefacts& artefacts);
  void map_line(std::size_t line);
  void convert();

  std::size_t lines() const noexcept { return static_cast<std::size_t>(scan.lines); }
  std::size_t samples() const noexcept { return static_cast<std::size_t>(scan.samples); }

  ScanGeometry scan;
  bool has_scan = false;
  RasterGeometry raster;
  detail::Receiver receiver;
  detail::ScanConversion conversion;
  float noise_amplitude = 0.0F;
  std::vector<float> harmonic_level;  ///< Per sample; empty for a fundamental beam.
  int near_full = -1;
  double receiver_sigma_mm = -1.0;  ///< Pulse length for which `receiver` was made.
  bool is_harmonic = false;         ///< The same for its beam.
  double focus_mm = 0.0;
  std::optional<DisplaySettings> applied;
  std::optional<DisplaySettings> looked_up;
  double applied_mhz = 0.0;

  std::vector<float> near_share;                       ///< Of the angles near the face, per sample.
  std::vector<float> offset;                           ///< TGC minus the floor of each sample, in levels of 1/32 dB.
  std::array<std::uint8_t, kLookupSize> gray_of_fine;  ///< Indexed by level >> kLookupShift.
  std::array<std::uint8_t, 256> gray_of_level_of;      ///< Indexed by level.
  std::size_t stride = 0;                              ///< Row length of `state`: a multiple of the vector length.
  std::vector<std::uint16_t> state;                    ///< Levels of the image with persistence.
  bool has_state = false;
  std::vector<std::uint8_t> levels;
  std::vector<std::uint8_t> polar;
  image::GrayImage image;
};

void Scanner::Impl::set_scan(const ScanGeometry& new_scan, bool is_mirrored) {
  if (has_scan && is_same(scan, new_scan) && raster.is_mirrored == is_mirrored) return;
  TROCAR_CHECK(new_scan.lines >= 2 && new_scan.samples >= static_cast<int>(kMostLanes) &&
               new_scan.samples <= static_cast<int>(kMostSamples));
  if (!has_scan || !is_same(scan, new_scan)) {
    scan = new_scan;
    stride = (samples() + kMostLanes - 1) / kMostLanes * kMostLanes;
    state.assign(lines() * stride, 0);
    offset.assign(samples(), 0.0F);
    levels.assign(lines() * samples(), 0);
    polar.assign(lines() * samples(), 0);
    has_state = false;
    receiver_sigma_mm = -1.0;
    applied.reset();
  }
  has_scan = true;
  raster = fit_raster(scan, image.columns, image.rows, is_mirrored);
  conversion.set_geometry(scan, raster);
  image.pixels.assign(image.pixels.size(), 0);
}

void Scanner::Impl::set_receiver(const Beam& beam) {
  if (receiver_sigma_mm == beam.axial_sigma_mm && is_harmonic == beam.is_harmonic && focus_mm == beam.focus_mm) return;
  receiver_sigma_mm = beam.axial_sigma_mm;
  is_harmonic = beam.is_harmonic;
  focus_mm = beam.focus_mm;
  receiver.set_geometry(scan, beam);
  // The harmonic is weaker than the noise is made for.
  noise_amplitude =
      static_cast<float>(std::pow(10.0, detail::kReceiverNoise_db / 20.0) / harmonic_share(beam, beam.focus_mm));
  harmonic_level = beam.is_harmonic ? harmonic_levels(beam, scan) : std::vector<float>{};
  applied.reset();
}

void Scanner::Impl::set_near_angles(const BasebandFrame& frame) {
  if (near_full == frame.near_full && near_share.size() == samples()) return;
  near_full = frame.near_full;
  near_share.assign(samples(), 0.0F);
  for (std::size_t s = 0; s < samples(); ++s) {
    const auto behind = static_cast<float>(static_cast<int>(s) - frame.near_full);
    const auto fade = static_cast<float>(std::max(frame.near_samples - frame.near_full, 1));
    near_share[s] = std::clamp(1.0F - behind / fade, 0.0F, 1.0F);
  }
}

bool Scanner::Impl::set_settings(const DisplaySettings& wanted, double frequency_mhz) {
  if (applied == wanted && applied_mhz == frequency_mhz) return false;
  applied = wanted;
  applied_mhz = frequency_mhz;
  for (std::size_t s = 0; s < samples(); ++s) {
    const double depth_mm = (static_cast<double>(s) + 0.5) * scan.sample_mm();
    double above_floor_db = tgc_gain_db(wanted, depth_mm, scan.depth_mm, frequency_mhz) - kLevelFloor_db;
    if (!harmonic_level.empty()) above_floor_db += harmonic_gain_db(harmonic_level[s]);
    offset[s] = static_cast<float>(above_floor_db * detail::kFineLevels_per_db);
  }
  return true;
}

bool Scanner::Impl::set_lookup(const DisplaySettings& wanted) {
  if (looked_up == wanted) return false;
  looked_up = wanted;
  for (std::size_t i = 0; i < kLookupSize; ++i) {
    const double fine = static_cast<double>((i << kLookupShift) + (std::size_t{1} << kLookupShift) / 2);
    gray_of_fine[i] = gray_of_level(kLevelFloor_db + fine / detail::kFineLevels_per_db, wanted);
  }
  for (std::size_t i = 0; i < 256; ++i) {
    gray_of_level_of[i] = gray_of_level(level_db(static_cast<std::uint8_t>(i)), wanted);
  }
  // Zero and non-finite values stay black at any gain.
  gray_of_fine[0] = gray_of_level_of[0] = 0;
  return true;
}

void Scanner::Impl::receive_line(const BasebandFrame& frame, std::size_t line, std::uint64_t seed,
                                 const Artefacts& artefacts) {
  const std::size_t n = samples();
  const float* const re = frame.re.data() + line * n;
  const float* const im = frame.im.data() + line * n;
  const detail::Receiver::Noise noise = receiver.noise(seed, line);
  const auto steering_angles = static_cast<std::size_t>(frame.steering_angles);
  const std::size_t angle_step = lines() * n;
  constexpr std::size_t kNoiseStep = 1021;  // far beyond the pulse, so that compounding angles have independent noise
  const float level = artefacts.noise ? noise_amplitude : 0.0F;

  std::array<std::uint16_t, kMostSamples> fresh;
  const bool persists = has_state && applied->persistence > 0.0;
  std::uint16_t* const kept = state.data() + line * stride;
  std::uint16_t* const target = persists ? fresh.data() : kept;

  const std::size_t hazy = artefacts.clutter ? receiver.clutter_samples() : 0;
  auto shared = frame.near_angles > 0 ? static_cast<std::size_t>(frame.near_samples) : 0;
  if (shared < hazy + kMostLanes && hazy < shared + kMostLanes) shared = hazy;  // no section below a vector
  const detail::Receiver::Noise clutter = receiver.clutter(line);
  const auto detect = [&](std::size_t first, std::size_t last) {
    if (first >= last) return;
    const bool is_hazy = first < hazy;
    detail::detect({re + first, im + first, noise.re + first, noise.im + first, level,
                    is_hazy ? clutter.re + first : nullptr, is_hazy ? clutter.im + first : nullptr, steering_angles,
                    angle_step, kNoiseStep, static_cast<std::size_t>(frame.near_angles),
                    first < shared ? near_share.data() + first : nullptr, offset.data() + first, last - first},
                   target + first);
  };
  detect(0, std::min(hazy, shared));
  detect(std::min(hazy, shared), std::max(hazy, shared));
  detect(std::max(hazy, shared), n);
  if (persists) detail::persist(fresh.data(), static_cast<float>(applied->persistence), n, kept);
}

void Scanner::Impl::map_line(std::size_t line) {
  const std::size_t n = samples();
  const std::uint16_t* const fine = state.data() + line * stride;
  std::uint8_t* const level = levels.data() + line * n;
  std::uint8_t* const gray = polar.data() + line * n;
  for (std::size_t s = 0; s < n; ++s) level[s] = static_cast<std::uint8_t>(fine[s] >> 8);
  for (std::size_t s = 0; s < n; ++s) gray[s] = gray_of_fine[fine[s] >> kLookupShift];
  conversion.set_line(line, gray);
}

void Scanner::Impl::convert() {
  auto rows_part = [this](std::size_t first, std::size_t last) {
    conversion.convert_rows(first, last, image.pixels.data());
  };
  parallel_for(static_cast<std::size_t>(image.rows), kRowsTogether, std::ref(rows_part));
}

Scanner::Scanner(int columns, int rows) : impl_(std::make_unique<Impl>(columns, rows)) {}
Scanner::~Scanner() = default;
Scanner::Scanner(Scanner&&) noexcept = default;
Scanner& Scanner::operator=(Scanner&&) noexcept = default;

const image::GrayImage& Scanner::show(const BasebandFrame& frame, std::uint64_t seed) {
  const DisplaySettings held = within_ranges(settings);
  impl_->set_scan(frame.geometry, held.is_mirrored);
  const std::size_t count = impl_->lines() * impl_->samples();
  const std::size_t echoes = count * static_cast<std::size_t>(frame.steering_angles + frame.near_angles);
  TROCAR_CHECK(frame.re.size() == echoes && frame.im.size() == echoes);
  impl_->set_receiver(frame.beam);
  impl_->set_near_angles(frame);
  const bool has_new_settings = impl_->set_settings(held, frame.beam.frequency_mhz);
  const bool has_new_grays = impl_->set_lookup(held);
  // Scanlines that were not renewed stay as they are shown, their noise included.
  const bool keeps = impl_->has_state && !has_new_settings && !has_new_grays && !frame.renewed.is_empty();
  const LineRange lines = keeps ? frame.renewed : LineRange{0, frame.geometry.lines};

  auto lines_part = [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const std::size_t line = static_cast<std::size_t>(lines.first) + n;
      impl_->receive_line(frame, line, seed, artefacts);
      impl_->map_line(line);
    }
  };
  parallel_for(static_cast<std::size_t>(lines.count()), kLinesTogether, std::ref(lines_part));
  impl_->has_state = true;
  impl_->convert();
  return impl_->image;
}

const image::GrayImage& Scanner::show_levels(std::span<const std::uint8_t> levels, const ScanGeometry& scan) {
  const DisplaySettings held = within_ranges(settings);
  impl_->set_scan(scan, held.is_mirrored);
  const std::size_t n = impl_->samples();
  TROCAR_CHECK(levels.size() == impl_->lines() * n);
  impl_->set_lookup(held);
  for (std::size_t line = 0; line < impl_->lines(); ++line) {
    std::uint8_t* const gray = impl_->polar.data() + line * n;
    for (std::size_t s = 0; s < n; ++s) gray[s] = impl_->gray_of_level_of[levels[line * n + s]];
    impl_->conversion.set_line(line, gray);
  }
  impl_->convert();
  return impl_->image;
}

const std::vector<std::uint8_t>& Scanner::polar() const noexcept {
  return impl_->polar;
}

const std::vector<std::uint8_t>& Scanner::levels() const noexcept {
  return impl_->levels;
}

double Scanner::level_db(std::uint8_t level) noexcept {
  return kLevelFloor_db + (level + 0.5) * kLevelStep_db;
}

const RasterGeometry& Scanner::raster() const noexcept {
  return impl_->raster;
}

void Scanner::reset() noexcept {
  impl_->has_state = false;
}

}  // namespace trocar::ultrasound
