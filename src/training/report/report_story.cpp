#include "report/report_story.h"

#include <algorithm>

#include "scoring/phase_tracker.h"

namespace trocar::report {
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
  for (std::size_t n = 0; n < session.samples.size(); ++n) {
    const telemetry::TickSample& sample = session.samples[n];
    for (; action < session.actions.size() && session.actions[action].time_s <= sample.time_s; ++action)
      tracker.note(session.actions[action]);
    const bool is_last = n + 1 == session.samples.size();
    if (sample.time_s < due_s && !is_last) continue;
    due_s = sample.time_s + kStepEvery_s;
    scoring::PhaseMoment moment;
    moment.needle = sample;
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
