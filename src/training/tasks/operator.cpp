#include "tasks/operator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/result.h"
#include "telemetry/tick_sample.h"
#include "volume/sampling.h"

namespace trocar::tasks {

HandSpring hand_spring(const HandParams& hand, const HandCommand& command) noexcept {
  return {command.X_PN.p(), command.v_P, command.grip * hand.stiffness_n_per_mm,
          std::sqrt(command.grip) * hand.damping_ns_per_mm, hand.mass_kg};
}

Mat3 follow_rotation(const HandParams& hand, const Mat3& R_PN, const Mat3& R_PN_wanted, double dt_s) noexcept {
  const double fraction = 1.0 - std::exp(-dt_s / hand.turning_time_constant_s);
  const Eigen::Quaterniond now(R_PN);
  return now.slerp(fraction, Eigen::Quaterniond(R_PN_wanted)).normalized().toRotationMatrix();
}

namespace {

/// Largest number that a phase of the task asks for; 0: none does.
double asked_number(const Task& task, ConditionKind kind) {
  double most = 0.0;
  for (const Phase& phase : task.phases)
    for (const Condition& condition : phase.done)
      if (condition.kind == kind) most = std::max(most, condition.number);
  return most;
}

}  // namespace

OperatorActions actions_for(const Task& task, const Needle& needle) {
  OperatorActions actions;
  actions.gives_anaesthetic = task.pain.needs_anaesthesia;
  if (task.confirmed_by != Substance::kNothing)
    actions.confirms = needle.stylet_diameter_mm > 0.0 ? ActionKind::kDrawStylet : ActionKind::kAspirate;
  actions.awaited = task.confirmed_by;
  actions.wire_mm = asked_number(task, ConditionKind::kWire);
  actions.cores = task.cores;
  actions.loads_inside = needle.is_coaxial;
  return actions;
}

double landmark_cover_mm(const Task& task, const anatomy::VirtualPatient& patient, const Segment& path_P) {
  if (task.guidance != ImagingModality::kPalpation && !task.landmark_zone) return 0.0;
  std::array<bool, 256> is_fat{}, is_body{};
  for (const anatomy::Label& label : patient.label_table.labels) {
    is_fat[label.id] = label.tissue == "adipose";
    is_body[label.id] = label.tissue != "skin";
  }
  constexpr double kStep_mm = 0.5;
  double cover_mm = 0.0;
  for (double at_mm = 0.0; at_mm < path_P.length_mm(); at_mm += kStep_mm) {
    const Vec3 p_P = path_P.a + at_mm * path_P.direction();
    const std::uint8_t id = volume::sample_nearest(patient.labels, p_P, std::uint8_t{0});
    if (is_fat[id]) cover_mm += kStep_mm;
    if (is_body[id] && !is_fat[id]) break;  // a muscle: what lies below it is not felt
  }
  return cover_mm;
}

namespace {

constexpr double kStart_mm = -10.0;

class ConstantVelocity final : public Operator {
 public:
  ConstantVelocity(const OperatorCase& the_case, double speed_mm_per_s) noexcept
      : path_P_(the_case.path_P),
        R_PN_(needle_pose(path_P_.a, path_P_.direction()).R()),
        speed_mm_s_(speed_mm_per_s),
        one_way_s_((path_P_.length_mm() - kStart_mm) / speed_mm_per_s),
        fires_biopsy_(the_case.fires_biopsy) {}

  HandCommand next(const OperatorView& view) noexcept override {
    if (start_s_ > view.time_s) start_s_ = view.time_s;
    const double time_s = view.time_s - start_s_;
    const bool is_going_out = time_s >= one_way_s_;
    const double travelled_mm = speed_mm_s_ * std::max(0.0, std::min(time_s, 2.0 * one_way_s_ - time_s));

    HandCommand command;
    command.is_rigid = true;
    command.is_done = time_s >= 2.0 * one_way_s_;
    if (fires_biopsy_ && is_going_out && !has_turned_) command.action = ActionRequest{ActionKind::kFire};
    has_turned_ = is_going_out;
    const Vec3 axis_P = path_P_.direction();
    command.X_PN = Pose(R_PN_, path_P_.a + (kStart_mm + travelled_mm) * axis_P);
    if (!command.is_done) command.v_P = (is_going_out ? -speed_mm_s_ : speed_mm_s_) * axis_P;
    return command;
  }

 private:
  Segment path_P_;
  Mat3 R_PN_;
  double speed_mm_s_;
  double one_way_s_;
  bool fires_biopsy_;
  bool has_turned_ = false;
  double start_s_ = HUGE_VAL;
};

}  // namespace

std::unique_ptr<Operator> make_constant_velocity(const OperatorCase& the_case, double speed_mm_per_s) {
  TROCAR_CHECK(speed_mm_per_s >= 0.1 && speed_mm_per_s <= 500.0);
  return std::make_unique<ConstantVelocity>(the_case, speed_mm_per_s);
}

namespace {

class Replay final : public Operator {
 public:
  Replay(std::vector<telemetry::TickSample> samples, std::vector<Action> actions) noexcept
      : samples_(std::move(samples)), actions_(std::move(actions)) {}

  HandCommand next(const OperatorView& view) noexcept override {
    HandCommand command;
    command.is_rigid = true;
    if (samples_.empty()) {
      command.X_PN = view.X_PN_device;
      command.is_done = true;
      return command;
    }
    command.is_done = next_ >= samples_.size();
    const std::size_t now = std::min(next_, samples_.size() - 1);
    command.action = next_action(samples_[now].time_s);
    command.X_PN = telemetry::device_pose(samples_[now]);
    if (!command.is_done && now > 0) {
      const double dt_s = samples_[now].time_s - samples_[now - 1].time_s;
      if (dt_s > 0.0) command.v_P = (samples_[now].device_mm - samples_[now - 1].device_mm) / dt_s;
    }
    if (!command.is_done) ++next_;
    return command;
  }

 private:
  /// The next action that is due; two of one tick follow each other.
  std::optional<ActionRequest> next_action(double time_s) noexcept {
    constexpr double kLater_s = 1e-5;  // actions of one tick are recorded a little after each other
    if (next_action_ >= actions_.size() || actions_[next_action_].time_s > time_s + kLater_s) return std::nullopt;
    const Action& action = actions_[next_action_++];
    return ActionRequest{action.kind, action.amount};
  }

  std::vector<telemetry::TickSample> samples_;
  std::vector<Action> actions_;
  std::size_t next_ = 0, next_action_ = 0;
};

}  // namespace

std::unique_ptr<Operator> make_replay(std::vector<telemetry::TickSample> samples, std::vector<Action> actions) {
  return std::make_unique<Replay>(std::move(samples), std::move(actions));
}

}  // namespace trocar::tasks
