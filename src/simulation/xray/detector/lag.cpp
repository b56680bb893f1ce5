#include "xray/detector/lag.h"

#include <algorithm>
#include <cmath>

namespace trocar::xray {
namespace {

constexpr double kRate_hz = 30.0;  ///< Of DetectorParams::lag_share.

}  // namespace

void Lag::apply(double share, double elapsed_s, std::span<float> signal) {
  const double left = std::pow(std::clamp(share, 0.0, 0.99), kRate_hz * std::max(elapsed_s, 0.0));
  if (former_.size() == signal.size()) {
    const auto kept = static_cast<float>(share > 0.0 ? left : 0.0);
    for (std::size_t n = 0; n < signal.size(); ++n) signal[n] += kept * (former_[n] - signal[n]);
  }
  former_.assign(signal.begin(), signal.end());
}

}  // namespace trocar::xray
