#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/tissue/tissue_parameters.h"
#include "anatomy/tissue/tissue_setting.h"
#include "anatomy/tissue/tissue_table.h"
#include "core/result.h"
#include "core/step_history.h"

namespace trocar::trainer {

/// The numbers of a tissue table that a person has changed, the force model they are meant for and the profile they
/// began with, with undo. Invariant: every number is in its range, differs from the default, and all of them together
/// can be applied to the default table.
class ParameterEdits {
 public:
  /// Another table of defaults with its force model. Changes are kept where they still fit and still differ; what can
  /// be undone is forgotten.
  void start(anatomy::TissueTable defaults, std::string model);

  const std::vector<anatomy::TissueParameterGroup>& groups() const noexcept { return groups_; }
  const anatomy::TissueParameter* find(std::string_view setting) const noexcept;
  double value_of(const anatomy::TissueParameter& parameter) const;
  bool is_changed(const anatomy::TissueParameter& parameter) const { return now().values.contains(parameter.setting); }
  bool is_changed(const anatomy::TissueParameterGroup& group) const;
  bool is_changed() const noexcept { return !now().values.empty(); }

  /// `joins`: one step of undo together with the last change (a slider that is still held). Errors: an unknown setting,
  /// a number out of range or against another one; nothing is changed then.
  Status set(const std::string& setting, double value, bool joins = false);
  void reset(const std::string& setting);
  void reset(const anatomy::TissueParameterGroup& group);
  void reset_all();
  /// All changes at once, as a profile has them: "liver.k=0.5". Errors name the setting; nothing is changed then.
  Status replace(const std::vector<std::string>& settings);
  const std::string& model() const noexcept { return now().model; }
  void set_model(const std::string& model);

  /// The profile that was chosen last, by its file; empty: the defaults.
  const std::string& profile() const noexcept { return now().profile; }
  /// Whether numbers or model are other than that profile's.
  bool differs_from_profile() const noexcept { return now().values != now().base || now().model != now().base_model; }
  /// Numbers and model of a profile as one step; "" with no settings and the defaults' model: the defaults. Errors as
  /// replace().
  Status choose_profile(const std::string& profile, const std::vector<std::string>& settings, const std::string& model);
  /// All is now as saved in that profile.
  void call_profile(const std::string& profile);
  /// There is no such profile any more; numbers that came from it stay.
  void forget_profile(const std::string& profile);

  bool can_undo() const noexcept { return steps_.can_undo(); }
  bool can_redo() const noexcept { return steps_.can_redo(); }
  void undo() { steps_.undo(); }
  void redo() { steps_.redo(); }

  /// What differs from the defaults, in an order that can be applied one after the other; settings() as "liver.k=0.5".
  std::vector<anatomy::TissueSetting> changes() const { return changes_of(now().values); }
  std::vector<std::string> settings() const;

 private:
  using Values = std::map<std::string, double, std::less<>>;
  /// All that one step of undo gives back.
  struct Step {
    Values values;
    std::string model, profile;
    Values base;  ///< Of the profile, and its model.
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
