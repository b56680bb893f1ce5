#include "ultrasound/scanner/automatic_gain.h"

#include <array>
#include <cstddef>

#include "ultrasound/scanner/scanner.h"

namespace trocar::ultrasound {
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

}  // namespace trocar::ultrasound
