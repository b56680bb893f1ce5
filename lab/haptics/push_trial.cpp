#include "lab/haptics/push_trial.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trocar::haptics {

std::vector<PushSample> run_push_trial(std::shared_ptr<const HapticScene> scene, const stylus::DevicePreset& preset,
                                       const PushTrial& trial) {
  const auto loop = std::make_unique<ClosedLoop>(scene, preset, Holder::kHand);
  loop->carry({0.0, 0.0, trial.from_mm}, Vec3::UnitZ());
  stylus::StylusHold hold = stylus::make_guiding_hand(scene->needle.length_mm);
  const double push_s = (trial.to_mm - trial.from_mm) / trial.speed_mm_per_s;
  const auto ticks = static_cast<int>((push_s + trial.hold_s) / loop->dt_s());
  const double length_mm = scene->needle.length_mm;
  std::vector<PushSample> samples;
  samples.reserve(static_cast<std::size_t>(ticks));
  for (int i = 1; i <= ticks; ++i) {
    const double t = i * loop->dt_s();
    const bool is_pushing = t < push_s;
    const double hand_mm = is_pushing ? trial.from_mm + trial.speed_mm_per_s * t : trial.to_mm;
    hold.X_PS = Pose::translation({0.0, 0.0, hand_mm - length_mm});
    hold.velocity_P = Vec3(0.0, 0.0, is_pushing ? trial.speed_mm_per_s : 0.0);
    const telemetry::TickSample& tick =
        trial.is_rigid ? loop->carry({0.0, 0.0, hand_mm}, Vec3::UnitZ()) : loop->run(hold);
    PushSample sample{t,     hand_mm, loop->tip_P().z(), -(loop->wrench_P().force_n - tick.f_weight_n).z(),
                      false, kNoLayer};
    for (const telemetry::TickEvent& event : tick.events) {
      if (event.kind != telemetry::EventKind::kPuncture) continue;
      sample.is_puncture = true;
      sample.layer = event.id;
    }
    samples.push_back(sample);
  }
  return samples;
}

BoneContact judge_bone_contact(const std::vector<PushSample>& samples, const PushTrial& trial, double surface_mm,
                               double peak_force_n) noexcept {
  BoneContact contact;
  if (samples.empty()) return contact;
  const double end_s = samples.back().time_s;
  double sum = 0.0;
  int count = 0;
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const PushSample& s : samples) {
    if (s.time_s > end_s - 0.2 * trial.hold_s) {
      sum += s.resistance_n;
      ++count;
    }
    if (s.time_s <= end_s - 0.5 * trial.hold_s) continue;
    low = std::min(low, s.resistance_n);
    high = std::max(high, s.resistance_n);
  }
  contact.steady_n = sum / std::max(count, 1);
  contact.chatter_n = high - low;

  // The force just before the bone is friction; the slope is that of the rise above it.
  const auto touch =
      std::find_if(samples.begin(), samples.end(), [&](const PushSample& s) { return s.device_mm >= surface_mm; });
  if (touch == samples.end()) return contact;
  for (auto it = touch; it != samples.end(); ++it) contact.peak_n = std::max(contact.peak_n, it->resistance_n);
  contact.overshoot = contact.steady_n > 0.0 ? contact.peak_n / contact.steady_n - 1.0 : 0.0;
  contact.is_limited = contact.peak_n > 0.999 * peak_force_n;
  const double before_n = touch->resistance_n;
  const auto reaches = [&](double share) {
    const double wanted = before_n + share * (contact.steady_n - before_n);
    return std::find_if(touch, samples.end(), [&](const PushSample& s) { return s.resistance_n >= wanted; });
  };
  const auto to = reaches(0.8);
  double n = 0.0;
  double x = 0.0;
  double f = 0.0;
  double xx = 0.0;
  double xf = 0.0;
  for (auto it = reaches(0.1); it < to; ++it) {  // linear regression: encoder counts cause ripple
    n += 1.0;
    x += it->device_mm;
    f += it->resistance_n;
    xx += it->device_mm * it->device_mm;
    xf += it->device_mm * it->resistance_n;
  }
  const double spread = n * xx - x * x;
  if (spread > 0.0) contact.slope_n_per_mm = (n * xf - x * f) / spread;
  return contact;
}

LossOfResistance judge_loss_of_resistance(const std::vector<PushSample>& samples, std::uint8_t layer) noexcept {
  constexpr double kBefore_s = 0.05;
  constexpr double kAfter_s = 0.3;
  constexpr double kSettled_s = 0.2;
  LossOfResistance loss;
  const auto puncture = std::find_if(samples.begin(), samples.end(),
                                     [&](const PushSample& s) { return s.is_puncture && s.layer == layer; });
  if (puncture == samples.end()) return loss;
  loss.has_given_way = true;
  auto peak = puncture;
  for (auto it = puncture; it->time_s > puncture->time_s - kBefore_s; --it) {
    if (it->resistance_n > peak->resistance_n) peak = it;
    if (it == samples.begin()) break;
  }
  loss.peak_n = loss.lowest_n = peak->resistance_n;
  auto last = puncture;
  double sum = 0.0;
  int count = 0;
  for (auto it = puncture; it != samples.end() && it->time_s < puncture->time_s + kAfter_s; ++it) {
    loss.lowest_n = std::min(loss.lowest_n, it->resistance_n);
    last = it;
    if (it->time_s < puncture->time_s + kSettled_s) continue;
    sum += it->resistance_n;
    ++count;
  }
  loss.drop_n = peak->resistance_n - sum / std::max(count, 1);
  const auto falls_to = [&](double share) {
    return std::find_if(peak, last,
                        [&](const PushSample& s) { return s.resistance_n <= loss.peak_n - share * loss.drop_n; });
  };
  loss.drop_time_s = falls_to(0.9)->time_s - falls_to(0.1)->time_s;
  for (auto it = puncture; it != last; ++it) {
    const double meant = it->hand_mm - puncture->hand_mm;
    loss.jump_mm = std::max(loss.jump_mm, it->device_mm - puncture->device_mm - meant);
  }
  return loss;
}

}  // namespace trocar::haptics
