#include "panels/parameter_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <utility>

namespace trocar::trainer {
namespace {

constexpr std::size_t kMostSteps = 200;  ///< That can be undone.
constexpr std::string_view kNone = "transfer.none", kFull = "transfer.full";

std::string text_of(double value) {
  return std::isinf(value) ? "never" : fmt::format("{}", value);  // the shortest digits that read back
}

/// The number behind the "=" of a setting; apply_override says what is wrong with one that is none.
double number_in(std::string_view text) {
  double value = std::numeric_limits<double>::quiet_NaN();
  if (text == "never") return std::numeric_limits<double>::infinity();
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

void ParameterEdits::start(TissueTable defaults) {
  defaults_ = std::move(defaults);
  groups_ = tissue_parameters(defaults_);
  undone_to_.clear();
  redone_to_.clear();
  std::erase_if(values_, [&](const auto& change) {
    const TissueParameter* parameter = find(change.first);
    return parameter == nullptr || parameter->value == change.second;
  });
  if (!check(values_)) values_.clear();
}

const TissueParameter* ParameterEdits::find(std::string_view setting) const noexcept {
  for (const TissueParameterGroup& group : groups_)
    for (const TissueParameter& parameter : group.parameters)
      if (parameter.setting == setting) return &parameter;
  return nullptr;
}

double ParameterEdits::value_of(const TissueParameter& parameter) const {
  const auto changed = values_.find(parameter.setting);
  return changed != values_.end() ? changed->second : parameter.value;
}

bool ParameterEdits::is_changed(const TissueParameterGroup& group) const {
  return std::any_of(group.parameters.begin(), group.parameters.end(),
                     [&](const TissueParameter& parameter) { return is_changed(parameter); });
}

Status ParameterEdits::set(const std::string& setting, double value, bool joins) {
  const TissueParameter* parameter = find(setting);
  if (parameter == nullptr) return fail_usage(fmt::format("there is no number \"{}\"", setting), "tissue parameters");
  Values values = values_;
  if (value == parameter->value) {
    values.erase(setting);
  } else {
    values[setting] = value;
  }
  TROCAR_TRY_STATUS(check(values));
  keep(std::move(values), joins);
  return {};
}

void ParameterEdits::reset(const std::string& setting) {
  Values values = values_;
  values.erase(setting);
  if (check(values)) keep(std::move(values));
}

void ParameterEdits::reset(const TissueParameterGroup& group) {
  Values values = values_;
  for (const TissueParameter& parameter : group.parameters) values.erase(parameter.setting);
  if (check(values)) keep(std::move(values));
}

void ParameterEdits::reset_all() {
  keep({});
}

Status ParameterEdits::replace(const std::vector<std::string>& settings) {
  TROCAR_TRY(Values values, read(settings));
  TROCAR_TRY_STATUS(check(values));
  keep(std::move(values));
  return {};
}

/// Profiles may be written by hand, with other names of the same numbers ("liver_capsule.stiffness_n_per_mm=0.5"): what
/// such a setting does to the table tells which number is meant.
Result<ParameterEdits::Values> ParameterEdits::read(const std::vector<std::string>& settings) const {
  Values values;
  TissueTable table = defaults_;
  for (const std::string& text : settings) {
    TROCAR_TRY_STATUS(apply_override(table, text));
    const std::size_t equals = text.find('=');
    if (const TissueParameter* named = find(std::string_view(text).substr(0, equals))) {
      values[named->setting] = number_in(std::string_view(text).substr(equals + 1));
      continue;
    }
    for (const TissueParameterGroup& group : tissue_parameters(table))
      for (const TissueParameter& is : group.parameters) {
        const TissueParameter* was = find(is.setting);
        if (was != nullptr && is.value != was->value) values[is.setting] = is.value;
      }
  }
  std::erase_if(values, [&](const auto& change) { return find(change.first)->value == change.second; });
  return values;
}

void ParameterEdits::undo() {
  if (undone_to_.empty()) return;
  redone_to_.push_back(std::exchange(values_, std::move(undone_to_.back())));
  undone_to_.pop_back();
}

void ParameterEdits::redo() {
  if (redone_to_.empty()) return;
  undone_to_.push_back(std::exchange(values_, std::move(redone_to_.back())));
  redone_to_.pop_back();
}

void ParameterEdits::keep(Values values, bool joins) {
  if (values == values_) return;
  if (!joins || undone_to_.empty()) undone_to_.push_back(values_);
  if (undone_to_.size() > kMostSteps) undone_to_.erase(undone_to_.begin());
  redone_to_.clear();
  values_ = std::move(values);
}

std::vector<std::string> ParameterEdits::settings_of(const Values& values) const {
  std::vector<std::string> settings;
  const auto add = [&](std::string_view setting) {
    const auto change = values.find(setting);
    std::string text = change != values.end() ? fmt::format("{}={}", setting, text_of(change->second)) : "";
    // Tissues under one surface name the same number.
    if (!text.empty() && std::find(settings.begin(), settings.end(), text) == settings.end())
      settings.push_back(std::move(text));
  };
  // The lower of two thresholds is never above the higher one on the way: a raised upper one comes first.
  const TissueParameter* full = find(kFull);
  const bool is_full_first = full != nullptr && values.contains(kFull) && values.find(kFull)->second > full->value;
  for (const TissueParameterGroup& group : groups_)
    for (const TissueParameter& parameter : group.parameters) {
      if (parameter.setting == kNone && is_full_first) add(kFull);
      add(parameter.setting);
    }
  return settings;
}

Status ParameterEdits::check(const Values& values) const {
  TissueTable table = defaults_;
  for (const std::string& setting : settings_of(values)) TROCAR_TRY_STATUS(apply_override(table, setting));
  return {};
}

}  // namespace trocar::trainer
