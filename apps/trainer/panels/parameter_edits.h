#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/tissue_parameters.h"
#include "anatomy/tissue_table.h"
#include "core/result.h"

namespace trocar::trainer {

/// The numbers of a tissue table that a person has changed, with undo. Invariant: every number is in its range, differs
/// from the default, and all of them together can be applied to the default table.
class ParameterEdits {
 public:
  /// Another table of defaults. Changes are kept where they still fit and still differ; what can be undone is
  /// forgotten.
  void start(TissueTable defaults);

  const std::vector<TissueParameterGroup>& groups() const noexcept { return groups_; }
  const TissueParameter* find(std::string_view setting) const noexcept;
  double value_of(const TissueParameter& parameter) const;
  bool is_changed(const TissueParameter& parameter) const { return values_.contains(parameter.setting); }
  bool is_changed(const TissueParameterGroup& group) const;
  bool is_changed() const noexcept { return !values_.empty(); }

  /// `joins`: one step of undo together with the last change (a slider that is still held). Errors: an unknown setting,
  /// a number out of range or against another one; nothing is changed then.
  Status set(const std::string& setting, double value, bool joins = false);
  void reset(const std::string& setting);
  void reset(const TissueParameterGroup& group);
  void reset_all();
  /// All changes at once, as a profile has them: "liver.k=0.5". Errors name the setting; nothing is changed then.
  Status replace(const std::vector<std::string>& settings);

  bool can_undo() const noexcept { return !undone_to_.empty(); }
  bool can_redo() const noexcept { return !redone_to_.empty(); }
  void undo();
  void redo();

  /// What differs from the defaults, "liver.k=0.5", in an order that can be applied one after the other.
  std::vector<std::string> settings() const { return settings_of(values_); }

 private:
  using Values = std::map<std::string, double, std::less<>>;

  std::vector<std::string> settings_of(const Values& values) const;
  Status check(const Values& values) const;
  void keep(Values values, bool joins = false);
  Result<Values> read(const std::vector<std::string>& settings) const;

  TissueTable defaults_;
  std::vector<TissueParameterGroup> groups_;
  Values values_;
  std::vector<Values> undone_to_, redone_to_;
};

}  // namespace trocar::trainer
