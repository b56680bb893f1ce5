#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "metrics/measure_run.h"

namespace trocar::testing {

using Recording = std::vector<metrics::Moment>;

/// Moments at a rate from 0 to a time, inclusive; `set` sets the needle at a time.
inline Recording record(double until_s, double rate_hz,
                        const std::function<void(double time_s, metrics::Moment&)>& set) {
  Recording recording;
  const auto count = static_cast<std::size_t>(std::llround(until_s * rate_hz));
  for (std::size_t n = 0; n <= count; ++n) {
    metrics::Moment moment;
    moment.time_s = static_cast<double>(n) / rate_hz;
    set(moment.time_s, moment);
    recording.push_back(moment);
  }
  return recording;
}

/// A needle along +y into a body whose skin is y = 0, tip at the given depth (negative: before the skin).
inline void set_depth(metrics::Moment& moment, double depth_mm) {
  moment.tip_P = {0.0, depth_mm, 0.0};
  moment.axis_P = Vec3::UnitY();
  moment.depth_mm = std::max(0.0, depth_mm);
}

inline std::vector<metrics::MetricValue> measure(const Recording& recording, metrics::MetricContext context = {}) {
  metrics::MeasureRun run(std::move(context));
  for (const metrics::Moment& moment : recording) run.step(moment);
  return run.report();
}

inline const metrics::MetricValue& find(const std::vector<metrics::MetricValue>& values, const std::string& name) {
  for (const metrics::MetricValue& value : values)
    if (value.name == name) return value;
  ADD_FAILURE() << "no metric " << name;
  static const metrics::MetricValue none;
  return none;
}

/// The value of a metric; NaN and a test failure if it has none.
inline double value_of(const std::vector<metrics::MetricValue>& values, const std::string& name) {
  const metrics::MetricValue& value = find(values, name);
  EXPECT_TRUE(value.value) << name << ": " << value.missing;
  return value.value.value_or(std::nan(""));
}
inline double measure_one(const std::string& name, const Recording& recording, metrics::MetricContext context = {}) {
  return value_of(measure(recording, std::move(context)), name);
}
inline std::string missing_of(const std::string& name, const Recording& recording,
                              metrics::MetricContext context = {}) {
  const auto values = measure(recording, std::move(context));
  EXPECT_FALSE(find(values, name).value) << name;
  return find(values, name).missing;
}

inline metrics::MetricContext with_paths(std::vector<metrics::ExpertPath> paths) {
  metrics::MetricContext context;
  context.expert_paths = std::move(paths);
  return context;
}

}  // namespace trocar::testing
