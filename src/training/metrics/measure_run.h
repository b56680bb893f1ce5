#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "metrics/attempt_track.h"
#include "metrics/metric.h"

namespace trocar::metrics {

/// Measures a recording: every metric of the catalogue, moment by moment. Memory is bounded for any length. Moments
/// that are not finite, have no axis or are not later than the one before are left out.
class MeasureRun {
 public:
  /// What `context` points at must outlive it.
  explicit MeasureRun(MetricContext context);
  MeasureRun(MeasureRun&&) noexcept;
  ~MeasureRun();

  void step(const Moment& moment);
  /// All values up to now, in the order of the catalogue.
  std::vector<MetricValue> report() const;
  RunEnd end() const;
  std::size_t moments() const noexcept { return moments_; }  ///< Valid ones.
  std::size_t left_out() const noexcept { return left_out_; }

 private:
  bool complete(Moment& moment) const;
  void note_roles(const Moment& moment);
  void report_group(std::size_t group, const RunEnd& end, std::span<MetricValue> values) const;

  MetricContext context_;
  std::vector<std::unique_ptr<Metric>> metrics_;  ///< By group; null: the context lacks a role.
  Roles roles_;
  std::optional<Moment> before_;
  double active_s_ = 0.0;
  std::size_t moments_ = 0, left_out_ = 0;
  bool has_pause_ = false;
  AttemptTrack track_;
};

}  // namespace trocar::metrics
