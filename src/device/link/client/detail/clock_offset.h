#pragma once

#include <deque>
#include <optional>

namespace trocar::link::detail {

/// Offset between two clocks, measured with round trips. The fastest round trip of the last seconds is used, because
/// its two directions can differ least (like NTP's clock filter, RFC 5905).
class ClockOffset {
 public:
  struct Estimate {
    double offset_s = 0.0;      ///< Remote clock minus own clock; the error is at most half the round trip.
    double round_trip_s = 0.0;  ///< Never negative.
  };
  /// Adds a round trip: request sent at `sent_s`, answer with `their_s` received at `received_s` (sent and received:
  /// own clock). Returns false, and does not add it, if the answer came before the request.
  bool add(double sent_s, double their_s, double received_s);
  std::optional<Estimate> best() const;
  void clear() { pings_.clear(); }

 private:
  struct Ping {
    double received_s;
    Estimate estimate;
  };
  std::deque<Ping> pings_;  ///< A faster round trip removes the slower ones before it: the first is the best.
};

}  // namespace trocar::link::detail
