#include "report/session_analysis.h"

#include <fmt/format.h>

#include <algorithm>

namespace trocar::report {
namespace {

constexpr double kDropWindow_s = 0.1;

bool gives_way(const telemetry::TickSample& sample) {
  return std::any_of(sample.events.begin(), sample.events.end(),
                     [](const telemetry::TickEvent& event) { return event.kind == telemetry::EventKind::kPuncture; });
}

double drop_after(const std::vector<telemetry::TickSample>& samples, std::size_t tick) {
  double lowest = telemetry::axial_resistance_n(samples[tick]);
  for (std::size_t i = tick + 1; i < samples.size(); ++i) {
    if (samples[i].time_s > samples[tick].time_s + kDropWindow_s || gives_way(samples[i])) break;
    lowest = std::min(lowest, telemetry::axial_resistance_n(samples[i]));
  }
  return telemetry::axial_resistance_n(samples[tick]) - lowest;
}

}  // namespace

std::vector<Puncture> find_punctures(const storage::Session& session) {
  std::vector<Puncture> punctures;
  for (std::size_t i = 0; i < session.samples.size(); ++i) {
    const telemetry::TickSample& sample = session.samples[i];
    for (const telemetry::TickEvent& event : sample.events) {
      if (event.kind != telemetry::EventKind::kPuncture) continue;
      const auto& names = session.info.layer_names;
      punctures.push_back({i, event.id < names.size() ? names[event.id] : fmt::format("#{}", event.id), sample.time_s,
                           sample.depth_mm, telemetry::tip_load_n(sample), telemetry::axial_resistance_n(sample),
                           drop_after(session.samples, i)});
    }
  }
  return punctures;
}

std::vector<Insertion> find_insertions(const storage::Session& session, double min_depth_mm) {
  const auto& samples = session.samples;
  std::vector<Insertion> insertions;
  std::optional<Insertion> open;
  const auto close = [&](std::size_t last) {
    open->last = last;
    if (samples[open->deepest].depth_mm >= min_depth_mm) insertions.push_back(*open);
    open.reset();
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].phase == telemetry::InsertionPhase::kOutside) {
      if (open) close(i - 1);
      continue;
    }
    if (!open) open = Insertion{i, i, i};
    if (samples[i].depth_mm > samples[open->deepest].depth_mm) open->deepest = i;
  }
  if (open) close(samples.size() - 1);
  return insertions;
}

std::vector<TissueRun> tissues_along(const storage::Session& session, const Insertion& insertion) {
  std::vector<TissueRun> runs;
  double reached_mm = 0.0;
  for (std::size_t i = insertion.first; i <= insertion.deepest; ++i) {
    const telemetry::TickSample& sample = session.samples[i];
    if (!(sample.depth_mm > reached_mm)) continue;
    if (runs.empty() || runs.back().tissue != sample.tissue)
      runs.push_back({reached_mm, sample.depth_mm, sample.tissue});
    else
      runs.back().to_mm = sample.depth_mm;
    reached_mm = sample.depth_mm;
  }
  return runs;
}

std::vector<PhaseRun> phase_runs(const storage::Session& session) {
  std::vector<PhaseRun> runs;
  for (const telemetry::TickSample& sample : session.samples) {
    if (!runs.empty()) runs.back().to_s = sample.time_s;
    if (runs.empty() || runs.back().phase != sample.phase) runs.push_back({sample.time_s, sample.time_s, sample.phase});
  }
  return runs;
}

std::string tissue_name(const storage::SessionInfo& info, std::uint8_t id) {
  return id < info.tissue_names.size() ? info.tissue_names[id] : fmt::format("#{}", id);
}

}  // namespace trocar::report
