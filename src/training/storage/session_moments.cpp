#include "storage/session_moments.h"

#include <algorithm>

#include "scoring/attempt_end.h"

namespace trocar::storage {
namespace {

/// Moves `next` to the first sample later than a time; the sample in force is the one before.
template <class Sample>
const Sample* newest(const std::vector<Sample>& samples, std::size_t& next, double time_s) {
  while (next < samples.size() && samples[next].time_s <= time_s) ++next;
  return next == 0 ? nullptr : &samples[next - 1];
}

}  // namespace

void walk_moments(const Session& session, const std::function<void(const metrics::Moment&)>& visit) {
  std::size_t transducer = 0, xray = 0, gap = 0, damage = 0;
  for (std::size_t n = 0; n < session.samples.size(); ++n) {
    metrics::Moment moment = metrics::moment_of(session.samples[n]);
    if (const TransducerSample* sample = newest(session.transducer, transducer, moment.time_s)) {
      moment.X_PT = sample->X_PT;
      moment.contact_n = sample->contact_n;
    }
    if (const tasks::XrayUse* use = newest(session.xray, xray, moment.time_s)) moment.xray = *use;
    for (; gap < session.interruptions.size() && session.interruptions[gap].to_s <= moment.time_s; ++gap)
      moment.is_paused = n > 0;
    for (; damage < session.damage.size() && session.damage[damage].sample <= n; ++damage)
      moment.is_paused = moment.is_paused || (n > 0 && session.damage[damage].ticks > 0);
    visit(moment);
  }
}

std::optional<double> end_s_of(const Session& session, const tasks::Task* task, bool is_biopsy) {
  const auto end = scoring::end_of_attempt({session.samples, session.shots, session.actions, is_biopsy,
                                            task != nullptr ? task->confirmed_by : tasks::Substance::kNothing});
  return end ? std::optional(session.samples[*end].time_s) : std::nullopt;
}

metrics::MetricContext context_of(const Session& session) {
  metrics::MetricContext context;
  context.layer_names = session.info.layer_names;
  context.plane = session.info.plane;
  for (const std::size_t shot : session.shots)
    if (shot < session.samples.size()) context.shots_s.push_back(session.samples[shot].time_s);
  const anatomy::NeedlePath& plan = session.info.plan_P;
  if (plan.line_P.a.allFinite() && plan.line_P.b.allFinite() && plan.line_P.length_mm() > 0.0)
    context.expert_paths.push_back({plan.name.empty() ? "plan" : plan.name, plan.line_P});
  return context;
}

}  // namespace trocar::storage
