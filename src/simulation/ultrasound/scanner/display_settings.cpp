#include "ultrasound/scanner/display_settings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "config/toml.h"
#include "ultrasound/scanner/scanner.h"

namespace trocar::ultrasound {
namespace {

struct Range {
  double low, high;
  bool holds(double value) const noexcept { return value >= low && value <= high; }  // false for NaN
};
constexpr Range kGain_db{-40.0, 40.0};
constexpr Range kTgc_db{-20.0, 20.0};
constexpr Range kAutomaticTgc_db_per_cm_mhz{0.0, 1.5};
constexpr Range kAutomaticTgcLimit_db{0.0, 120.0};
constexpr Range kDynamicRange_db{20.0, 100.0};
constexpr Range kPersistence{0.0, 0.95};

constexpr std::array<std::pair<GrayMap, std::string_view>, 3> kGrayMapNames = {
    {{GrayMap::kLinear, "linear"}, {GrayMap::kSoft, "soft"}, {GrayMap::kHighContrast, "high-contrast"}}};

/// Sharpness of the transition of the automatic TGC to its limit. Assumed, range 1..6.
constexpr double kLimitBend_db = 5.0;

/// Gray maps, fitted to the sweep of docs/validation.md: mean and spread of liver, and the gray of tissue without
/// echoes.
constexpr double kSoftSteepness = 4.5;  ///< Number of e-folds of the gray value over the dynamic range.
constexpr double kSoftFloor = 8.0 / 255.0;
constexpr double kSoftFloorRise = 0.04;  ///< Part of the dynamic range in which the floor is reached.
constexpr double kHighContrastSteepness = 6.0;

Status in_range(double value, Range range, std::string_view control, std::string_view unit) {
  if (range.holds(value)) return {};
  return fail_usage(fmt::format("{} of {} {} cannot be set", control, value, unit), {},
                    fmt::format("choose {} to {}", range.low, range.high));
}

double held_in_range(double value, Range range, double fallback) noexcept {
  return std::isnan(value) ? fallback : std::clamp(value, range.low, range.high);
}

double automatic_db(const DisplaySettings& settings, double depth_mm, double frequency_mhz) noexcept {
  const double loss_db = 2.0 * settings.automatic_tgc_db_per_cm_mhz * frequency_mhz * 0.1 * std::max(depth_mm, 0.0);
  const double limit = settings.automatic_tgc_limit_db / kLimitBend_db, at_face = std::log1p(std::exp(-limit));
  const double beyond = loss_db / kLimitBend_db - limit;
  // The logarithm of 1 + exp(beyond), without its overflow.
  const double bend = beyond > 30.0 ? beyond : std::log1p(std::exp(beyond));
  return loss_db - kLimitBend_db * (bend - at_face);
}

/// Slope of the slider curve at a slider, dB per slider. Zero at an extremum and the harmonic mean elsewhere, so that
/// the cubic does not overshoot (Fritsch and Butland 1984).
double slope_at(const std::array<double, kTgcSliders>& tgc_db, int slider) noexcept {
  if (slider <= 0 || slider >= kTgcSliders - 1) return 0.0;
  const auto i = static_cast<std::size_t>(slider);
  const double before = tgc_db[i] - tgc_db[i - 1];
  const double after = tgc_db[i + 1] - tgc_db[i];
  return before * after <= 0.0 ? 0.0 : 2.0 * before * after / (before + after);
}

double sliders_db(const std::array<double, kTgcSliders>& tgc_db, double place) noexcept {
  const double clamped = std::clamp(place, 0.0, static_cast<double>(kTgcSliders - 1));
  const int first = std::min(static_cast<int>(clamped), kTgcSliders - 2);
  const double t = clamped - first;
  const double a = tgc_db[static_cast<std::size_t>(first)];
  const double b = tgc_db[static_cast<std::size_t>(first) + 1];
  const double s = 1.0 - t;
  return a * s * s * (1.0 + 2.0 * t) + b * t * t * (1.0 + 2.0 * s) + slope_at(tgc_db, first) * t * s * s -
         slope_at(tgc_db, first + 1) * t * t * s;
}

/// Maps 0..1 to 0..1 exponentially, with `steepness` e-folds.
double exponential(double x, double steepness) noexcept {
  return std::expm1(steepness * x) / std::expm1(steepness);
}

double mapped(GrayMap map, double x) noexcept {
  switch (map) {
    case GrayMap::kLinear:
      return x;
    case GrayMap::kSoft:
      return -kSoftFloor * std::expm1(-x / kSoftFloorRise) + (1.0 - kSoftFloor) * exponential(x, kSoftSteepness);
    case GrayMap::kHighContrast:
      return exponential(x, kHighContrastSteepness);
  }
  return x;
}

}  // namespace

Status check(const DisplaySettings& settings) {
  TROCAR_TRY_STATUS(in_range(settings.gain_db, kGain_db, "a gain", "dB"));
  for (std::size_t i = 0; i < settings.tgc_db.size(); ++i) {
    TROCAR_TRY_STATUS(in_range(settings.tgc_db[i], kTgc_db, fmt::format("TGC slider {}", i + 1), "dB"));
  }
  TROCAR_TRY_STATUS(
      in_range(settings.automatic_tgc_db_per_cm_mhz, kAutomaticTgc_db_per_cm_mhz, "an automatic TGC", "dB/cm/MHz"));
  TROCAR_TRY_STATUS(in_range(settings.automatic_tgc_limit_db, kAutomaticTgcLimit_db, "a limit of automatic TGC", "dB"));
  TROCAR_TRY_STATUS(in_range(settings.dynamic_range_db, kDynamicRange_db, "a dynamic range", "dB"));
  TROCAR_TRY_STATUS(in_range(settings.persistence, kPersistence, "a persistence", "(part of the last picture)"));
  return {};
}

DisplaySettings within_ranges(const DisplaySettings& settings) noexcept {
  const DisplaySettings fallback;
  DisplaySettings result = settings;
  result.gain_db = held_in_range(settings.gain_db, kGain_db, fallback.gain_db);
  for (double& slider_db : result.tgc_db) slider_db = held_in_range(slider_db, kTgc_db, 0.0);
  result.automatic_tgc_db_per_cm_mhz = held_in_range(settings.automatic_tgc_db_per_cm_mhz, kAutomaticTgc_db_per_cm_mhz,
                                                     fallback.automatic_tgc_db_per_cm_mhz);
  result.automatic_tgc_limit_db =
      held_in_range(settings.automatic_tgc_limit_db, kAutomaticTgcLimit_db, fallback.automatic_tgc_limit_db);
  result.dynamic_range_db = held_in_range(settings.dynamic_range_db, kDynamicRange_db, fallback.dynamic_range_db);
  result.persistence = held_in_range(settings.persistence, kPersistence, fallback.persistence);
  return result;
}

Result<GrayMap> parse_gray_map(std::string_view name) {
  for (const auto& [map, map_name] : kGrayMapNames) {
    if (map_name == name) return map;
  }
  return fail_usage(fmt::format("there is no gray map '{}'", name), {}, "choose linear, soft or high-contrast");
}

std::string_view name_of(GrayMap map) noexcept {
  for (const auto& [known, map_name] : kGrayMapNames) {
    if (known == map) return map_name;
  }
  return "unknown";
}

double tgc_gain_db(const DisplaySettings& settings, double depth_mm, double scan_depth_mm,
                   double frequency_mhz) noexcept {
  const double place = depth_mm / scan_depth_mm * kTgcSliders - 0.5;
  return automatic_db(settings, depth_mm, frequency_mhz) + sliders_db(settings.tgc_db, place);
}

std::uint8_t gray_of_level(double level_db, const DisplaySettings& settings) noexcept {
  const double below_white_db = kWhite_db - level_db - settings.gain_db;
  const double x = std::clamp(1.0 - below_white_db / settings.dynamic_range_db, 0.0, 1.0);
  return static_cast<std::uint8_t>(std::lround(255.0 * mapped(settings.gray_map, x)));
}

namespace {

constexpr double kBrighterShare = 1.0 / 3.0;  ///< Of the samples with an echo, brighter than tissue. [assumed]
constexpr double kLeastEchoes = 0.1;          ///< Share of the scan. [assumed]
constexpr double kLeastGain_db = -40.0, kMostGain_db = 40.0;
constexpr double kStep_db = 0.25;

/// The level that a share of the samples with an echo exceeds; empty: too few of them.
std::optional<std::uint8_t> tissue_level(std::span<const std::uint8_t> levels) {
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t level : levels) ++counts[level];
  const std::size_t echoes = levels.size() - counts[0];
  if (levels.empty() || static_cast<double>(echoes) < kLeastEchoes * static_cast<double>(levels.size()))
    return std::nullopt;
  std::size_t brighter = 0;
  for (std::size_t level = counts.size() - 1; level > 0; --level) {
    brighter += counts[level];
    if (static_cast<double>(brighter) >= kBrighterShare * static_cast<double>(echoes))
      return static_cast<std::uint8_t>(level);
  }
  return std::nullopt;
}

}  // namespace

