#include "ultrasound/doppler/vessel_flow.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "config/toml.h"
#include "core/result.h"
#include "ultrasound/doppler/detail/vessel_flow_maker.h"
#include "ultrasound/probe/detail/view_anatomy.h"

namespace trocar::ultrasound {

VesselFlow::Moment VesselFlow::moment(double time_s, double breath_phase) const noexcept {
  Moment values{};
  for (std::size_t n = 0; n < table_.waveforms.size(); ++n)
    values[n] = static_cast<float>(table_.waveforms[n].at(time_s, table_.heart_per_min, breath_phase));
  return values;
}

VesselFlow::Blood VesselFlow::at(const Vec3f& p_A, const Moment& moment) const noexcept {
  Blood blood;
  std::array<std::int32_t, 3> brick;
  std::array<std::int32_t, 3> cell;
  std::array<float, 3> part;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto& row = index_of_P_[a];
    const float index = row[0] * p_A.x() + row[1] * p_A.y() + row[2] * p_A.z() + index_of_origin_[a];
    if (!(index >= 0.0F && index < static_cast<float>(kBrick * brick_count_[a]))) return blood;
    const auto whole = static_cast<std::int32_t>(index);
    part[a] = index - static_cast<float>(whole);
    brick[a] = whole >> kBrickBits;
    cell[a] = whole & (kBrick - 1);
  }
  const std::int32_t first =
      bricks_[static_cast<std::size_t>((brick[2] * brick_count_[1] + brick[1]) * brick_count_[0] + brick[0])];
  if (first < 0) return blood;
  const Cell* corner = cells_.data() + first + (cell[2] * kBrickSide + cell[1]) * kBrickSide + cell[0];
  for (int n = 0; n < 8; ++n) {
    const Cell& at = corner[(n & 1) + (n & 2) / 2 * kBrickSide + (n & 4) / 4 * kBrickSide * kBrickSide];
    if (at.share == 0) continue;
    const float weight = ((n & 1) != 0 ? part[0] : 1.0F - part[0]) * ((n & 2) != 0 ? part[1] : 1.0F - part[1]) *
                         ((n & 4) != 0 ? part[2] : 1.0F - part[2]);
    blood.share += weight * static_cast<float>(at.share);
    const float speed = weight * kSpeedStep_mm_per_s * moment[at.waveform];
    for (std::size_t a = 0; a < 3; ++a)
      blood.velocity_A[static_cast<Eigen::Index>(a)] += speed * static_cast<float>(at.velocity_A[a]);
  }
  blood.share /= 255.0F;
  return blood;
}

Vec3 VesselFlow::velocity_A(const Vec3& p_A, double time_s, double breath_phase) const noexcept {
  return at(p_A.cast<float>(), moment(time_s, breath_phase)).velocity_A.cast<double>();
}

bool is_vessel(const anatomy::Label& label) {
  return label.tissue == "vessel";
}

Result<std::shared_ptr<const VesselFlow>> make_vessel_flow(const anatomy::VirtualPatient& patient, FlowTable table,
                                                           const VesselFlowOptions& options, const Progress& progress,
                                                           const std::stop_token& stop) {
  TROCAR_CHECK(options.spacing_mm >= 0.3 && options.spacing_mm <= 3.0);
  TROCAR_CHECK(table.waveforms.size() <= VesselFlow::Moment{}.size());
  VesselFlowMaker maker(patient, std::move(table), options);
  const std::vector<anatomy::Label>& labels = patient.label_table.labels;
  for (std::size_t n = 0; n < labels.size(); ++n) {
    if (!is_vessel(labels[n])) continue;
    if (stop.stop_requested()) return fail("the blood flow was not computed: cancelled", patient.name, "ask again");
    report(progress, "following " + labels[n].name, static_cast<double>(n) / static_cast<double>(labels.size()));
    maker.add(labels[n]);
  }
  std::shared_ptr<const VesselFlow> flow = maker.finish();
  if (!flow->branches().empty()) return flow;
  return fail(flow->without_flow().empty() ? "no labelled vessel" : "no flow data for the labelled vessels",
              patient.name,
              flow->without_flow().empty()
                  ? "label some: aorta, inferior_vena_cava, portal_vein_and_splenic_vein, hepatic_veins"
                  : fmt::format("add a row to flow.toml for {}", fmt::join(flow->without_flow(), ", ")));
}

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
