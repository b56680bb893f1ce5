#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "attempt/live/attempt_view.h"
#include "attempt/record/attempt_record.h"
#include "cases/prepare_case.h"
#include "metrics/harm_watch.h"
#include "scoring/pain.h"
#include "scoring/phase_tracker.h"
#include "tasks/action.h"

namespace trocar::attempt {

/// What a trainee is told during an attempt: forces, events, pain, harm, the task's steps, a hint. It watches the
/// record and changes nothing of the attempt.
class AttemptWatch {
 public:
  /// Case and record must outlive it. `plane`: of the transducer; empty: there is none, and no steps are tracked.
  AttemptWatch(const cases::Case& the_case, const AttemptRecord& record,
               const std::optional<metrics::ImagePlane>& plane);

  /// Call for each recorded tick, in order.
  void take(const telemetry::TickSample& sample);
  /// Call after ticks and after actions: tells of the record's new shots and actions.
  void take_actions();
  /// Call before the use is recorded.
  void take(const tasks::XrayUse& use);
  /// Adds a remark to the last event.
  void remark(const std::string& text) { events_.back().text += text; }
  /// Opens a phase of the task again.
  void repeat_phase(std::size_t phase);
  /// Call once a poll. `transducer`: its newest tick; null: none has come.
  void step(const telemetry::TickSample& needle, const telemetry::TickSample* transducer,
            const motion::PatientMotion& motion);

  /// `level` "exam": neither steps nor harm are shown. The view's needle, transducer and banner are set.
  void add_to(AttemptView& view, const telemetry::TickSample& needle, double active_s, const std::string& level) const;
  /// One sentence or empty; the rest of the view is set. About the transducer in a step that it does, as long as the
  /// needle is outside.
  std::string hint(const AttemptView& view, const telemetry::TickSample& needle) const;

  /// `is_last`: with the forces of an unfinished interval.
  std::vector<ForcePoint> take_forces(bool is_last = false);
  std::vector<AttemptEvent> take_events() { return std::exchange(events_, {}); }

 private:
  void take_harm(const telemetry::TickSample& sample);
  void take_shots();
  void take_breath(const telemetry::TickSample& sample);
  void tell_injection(const telemetry::TickSample& needle);
  void add_phases(AttemptView& view) const;
  void add_harm(AttemptView& view, double now_s) const;

  const cases::Case* case_;
  const AttemptRecord* record_;
  std::optional<metrics::ImagePlane> plane_;
  scoring::PainWatch pain_;
  metrics::HarmWatch harm_;
  std::optional<scoring::PhaseTracker> phases_;
  double phases_s_ = 0.0;  ///< Time of its last step.
  ForceTrace trace_;
  std::vector<AttemptEvent> events_;
  std::optional<double> contact_s_;
  std::shared_ptr<const GunShot> shot_;            ///< The last one.
  std::size_t told_shots_ = 0, told_actions_ = 0;  ///< Numbers of the record's that are among the events.
  std::size_t cores_ = 0;                          ///< Taken so far.
  std::optional<metrics::HarmEvent> told_harm_;    ///< The last critical or major one.
  double told_harm_s_ = 0.0;                       ///< Time at which it was told.
  bool is_breath_asked_for_ = false;               ///< And neither released nor ended by the patient.
  bool is_breath_held_ = false;                    ///< At the last sample.
  double contrast_ml_ = 0.0;
  std::optional<tasks::ContrastInjection> injection_;  ///< Not told yet.
};

}  // namespace trocar::attempt
