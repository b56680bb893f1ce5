#pragma once

#include <QString>

#include "anatomy/tissue/tissue_parameters.h"

namespace trocar::trainer {

/// Positions 0..kSteps of a slider for the range of a parameter: linear, or logarithmic if the range spans decades. For
/// a range from zero, position 0 is zero.
class ParameterScale {
 public:
  static constexpr int kSteps = 1000;

  explicit ParameterScale(const anatomy::TissueParameter& parameter);
  /// Values beyond the range, including infinity, give the nearest end.
  int position_of(double value) const noexcept;
  /// Value with three significant digits, inside the range.
  double value_at(int position) const noexcept;

 private:
  double low_, high_, log_from_;
};

/// The shortest decimal text that is read back as the same number; infinity: "never".
QString number_text(double value);
/// "0.001 to 50 N/mm", with "or never" if infinity is allowed.
QString range_text(const anatomy::TissueParameter& parameter);
/// Parses user input; a comma is a decimal point. False unless it is a number in the range (or "never" if allowed).
bool read_number(const QString& text, const anatomy::TissueParameter& parameter, double& value);

}  // namespace trocar::trainer
