#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/label_table.h"
#include "core/result.h"

namespace trocar::ultrasound {

/// Speed over one heartbeat, against its peak (data/flow.toml; physics.md U15).
struct FlowWaveform {
  std::string name;
  std::vector<double> values;  ///< Even steps from the R wave on. Range -1..1; at least 4.
  double breathing = 0.0;      ///< Part by which a breath changes it. Range 0..0.8.

  /// At a time of a heart and breath that began together at 0. Periodic and continuous. Real-time safe.
  double at(double time_s, double heart_per_min, double breaths_per_min) const noexcept;
};

/// How blood flows in a kind of vessel.
struct FlowRule {
  enum class End { kSources, kSinks };
  enum class At { kNowhere, kHead, kFeet };

  std::string name;
  std::vector<std::string> labels;  ///< '*' ends a stem.
  End ends = End::kSources;         ///< Kind of the ends near `near`, else of the one at `at`; the others are opposite.
  std::vector<std::string> near;
  At at = At::kNowhere;
  std::size_t waveform = 0;         ///< Index into FlowTable::waveforms.
  double peak_cm_per_s = 30.0;      ///< In the middle of the widest part, at the waveform's 1. Range 1..300.
  double profile_exponent = 2.0;    ///< Range 1..20.
  double narrowing_exponent = 0.0;  ///< Range -1..2.
};

struct FlowTable {
  double heart_per_min = 70.0;          ///< Range 30..200.
  double breaths_per_min = 14.0;        ///< Range 0..60.
  std::vector<FlowWaveform> waveforms;  ///< At most 32.
  std::vector<FlowRule> rules;

  /// The rule of a label in that company: the first of its rules whose neighbours are there, or that needs none.
  const FlowRule* find(std::string_view label, const anatomy::LabelTable& labels) const;
};

/// Errors name file, row and key: unknown key, out of range, no source, an unknown waveform.
Result<FlowTable> load_flow_table(const std::filesystem::path& path);

/// Whether a label is meant by one of the patterns ('*' ends a stem; case and separators do not matter).
bool is_named(std::string_view label, const std::vector<std::string>& patterns);

}  // namespace trocar::ultrasound
