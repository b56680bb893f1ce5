#pragma once

#include <limits>
#include <vector>

#include "tasks/operator.h"

namespace trocar::testing {

/// A body of flat layers for closed-loop tests: a device of 0.1 kg in the operator's hand, a massless needle coupled to
/// it, springs that can be punctured, friction and cutting. Much coarser than haptics/, but the same signs and the same
/// delay of one tick.
class LayeredBody {
 public:
  struct Layer {
    double depth_mm;
    double stiffness_n_per_mm;
    double puncture_n;
  };

  LayeredBody(const Segment& path_P, std::vector<Layer> layers, double dt_s)
      : path_P_(path_P), layers_(std::move(layers)), dt_s_(dt_s) {}

  /// Runs the operator until it is done or the time is over.
  void run(tasks::Operator& the_operator, double limit_s) {
    for (double time_s = 0.0; time_s < limit_s && !is_done; time_s += dt_s_) {
      const tasks::HandCommand command =
          the_operator.next({time_s, dt_s_, X_PN_, samples.empty() ? telemetry::TickSample{} : last(), returned_});
      is_done = command.is_done;
      if (command.fires()) fired.push_back(samples.size());
      step(command, time_s);
      if (command.action) act(*command.action, time_s);
    }
  }
  const telemetry::TickSample& last() const { return samples.back(); }
  double depth_mm(const telemetry::TickSample& sample) const { return along(sample.tip_mm); }

  std::vector<telemetry::TickSample> samples;
  std::vector<std::size_t> fired;
  std::vector<tasks::Action> actions;
  double csf_from_mm = 0.0, csf_to_mm = 0.0;  ///< Depths at which spinal fluid comes back.
  std::size_t punctured = 0;
  bool is_done = false;

 private:
  static constexpr double kDevice_kg = 0.1;
  static constexpr double kCoupling_n_per_mm = 1.0;
  static constexpr double kFriction_n_per_mm = 0.008;
  static constexpr double kCutting_n = 0.6;
  inline static const Vec3 kWeight_P{0.0, -1.0, 0.0};

  double along(const Vec3& p_P) const { return (p_P - path_P_.a).dot(path_P_.direction()); }

  void step(const tasks::HandCommand& command, double time_s) {
    move_device(command);
    const double device_mm = along(X_PN_.p());
    needle_mm_ = needle_position(device_mm);
    const Vec3 axis_P = path_P_.direction();
    force_P_ = -kCoupling_n_per_mm * (device_mm - needle_mm_) * axis_P;

    telemetry::TickSample sample;
    sample.time_s = time_s;
    sample.tip_mm = X_PN_.p() + (needle_mm_ - device_mm) * axis_P;
    sample.axis = X_PN_.R().col(2);
    telemetry::set_at_rest(sample);
    sample.depth_mm = std::max(0.0, punctured > 0 ? needle_mm_ : 0.0);
    sample.phase =
        needle_mm_ < 0.0 && punctured == 0 ? telemetry::InsertionPhase::kOutside : telemetry::InsertionPhase::kInserted;
    sample.device_mm = X_PN_.p();
    sample.f_weight_n = kWeight_P;  // carries the stylus; the device is weightless here
    sample.device_f_n = force_P_ + kWeight_P;
    samples.push_back(sample);
  }

  void act(const tasks::ActionRequest& request, double time_s) {
    tasks::Action action{time_s, request.kind, request.amount, {}, last().tip_mm, depth_mm(last())};
    const bool is_in_csf = action.depth_mm >= csf_from_mm && action.depth_mm < csf_to_mm;
    if (is_in_csf) action.result = {tasks::Substance::kCsf, 1.0};
    actions.push_back(action);
    returned_ = tasks::last_return(actions);
  }

  void move_device(const tasks::HandCommand& command) {
    if (samples.empty() || command.is_rigid) {
      X_PN_ = command.X_PN;
      v_P_ = command.v_P;
      if (samples.empty()) needle_mm_ = along(X_PN_.p());
      return;
    }
    const tasks::HandSpring hand = tasks::hand_spring(tasks::HandParams{}, command);
    const double kg_to_ns2_per_mm = 1e-3;
    const double mass = (hand.mass_kg + kDevice_kg) * kg_to_ns2_per_mm;
    const double k = hand.stiffness_n_per_mm;
    const double b = hand.damping_ns_per_mm;
    const Vec3 push = k * (hand.anchor_P - X_PN_.p()) + b * hand.anchor_velocity_P + force_P_;
    v_P_ = (mass * v_P_ + dt_s_ * push) / (mass + dt_s_ * b + dt_s_ * dt_s_ * k);
    X_PN_ =
        Pose(tasks::follow_rotation(tasks::HandParams{}, X_PN_.R(), command.X_PN.R(), dt_s_), X_PN_.p() + dt_s_ * v_P_);
  }

  double needle_position(double device_mm) {
    while (punctured < layers_.size()) {
      const Layer& layer = layers_[punctured];
      const double reached_mm = slide(device_mm);
      if (reached_mm < layer.depth_mm) return reached_mm;
      const double pressed_mm = std::max(
          layer.depth_mm, (kCoupling_n_per_mm * device_mm + layer.stiffness_n_per_mm * layer.depth_mm - drag_n()) /
                              (kCoupling_n_per_mm + layer.stiffness_n_per_mm));
      if (layer.stiffness_n_per_mm * (pressed_mm - layer.depth_mm) < layer.puncture_n) return pressed_mm;
      ++punctured;
    }
    return slide(device_mm);
  }

  double drag_n() const { return punctured == 0 ? 0.0 : kFriction_n_per_mm * std::max(0.0, needle_mm_); }
  double slide(double device_mm) const {
    const double forward_n = drag_n() + (punctured == layers_.size() ? kCutting_n : 0.0);
    return std::max(std::min(needle_mm_, device_mm + drag_n() / kCoupling_n_per_mm),
                    device_mm - forward_n / kCoupling_n_per_mm);
  }

  Segment path_P_;
  std::vector<Layer> layers_;
  double dt_s_;
  Pose X_PN_;
  Vec3 v_P_ = Vec3::Zero();
  Vec3 force_P_ = Vec3::Zero();
  double needle_mm_ = 0.0;
  std::optional<tasks::Return> returned_;
};

inline std::vector<LayeredBody::Layer> skin_muscle_capsule() {
  return {{0.0, 4.5, 2.8}, {14.0, 2.8, 2.5}, {30.0, 2.7, 1.5}};
}
inline std::vector<LayeredBody::Layer> bone_below_skin() {
  return {{0.0, 4.5, 2.8}, {14.0, 50.0, std::numeric_limits<double>::infinity()}};
}

}  // namespace trocar::testing
