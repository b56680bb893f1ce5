// What scripts, tests and benchmarks read from a running attempt.
#include <algorithm>

#include "attempt/guide/needle_view.h"
#include "control/attempt_control.h"
#include "pages/work_page.h"
#include "panels/puncture_panel.h"
#include "ui_kit/parts.h"

namespace trocar::trainer {

void AttemptControl::add_step_facts(QVariantMap& facts) const {
  const auto done = std::count_if(view_.phases.begin(), view_.phases.end(), [](const auto& p) { return p.done_s; });
  facts[QStringLiteral("steps")] = static_cast<int>(view_.phases.size());
  facts[QStringLiteral("steps_done")] = static_cast<int>(done);
  const bool has_step = view_.current_phase && *view_.current_phase < view_.phases.size();
  facts[QStringLiteral("step")] = has_step ? to_qt(view_.phases[*view_.current_phase].title) : QString();
  facts[QStringLiteral("step_lacks")] = has_step ? to_qt(view_.phases[*view_.current_phase].lacks) : QString();
  facts[QStringLiteral("is_stylet_drawn")] = view_.is_stylet_drawn;
  facts[QStringLiteral("is_breath_held")] = view_.is_breath_held;
  facts[QStringLiteral("patient_holds")] = view_.motion.state().is_breath_held;
  facts[QStringLiteral("wire_mm")] = wire_mm();
}

/// Poses of the tools relative to tissue and plan: in an exam, scripts get no more than the window shows.
QVariantMap AttemptControl::solution_facts() const {
  QVariantMap facts;
  facts[QStringLiteral("depth_mm")] = view_.needle.depth_mm;
  facts[QStringLiteral("distance_mm")] = distance_mm();
  facts[QStringLiteral("entry_from_plan_mm")] =
      (needle_.entry_P() - view_.motion.to_now(open_->the_case.plan.line_P.a)).norm();
  facts[QStringLiteral("probe_from_plan_mm")] = (view_.probe.X_PT.p() - open_->X_PT_start.p()).norm();
  facts[QStringLiteral("tissue")] = to_qt(view_.needle.tissue);
  facts[QStringLiteral("core_target_mm")] = view_.shot ? view_.shot->core.target_mm : 0.0;
  return facts;
}

QVariantMap AttemptControl::facts() const {
  QVariantMap facts;
  if (!is_exam()) facts = solution_facts();
  add_step_facts(facts);
  hand_.add_facts(facts);
  facts[QStringLiteral("phase")] = QString::fromLatin1(to_string(view_.phase));
  facts[QStringLiteral("level")] = QString::fromLatin1(name_of(choice_.mode));
  facts[QStringLiteral("force_n")] = view_.needle.resistance_n;
  facts[QStringLiteral("lag_mm")] = view_.needle.lag_mm;
  facts[QStringLiteral("hint")] = hint();
  facts[QStringLiteral("has_fired")] = view_.shots > 0;
  facts[QStringLiteral("cores")] = static_cast<int>(view_.shots);
  facts[QStringLiteral("probe_pressed_mm")] = view_.probe.pressed_mm;
  facts[QStringLiteral("probe_force_n")] = view_.probe.contact_n;
  facts[QStringLiteral("probe_up_mm")] = -view_.probe.X_PT.p().y();
  facts[QStringLiteral("is_asking")] = page_.puncture().is_asking();
  facts[QStringLiteral("restarts")] = view_.servers[0].restarts;
  facts[QStringLiteral("xray_beam_s")] = xray_.beam_s;
  facts[QStringLiteral("xray_dose_gycm2")] = xray_.dose_area_gycm2;
  facts[QStringLiteral("contrast_ml")] = xray_.contrast_ml;
  facts[QStringLiteral("session")] = to_qt(attempt_.session_path().string());
  return facts;
}

}  // namespace trocar::trainer
