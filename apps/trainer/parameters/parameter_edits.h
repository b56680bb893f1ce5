#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/tissue/tissue_parameters.h"
#include "anatomy/tissue/tissue_settings.h"
#include "anatomy/tissue/tissue_table.h"
#include "core/result.h"
#include "core/step_history.h"

namespace trocar::trainer {

/// User changes of the numbers of a tissue table, with their force model, the profile they started from, and undo.
/// Invariant: every number is in its range and differs from the default, and all numbers together can be applied to the
/// default table.
class ParameterEdits {
 public:
  /// Sets another table of defaults with its force model. Changes that are still valid and still differ are kept; the
  /// undo steps are cleared.
  void start(anatomy::TissueTable defaults, std::string model);

  const std::vector<anatomy::TissueParameterGroup>& groups() const noexcept { return groups_; }
  const anatomy::TissueParameter* find(std::string_view setting) const noexcept;
  double value_of(const anatomy::TissueParameter& parameter) const;
  bool is_changed(const anatomy::TissueParameter& parameter) const { return now().values.contains(parameter.setting); }
  bool is_changed(const anatomy::TissueParameterGroup& group) const;
  bool is_changed() const noexcept { return !now().values.empty(); }

  /// `joins`: one step of undo together with the last change (a slider that is still held). Errors: an unknown setting,
  /// a number out of range or in conflict with another one; an error changes nothing.
  Status set(const std::string& setting, double value, bool joins = false);
  void reset(const std::string& setting);
  void reset(const anatomy::TissueParameterGroup& group);
  void reset_all();
  /// Replaces all changes by those of a profile: "liver.k=0.5". Errors name the setting; an error changes nothing.
  Status replace(const std::vector<std::string>& settings);
  const std::string& model() const noexcept { return now().model; }
  void set_model(const std::string& model);

  /// File of the profile that was selected last; empty: the defaults.
  const std::string& profile() const noexcept { return now().profile; }
  /// True if numbers or model differ from that profile.
  bool differs_from_profile() const noexcept { return now().values != now().base || now().model != now().base_model; }
  /// Sets numbers and model of a profile as one step; "" with no settings and the defaults' model selects the defaults.
  /// Errors: as replace().
  Status choose_profile(const std::string& profile, const std::vector<std::string>& settings, const std::string& model);
  /// Marks the present numbers and model as those of that profile.
  void call_profile(const std::string& profile);
  /// Removes a profile that no longer exists; numbers from it remain.
  void forget_profile(const std::string& profile);

  bool can_undo() const noexcept { return steps_.can_undo(); }
  bool can_redo() const noexcept { return steps_.can_redo(); }
  void undo() { steps_.undo(); }
  void redo() { steps_.redo(); }

  /// Differences from the defaults, in an order in which they can be applied one by one; settings() returns them as
  /// "liver.k=0.5".
  std::vector<anatomy::TissueSetting> changes() const { return changes_of(now().values); }
  std::vector<std::string> settings() const;

 private:
  using Values = std::map<std::string, double, std::less<>>;
  /// State that one undo step restores.
  struct Step {
    Values values;
    std::string model, profile;
    Values base;  ///< Values of the profile; base_model is its model.
    std::string base_model;
  };

  std::vector<anatomy::TissueSetting> changes_of(const Values& values) const;
  Status check(const Values& values) const;
  void keep(Values values, bool joins = false);
  void keep(Step step, bool joins = false);
  Result<Values> read(const std::vector<std::string>& settings) const;
  void read_from(const anatomy::TissueTable& table, Values& values) const;
  bool gives(const Values& values, anatomy::TissueTable table) const;
  const Step& now() const noexcept { return steps_.now(); }

  anatomy::TissueTable defaults_;
  std::vector<anatomy::TissueParameterGroup> groups_;
  std::string default_model_;
  StepHistory<Step> steps_;
};

}  // namespace trocar::trainer
