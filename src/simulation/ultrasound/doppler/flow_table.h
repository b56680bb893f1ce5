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

/// Speed over one heartbeat, relative to its peak (data/flow.toml; physics.md U15).
struct FlowWaveform {
  std::string name;
  std::vector<double> values;  ///< In equal time steps from the R wave. Range -1..1; at least 4.
  double breathing = 0.0;      ///< Fraction by which a breath changes the speed. Range 0..0.8.

  /// Value at a time since the start of a heartbeat at 0 and at a phase of the breath (PatientMotion::phase). Periodic
  /// and continuous. Real-time safe.
  double at(double time_s, double heart_per_min, double breath_phase) const noexcept;
};

/// Blood flow in a kind of vessel.
struct FlowRule {
  enum class End { kSources, kSinks };
  enum class At { kNowhere, kHead, kFeet };

  std::string name;
  std::vector<std::string> labels;  ///< '*' matches any ending.
  End ends = End::kSources;  ///< Kind of the ends near `near`, else of the end at `at`; the other ends are of the
                             ///< opposite kind.
  std::vector<std::string> near;
  At at = At::kNowhere;
  std::size_t waveform = 0;         ///< Index into FlowTable::waveforms.
  double peak_cm_per_s = 30.0;      ///< Speed in the middle of the widest part, at waveform value 1. Range 1..300.
  double profile_exponent = 2.0;    ///< Range 1..20.
  double narrowing_exponent = 0.0;  ///< Range -1..2.
};

struct FlowTable {
  double heart_per_min = 70.0;          ///< Range 30..200.
  std::vector<FlowWaveform> waveforms;  ///< At most 32.
  std::vector<FlowRule> rules;

  /// Rule of a label among the patient's labels: the first rule for that label whose neighbours are present, or that
  /// needs none.
  const FlowRule* find(std::string_view label, const anatomy::LabelTable& labels) const;
};

/// Errors name file, row and key: unknown key, out of range, no source, an unknown waveform.
Result<FlowTable> load_flow_table(const std::filesystem::path& path);

/// True if a label matches one of the patterns ('*' matches any ending; case and separators are ignored).
bool is_named(std::string_view label, const std::vector<std::string>& patterns);

}  // namespace trocar::ultrasound
