#pragma once

#include <algorithm>

namespace trocar::server::detail {

/// Age of a device's last fresh reading.
class ReadingAge {
 public:
  /// One period of `dt_s` seconds whose reading is fresh or not. Returns the time since the fresh reading before, s.
  double advance(bool is_fresh, double dt_s, double max_unread_s) noexcept {
    // A busy machine that delays this loop delays the driver as well: the device is not silent before some periods in
    // turn have brought nothing.
    constexpr double kFewestPeriods = 4.0;
    const double since_s = age_s_ + dt_s;
    age_s_ = is_fresh ? 0.0 : since_s;
    unread_s_ = is_fresh ? 0.0 : unread_s_ + std::min(dt_s, max_unread_s / kFewestPeriods);
    return since_s;
  }
  /// The device's silence, s: the age, in which a period counts for at most a quarter of `max_unread_s`.
  double unread_s() const noexcept { return unread_s_; }

 private:
  double age_s_ = 0.0;
  double unread_s_ = 0.0;
};

}  // namespace trocar::server::detail
