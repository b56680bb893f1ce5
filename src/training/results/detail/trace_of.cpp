#include "results/detail/trace_of.h"

#include <cmath>

namespace trocar::results::detail {
namespace {

/// No attempt is that long; a damaged time must not fill the memory.
constexpr std::size_t kMostSamples = 200'000;

/// The force of the needle on the hand along its axis; negative pushes it out.
double force_n(const telemetry::TickSample& sample) {
  return -telemetry::axial_resistance_n(sample);
}

void append(Trace& trace, const telemetry::TickSample& sample, double extreme_n) {
  trace.time_s.push_back(sample.time_s);
  for (int axis = 0; axis < 3; ++axis) trace.tip_mm[static_cast<std::size_t>(axis)].push_back(sample.rest_tip_mm[axis]);
  trace.depth_mm.push_back(sample.depth_mm);
  trace.force_n.push_back(extreme_n);
  trace.tissue.push_back(sample.tissue);
}

void add_plan(const Segment& plan_P, Trace& trace) {
  for (int axis = 0; axis < 3; ++axis) {
    trace.plan_entry_mm[static_cast<std::size_t>(axis)] = plan_P.a[axis];
    trace.plan_target_mm[static_cast<std::size_t>(axis)] = plan_P.b[axis];
  }
}

}  // namespace

Trace trace_of(const storage::Session& session) {
  Trace trace;
  trace.rate_hz = kTraceRate_hz;
  trace.tissues = session.info.tissue_names;
  add_plan(session.info.plan_P.line_P, trace);
  double next_s = session.samples.empty() ? 0.0 : session.samples.front().time_s;
  double extreme_n = 0.0;
  for (const telemetry::TickSample& sample : session.samples) {
    if (trace.tissues.size() <= sample.tissue) trace.tissues.resize(sample.tissue + std::size_t{1});
    for (const telemetry::TickEvent& event : sample.events)  // limits of the device tell an instructor nothing
      if (event.kind == telemetry::EventKind::kPuncture || event.kind == telemetry::EventKind::kEnter)
        trace.events.push_back({sample.time_s, storage::event_text(session.info, event)});
    const double now_n = force_n(sample);
    if (std::abs(now_n) > std::abs(extreme_n)) extreme_n = now_n;
    if (!(sample.time_s >= next_s) || trace.time_s.size() >= kMostSamples) continue;
    append(trace, sample, extreme_n);
    extreme_n = 0.0;
    next_s += std::max(1.0, std::floor((sample.time_s - next_s) * kTraceRate_hz) + 1.0) / kTraceRate_hz;
  }
  return trace;
}

}  // namespace trocar::results::detail
