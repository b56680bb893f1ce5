#include "parameters/parameter_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace trocar::trainer {
namespace {

constexpr std::string_view kNone = "transfer.none", kFull = "transfer.full";

}  // namespace

void ParameterEdits::start(anatomy::TissueTable defaults, std::string model) {
  defaults_ = std::move(defaults);
  default_model_ = std::move(model);
  groups_ = anatomy::tissue_parameters(defaults_);
  Step step = now();
  for (Values* values : {&step.values, &step.base}) {
    std::erase_if(*values, [&](const auto& change) {
      const anatomy::TissueParameter* parameter = find(change.first);
      return parameter == nullptr || parameter->value == change.second;
    });
    if (!check(*values)) values->clear();
  }
  step.model = default_model_;
  if (step.profile.empty()) step.base_model = default_model_;
  steps_.begin(std::move(step));
}

const anatomy::TissueParameter* ParameterEdits::find(std::string_view setting) const noexcept {
  for (const anatomy::TissueParameterGroup& group : groups_)
    for (const anatomy::TissueParameter& parameter : group.parameters)
      if (parameter.setting == setting) return &parameter;
  return nullptr;
}

double ParameterEdits::value_of(const anatomy::TissueParameter& parameter) const {
  const auto changed = now().values.find(parameter.setting);
  return changed != now().values.end() ? changed->second : parameter.value;
}

bool ParameterEdits::is_changed(const anatomy::TissueParameterGroup& group) const {
  return std::any_of(group.parameters.begin(), group.parameters.end(),
                     [&](const anatomy::TissueParameter& parameter) { return is_changed(parameter); });
}

Status ParameterEdits::set(const std::string& setting, double value, bool joins) {
  const anatomy::TissueParameter* parameter = find(setting);
  if (parameter == nullptr)
    return fail_usage(fmt::format("unknown parameter \"{}\"", setting), "tissue parameters",
                      "select a parameter of the list");
  Values values = now().values;
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
  Values values = now().values;
  values.erase(setting);
  if (check(values)) keep(std::move(values));
}

void ParameterEdits::reset(const anatomy::TissueParameterGroup& group) {
  Values values = now().values;
  for (const anatomy::TissueParameter& parameter : group.parameters) values.erase(parameter.setting);
  if (check(values)) keep(std::move(values));
}

void ParameterEdits::reset_all() {
  keep({{}, now().model, {}, {}, default_model_});
}

void ParameterEdits::set_model(const std::string& model) {
  Step step = now();
  step.model = model;
  keep(std::move(step));
}

Status ParameterEdits::replace(const std::vector<std::string>& settings) {
  TROCAR_TRY(Values values, read(settings));
  TROCAR_TRY_STATUS(check(values));
  keep(std::move(values));
  return {};
}

Status ParameterEdits::choose_profile(const std::string& profile, const std::vector<std::string>& settings,
                                      const std::string& model) {
  TROCAR_TRY(const Values values, read(settings));
  TROCAR_TRY_STATUS(check(values));
  keep({values, model, profile, values, model});
  return {};
}

void ParameterEdits::call_profile(const std::string& profile) {
  Step called = now();
  called.profile = profile;
  steps_.put(called);
  steps_.change_all([&](Step& step) {
    if (step.profile != profile) return;
    step.base = called.values;
    step.base_model = called.model;
  });
}

void ParameterEdits::forget_profile(const std::string& profile) {
  steps_.change_all([&](Step& step) {
    if (step.profile != profile) return;
    step.profile.clear();
    step.base.clear();
    step.base_model = default_model_;
  });
}

/// Profiles can be written by hand with long names ("liver_capsule.stiffness_n_per_mm=0.5"): the change of the table
/// shows which parameter a setting refers to.
Result<ParameterEdits::Values> ParameterEdits::read(const std::vector<std::string>& settings) const {
  Values values;
  anatomy::TissueTable table = defaults_;
  for (const std::string& text : settings) {
    TROCAR_TRY(const anatomy::TissueSetting setting, anatomy::parse_setting(text));
    TROCAR_TRY_STATUS(anatomy::apply_setting(table, setting));
    const anatomy::TissueParameter* named = find(name_of(setting));
    const bool is_new = named != nullptr && !values.contains(named->setting);
    if (named != nullptr) {
      values[named->setting] = setting.value;
    } else {
      read_from(table, values);
    }
    if (!is_new && !gives(values, table))
      return fail_usage("the panel cannot edit this setting", text,
                        "use it with --set, or write it in the format of a saved profile");
  }
  std::erase_if(values, [&](const auto& change) { return find(change.first)->value == change.second; });
  return values;
}

/// Reads the numbers that differ between the table and the defaults. Factors are relative to the present curve and
/// cannot be derived from a table.
void ParameterEdits::read_from(const anatomy::TissueTable& table, Values& values) const {
  for (const anatomy::TissueParameterGroup& group : anatomy::tissue_parameters(table))
    for (const anatomy::TissueParameter& is : group.parameters) {
      const anatomy::TissueParameter* was = find(is.setting);
      if (was == nullptr || is.setting.ends_with("_factor")) continue;
      if (is.value != was->value) {
        values[is.setting] = is.value;
      } else {
        values.erase(is.setting);
      }
    }
}

/// True if these numbers turn the defaults into this table; sources are ignored.
bool ParameterEdits::gives(const Values& values, anatomy::TissueTable table) const {
  anatomy::TissueTable made = defaults_;
  for (const anatomy::TissueSetting& setting : changes_of(values))
    if (!anatomy::apply_setting(made, setting)) return false;
  made.provenance.clear();
  table.provenance.clear();
  return made.to_toml() == table.to_toml();
}

void ParameterEdits::keep(Values values, bool joins) {
  Step step = now();
  step.values = std::move(values);
  keep(std::move(step), joins);
}

void ParameterEdits::keep(Step step, bool joins) {
  // A new profile name alone is not an undo step.
  if (step.values == now().values && step.model == now().model) return steps_.put(std::move(step));
  steps_.step_to(std::move(step), joins);
}

std::vector<std::string> ParameterEdits::settings() const {
  std::vector<std::string> texts;
  for (const anatomy::TissueSetting& setting : changes()) texts.push_back(to_string(setting));
  return texts;
}

std::vector<anatomy::TissueSetting> ParameterEdits::changes_of(const Values& values) const {
  std::vector<anatomy::TissueSetting> settings;
  const auto add = [&](std::string_view name) {
    const auto change = values.find(name);
    if (change == values.end()) return;
    anatomy::TissueSetting setting = anatomy::make_setting(name, change->second);
    // Tissues with the same surface refer to the same number.
    if (std::find(settings.begin(), settings.end(), setting) == settings.end()) settings.push_back(std::move(setting));
  };
  // The lower threshold must never exceed the upper one in between: a raised upper threshold is set first.
  const anatomy::TissueParameter* full = find(kFull);
  const bool is_full_first = full != nullptr && values.contains(kFull) && values.find(kFull)->second > full->value;
  for (const anatomy::TissueParameterGroup& group : groups_)
    for (const anatomy::TissueParameter& parameter : group.parameters) {
      if (parameter.setting == kNone && is_full_first) add(kFull);
      add(parameter.setting);
    }
  return settings;
}

Status ParameterEdits::check(const Values& values) const {
  anatomy::TissueTable table = defaults_;
  for (const anatomy::TissueSetting& setting : changes_of(values))
    TROCAR_TRY_STATUS(anatomy::apply_setting(table, setting));
  return {};
}

}  // namespace trocar::trainer
