#include "report/session_analysis.h"

#include <fmt/format.h>

#include <algorithm>

#include "scoring/phase_tracker.h"

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

namespace {

constexpr double kStepEvery_s = 0.02;  ///< As in a live attempt.

/// The newest entry up to a time; nullptr: there is none yet. `next` goes on with the calls.
template <class Entry>
const Entry* newest_of(const std::vector<Entry>& entries, std::size_t& next, double time_s) {
  while (next < entries.size() && entries[next].time_s <= time_s) ++next;
  return next == 0 ? nullptr : &entries[next - 1];
}

/// Times of the shots that took a core, in order. A session of an older program has no times of its cores: those of its
/// shots count.
std::vector<double> core_times_s(const storage::Session& session) {
  std::vector<double> times_s;
  if (!session.outcome) return times_s;
  const std::vector<scoring::BiopsyCore>& cores = session.outcome->cores;
  for (std::size_t n = 0; n < cores.size(); ++n) {
    const bool has_shot = session.shots.size() == cores.size() && session.shots[n] < session.samples.size();
    if (cores[n].pieces.empty()) continue;
    times_s.push_back(cores[n].time_s > 0.0 || !has_shot ? cores[n].time_s : session.samples[session.shots[n]].time_s);
  }
  return times_s;
}

}  // namespace

bool is_praise(const scoring::Hint& hint) noexcept {
  return hint.text.starts_with("Well done");
}

std::vector<StepTime> step_times(const storage::Session& session, const tasks::Task& task,
                                 const anatomy::VirtualPatient& patient, const tasks::Needle& needle,
                                 const tasks::PlannedPath& plan) {
  std::vector<StepTime> steps;
  if (task.phases.empty()) return steps;
  scoring::PhaseTracker tracker(task, patient, needle, plan, session.info.plane.value_or(metrics::ImagePlane{}));
  std::size_t action = 0, transducer = 0, xray = 0;
  const std::vector<double> cores_s = core_times_s(session);
  double due_s = -1.0;
  const bool is_moved =
      patient.motion != nullptr && std::ranges::any_of(session.samples, [](const telemetry::TickSample& s) {
        return s.drivers != telemetry::Drivers{};
      });
  for (std::size_t n = 0; n < session.samples.size(); ++n) {
    const telemetry::TickSample& sample = session.samples[n];
    for (; action < session.actions.size() && session.actions[action].time_s <= sample.time_s; ++action)
      tracker.note(session.actions[action]);
    const bool is_last = n + 1 == session.samples.size();
    if (sample.time_s < due_s && !is_last) continue;
    due_s = sample.time_s + kStepEvery_s;
    scoring::PhaseMoment moment;
    moment.needle = sample;
    if (is_moved) moment.motion = metrics::recorded_motion(patient.motion.get(), sample);
    if (const storage::TransducerSample* pose = newest_of(session.transducer, transducer, sample.time_s)) {
      moment.X_PT = pose->X_PT;
      moment.contact_n = pose->contact_n;
    }
    if (const tasks::XrayUse* use = newest_of(session.xray, xray, sample.time_s)) moment.contrast_ml = use->contrast_ml;
    moment.cores = static_cast<std::size_t>(std::ranges::upper_bound(cores_s, sample.time_s) - cores_s.begin());
    tracker.step(moment);
  }
  const auto states = tracker.states();
  for (std::size_t n = 0; n < std::min(states.size(), task.phases.size()); ++n)
    steps.push_back({task.phases[n].title, states[n].begun_s, states[n].done_s});
  return steps;
}

}  // namespace trocar::report
