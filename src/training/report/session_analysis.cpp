#include "report/session_analysis.h"

#include <fmt/format.h>

#include <algorithm>

namespace trocar {
namespace {

constexpr double kDropWindow_s = 0.1;

bool gives_way(const TickSample& sample) {
  return std::any_of(sample.events.begin(), sample.events.end(),
                     [](const TickEvent& event) { return event.kind == EventKind::kPuncture; });
}

double drop_after(const std::vector<TickSample>& samples, std::size_t tick) {
  double lowest = axial_resistance_n(samples[tick]);
  for (std::size_t i = tick + 1; i < samples.size(); ++i) {
    if (samples[i].time_s > samples[tick].time_s + kDropWindow_s || gives_way(samples[i])) break;
    lowest = std::min(lowest, axial_resistance_n(samples[i]));
  }
  return axial_resistance_n(samples[tick]) - lowest;
}

}  // namespace

std::vector<Puncture> find_punctures(const Session& session) {
  std::vector<Puncture> punctures;
  for (std::size_t i = 0; i < session.samples.size(); ++i) {
    const TickSample& sample = session.samples[i];
    for (const TickEvent& event : sample.events) {
      if (event.kind != EventKind::kPuncture) continue;
      const auto& names = session.info.layer_names;
      punctures.push_back({i, event.id < names.size() ? names[event.id] : fmt::format("#{}", event.id), sample.time_s,
                           sample.depth_mm, tip_load_n(sample), axial_resistance_n(sample),
                           drop_after(session.samples, i)});
    }
  }
  return punctures;
}

std::vector<Insertion> find_insertions(const Session& session, double min_depth_mm) {
  const auto& samples = session.samples;
  std::vector<Insertion> insertions;
  std::optional<Insertion> open;
  const auto close = [&](std::size_t last) {
    open->last = last;
    if (samples[open->deepest].depth_mm >= min_depth_mm) insertions.push_back(*open);
    open.reset();
  };
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (samples[i].phase == InsertionPhase::kOutside) {
      if (open) close(i - 1);
      continue;
    }
    if (!open) open = Insertion{i, i, i};
    if (samples[i].depth_mm > samples[open->deepest].depth_mm) open->deepest = i;
  }
  if (open) close(samples.size() - 1);
  return insertions;
}

std::vector<TissueRun> tissues_along(const Session& session, const Insertion& insertion) {
  std::vector<TissueRun> runs;
  double reached_mm = 0.0;
  for (std::size_t i = insertion.first; i <= insertion.deepest; ++i) {
    const TickSample& sample = session.samples[i];
    if (!(sample.depth_mm > reached_mm)) continue;
    if (runs.empty() || runs.back().tissue != sample.tissue)
      runs.push_back({reached_mm, sample.depth_mm, sample.tissue});
    else
      runs.back().to_mm = sample.depth_mm;
    reached_mm = sample.depth_mm;
  }
  return runs;
}

std::vector<PhaseRun> phase_runs(const Session& session) {
  std::vector<PhaseRun> runs;
  for (const TickSample& sample : session.samples) {
    if (!runs.empty()) runs.back().to_s = sample.time_s;
    if (runs.empty() || runs.back().phase != sample.phase) runs.push_back({sample.time_s, sample.time_s, sample.phase});
  }
  return runs;
}

std::string tissue_name(const SessionInfo& info, std::uint8_t id) {
  return id < info.tissue_names.size() ? info.tissue_names[id] : fmt::format("#{}", id);
}

}  // namespace trocar