std::optional<double> automatic_gain_db(std::span<const std::uint8_t> levels, const DisplaySettings& settings) {
  const auto level = tissue_level(levels);
  if (!level) return std::nullopt;
  DisplaySettings tried = settings;
  for (tried.gain_db = kLeastGain_db; tried.gain_db < kMostGain_db; tried.gain_db += kStep_db)
    if (gray_of_level(Scanner::level_db(*level), tried) >= kAutomaticGray) break;
  return tried.gain_db;
}

namespace {

Status read_if_given(const config::TomlTable& row, std::string_view key, config::Range range,
                     std::optional<double>& value) {
  if (!row.has(key)) return {};
  TROCAR_TRY(value, row.number(key, range));
  return {};
}

Result<ScanPreset> read_preset(const config::TomlTable& row, const std::string& name) {
  TROCAR_TRY_STATUS(
      row.check_keys({"title", "transducer", "depth_mm", "frequency_mhz", "focus_mm", "gain_db", "dynamic_range_db",
                      "gray_map", "persistence", "has_doppler", "doppler_scale_cm_per_s"}));
  ScanPreset preset;
  preset.name = name;
  TROCAR_TRY(preset.title, row.string("title"));
  TROCAR_TRY(preset.transducer, row.string("transducer"));
  TROCAR_TRY_STATUS(read_if_given(row, "depth_mm", {20.0, 300.0}, preset.depth_mm));
  TROCAR_TRY_STATUS(read_if_given(row, "frequency_mhz", {1.0, 20.0}, preset.frequency_mhz));
  TROCAR_TRY_STATUS(read_if_given(row, "focus_mm", {5.0, 300.0}, preset.focus_mm));
  DisplaySettings& display = preset.display;
  TROCAR_TRY(display.gain_db, row.number_or("gain_db", {-40.0, 40.0}, display.gain_db));
  TROCAR_TRY(display.dynamic_range_db, row.number_or("dynamic_range_db", {20.0, 100.0}, display.dynamic_range_db));
  TROCAR_TRY(display.persistence, row.number_or("persistence", {0.0, 0.95}, display.persistence));
  TROCAR_TRY(const std::string map, row.string_or("gray_map", std::string(name_of(display.gray_map))));
  const Result<GrayMap> gray_map = parse_gray_map(map);
  if (!gray_map) return fail("there is no gray map \"" + map + "\"", row.where(), "use linear, soft or high-contrast");
  display.gray_map = *gray_map;
  TROCAR_TRY(preset.has_doppler, row.boolean_or("has_doppler", false));
  TROCAR_TRY(preset.doppler_scale_cm_per_s,
             row.number_or("doppler_scale_cm_per_s", {2.0, 200.0}, preset.doppler_scale_cm_per_s));
  return preset;
}

}  // namespace

Result<std::vector<ScanPreset>> load_scan_presets(const std::filesystem::path& path) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(path));
  TROCAR_TRY_STATUS(document.check_keys({"presets"}));
  TROCAR_TRY(const config::TomlTable rows, document.table("presets"));
  std::vector<ScanPreset> presets;
  for (const std::string& name : rows.keys()) {
    TROCAR_TRY(const config::TomlTable row, rows.table(name));
    TROCAR_TRY(ScanPreset preset, read_preset(row, name));
    presets.push_back(std::move(preset));
  }
  return presets;
}

Acquisition acquisition_of(const ScanPreset& preset, const Transducer& transducer) {
  Acquisition acquisition = default_acquisition(transducer);
  acquisition.depth_mm = preset.depth_mm.value_or(acquisition.depth_mm);
  acquisition.frequency_mhz = preset.frequency_mhz.value_or(acquisition.frequency_mhz);
  acquisition.focus_mm = preset.focus_mm.value_or(acquisition.focus_mm);
  return acquisition;
}

}  // namespace trocar::ultrasound
