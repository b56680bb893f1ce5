#include "ultrasound/doppler/flow_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "config/sourced_number.h"
#include "ultrasound/probe/detail/label_pattern.h"

namespace trocar::ultrasound {
namespace {

constexpr std::size_t kMostWaveforms = 32;
constexpr double kSecondsPerMinute = 60.0;

Result<double> read_sourced_value(const config::TomlTable& row, std::string_view key, config::Range range) {
  TROCAR_TRY(const config::SourcedNumber number, config::read_sourced_number(row, key, range));
  return number.value;
}

/// Reads one of a few words.
Result<std::size_t> read_word_index(const config::TomlTable& row, std::string_view key,
                                    const std::vector<std::string>& words) {
  TROCAR_TRY(const std::string word, row.string(key));
  const auto it = std::find(words.begin(), words.end(), word);
  if (it != words.end()) return static_cast<std::size_t>(it - words.begin());
  return fail(fmt::format("{} is \"{}\"", key, word), row.where(), fmt::format("use {}", fmt::join(words, ", ")));
}

Result<FlowWaveform> read_waveform(const config::TomlTable& row, const std::string& name) {
  TROCAR_TRY_STATUS(row.check_keys({"source", "values", "breathing"}));
  FlowWaveform waveform;
  waveform.name = name;
  TROCAR_TRY(const std::string source, row.string("source"));
  if (source.empty()) return fail("a waveform without a source", row.where(), "say where it comes from");
  TROCAR_TRY(waveform.values, row.numbers("values", {-1.0, 1.0}));
  if (waveform.values.size() < 4) return fail("fewer than 4 values", row.where(), "give one heartbeat in even steps");
  TROCAR_TRY(waveform.breathing, read_sourced_value(row, "breathing", {0.0, 0.8}));
  return waveform;
}

Result<FlowRule> read_rule(const config::TomlTable& row, const std::string& name,
                           const std::vector<std::string>& waveforms) {
  TROCAR_TRY_STATUS(row.check_keys(
      {"labels", "ends", "near", "at", "waveform", "peak_cm_per_s", "profile_exponent", "narrowing_exponent"}));
  FlowRule rule;
  rule.name = name;
  TROCAR_TRY(rule.labels, row.strings("labels"));
  TROCAR_TRY(rule.near, row.strings("near"));
  TROCAR_TRY(const std::size_t ends, read_word_index(row, "ends", {"sources", "sinks"}));
  rule.ends = ends == 0 ? FlowRule::End::kSources : FlowRule::End::kSinks;
  if (row.has("at")) {
    TROCAR_TRY(const std::size_t at, read_word_index(row, "at", {"head", "feet"}));
    rule.at = at == 0 ? FlowRule::At::kHead : FlowRule::At::kFeet;
  }
  if (rule.labels.empty()) return fail("no labels", row.where(), "add labels = [...]");
  if (rule.near.empty() && rule.at == FlowRule::At::kNowhere)
    return fail("neither near nor at", row.where(), "add near or at");
  TROCAR_TRY(rule.waveform, read_word_index(row, "waveform", waveforms));
  TROCAR_TRY(rule.peak_cm_per_s, read_sourced_value(row, "peak_cm_per_s", {1.0, 300.0}));
  TROCAR_TRY(rule.profile_exponent, read_sourced_value(row, "profile_exponent", {1.0, 20.0}));
  TROCAR_TRY(rule.narrowing_exponent, read_sourced_value(row, "narrowing_exponent", {-1.0, 2.0}));
  return rule;
}

}  // namespace

bool is_named(std::string_view label, const std::vector<std::string>& patterns) {
  const std::string name = detail::plain_name(label);
  return std::any_of(patterns.begin(), patterns.end(), [&](const std::string& pattern) {
    return detail::matches_pattern(detail::plain_name(pattern), name);
  });
}

double FlowWaveform::at(double time_s, double heart_per_min, double breath_phase) const noexcept {
  const auto n = static_cast<double>(values.size());
  const double beats = time_s * heart_per_min / kSecondsPerMinute;
  const double place = (beats - std::floor(beats)) * n;
  const auto low = std::min(static_cast<std::size_t>(place >= 0.0 ? place : 0.0), values.size() - 1);  // also NaN
  const std::size_t high = (low + 1) % values.size();
  const double value = std::lerp(values[low], values[high], place - static_cast<double>(low));
  const double breath = std::sin(2.0 * std::numbers::pi * breath_phase);
  return value * (1.0 + breathing * breath);
}

const FlowRule* FlowTable::find(std::string_view label, const anatomy::LabelTable& labels) const {
  for (const FlowRule& rule : rules) {
    if (!is_named(label, rule.labels)) continue;
    const bool has_neighbour = std::any_of(
        labels.labels.begin(), labels.labels.end(),
        [&](const anatomy::Label& other) { return other.name != label && is_named(other.name, rule.near); });
    if (has_neighbour || rule.at != FlowRule::At::kNowhere) return &rule;
  }
  return nullptr;
}

Result<FlowTable> load_flow_table(const std::filesystem::path& path) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(path));
  TROCAR_TRY_STATUS(document.check_keys({"heart_per_min", "waveforms", "vessels"}));
  FlowTable table;
  TROCAR_TRY(table.heart_per_min, read_sourced_value(document, "heart_per_min", {30.0, 200.0}));
  TROCAR_TRY(const config::TomlTable waveforms, document.table("waveforms"));
  const std::vector<std::string> names = waveforms.keys();
  if (names.size() > kMostWaveforms)
    return fail(fmt::format("{} waveforms", names.size()), waveforms.where(),
                fmt::format("at most {} can be used", kMostWaveforms));
  for (const std::string& name : names) {
    TROCAR_TRY(const config::TomlTable row, waveforms.table(name));
    TROCAR_TRY(FlowWaveform waveform, read_waveform(row, name));
    table.waveforms.push_back(std::move(waveform));
  }
  TROCAR_TRY(const config::TomlTable rules, document.table("vessels"));
  for (const std::string& name : rules.keys()) {
    TROCAR_TRY(const config::TomlTable row, rules.table(name));
    TROCAR_TRY(FlowRule rule, read_rule(row, name, names));
    table.rules.push_back(std::move(rule));
  }
  return table;
}

}  // namespace trocar::ultrasound
