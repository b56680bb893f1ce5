#include "parameters/parameter_scale.h"

#include <fmt/format.h>

#include <QCoreApplication>
#include <QLocale>
#include <algorithm>
#include <cmath>
#include <limits>

#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

double rounded(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  return QString::number(value, 'g', 3).toDouble();
}

}  // namespace

ParameterScale::ParameterScale(const anatomy::TissueParameter& parameter)
    : low_(parameter.low), high_(parameter.high), log_from_(parameter.log_from) {}

int ParameterScale::position_of(double value) const noexcept {
  if (!(value > low_)) return 0;
  if (value >= high_) return kSteps;
  const double share = log_from_ > 0.0 ? std::log(std::max(value, log_from_) / log_from_) / std::log(high_ / log_from_)
                                       : (value - low_) / (high_ - low_);
  // A positive number is not displayed as zero.
  const int least = log_from_ > low_ ? 1 : 0;
  return std::clamp(static_cast<int>(std::lround(share * kSteps)), least, kSteps);
}

double ParameterScale::value_at(int position) const noexcept {
  if (position <= 0) return low_;
  if (position >= kSteps) return high_;
  const double share = static_cast<double>(position) / kSteps;
  const double value = log_from_ > 0.0 ? log_from_ * std::pow(high_ / log_from_, share) : low_ + share * (high_ - low_);
  return std::clamp(rounded(value), low_, high_);
}

QString number_text(double value) {
  return std::isinf(value) ? QCoreApplication::translate("ParameterScale", "never") : shown(fmt::format("{}", value));
}

QString range_text(const anatomy::TissueParameter& parameter) {
  QString text = QCoreApplication::translate("ParameterScale", "%1 to %2")
                     .arg(number_text(parameter.low), number_text(parameter.high));
  if (!parameter.unit.empty()) text += QStringLiteral(" ") + shown(parameter.unit);
  if (parameter.may_be_never) text += QCoreApplication::translate("ParameterScale", ", or never");
  return text;
}

bool read_number(const QString& text, const anatomy::TissueParameter& parameter, double& value) {
  QString plain = text.trimmed();
  if (parameter.may_be_never &&
      plain.compare(QCoreApplication::translate("ParameterScale", "never"), Qt::CaseInsensitive) == 0) {
    value = std::numeric_limits<double>::infinity();
    return true;
  }
  bool is_number = false;
  const double number = QLocale::c().toDouble(plain.replace(QLatin1Char(','), QLatin1Char('.')), &is_number);
  if (!is_number || !std::isfinite(number) || number < parameter.low || number > parameter.high) return false;
  value = number;
  return true;
}

}  // namespace trocar::trainer
