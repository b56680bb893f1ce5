#pragma once

#include <deque>
#include <optional>

namespace trocar::link::detail {

/// The difference of two clocks by question and answer: of the last seconds the fastest round trip counts, since its
/// two ways can differ least (as NTP's clock filter does, RFC 5905).
class ClockOffset {
 public:
  struct Estimate {
    double offset_s = 0.0;      ///< Their clock minus ours; wrong by at most half the round trip.
    double round_trip_s = 0.0;  ///< Never negative.
  };
  /// An answer that gave `their_s` came at `received_s` to a question of `sent_s` (both our clock). False and not taken
  /// when it came before the question.
  bool add(double sent_s, double their_s, double received_s);
  std::optional<Estimate> best() const;
  void clear() { pings_.clear(); }

 private:
  struct Ping {
    double received_s;
    Estimate estimate;
  };
  std::deque<Ping> pings_;  ///< Slower ones before a faster one are gone: the first is the best.
};

}  // namespace trocar::link::detail
