#pragma once

#include <QString>

#include "anatomy/tissue/tissue_parameters.h"

namespace trocar::trainer {

/// Positions 0..kSteps of a slider for the range of a parameter: straight, or logarithmic where the range spans
/// decades. A range from zero has zero at position 0.
class ParameterScale {
 public:
  static constexpr int kSteps = 1000;

  explicit ParameterScale(const anatomy::TissueParameter& parameter);
  /// Beyond the range, infinite included: the nearest end.
  int position_of(double value) const noexcept;
  /// Three significant digits, inside the range.
  double value_at(int position) const noexcept;

 private:
  double low_, high_, log_from_;
};

/// The shortest digits that read back to the same number; infinite: "never".
QString number_text(double value);
/// "0.001 to 50 N/mm", and "or never" where that is a value.
QString range_text(const anatomy::TissueParameter& parameter);
/// What a person has typed; a comma is a point. Nothing but a number in the range (or "never" where it may be).
bool read_number(const QString& text, const anatomy::TissueParameter& parameter, double& value);

}  // namespace trocar::trainer
