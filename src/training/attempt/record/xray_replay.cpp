#include "attempt/record/xray_replay.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/log.h"

namespace trocar::attempt {
namespace {

/// The first use after a time.
std::span<const tasks::XrayUse>::iterator find_next(std::span<const tasks::XrayUse> uses, double time_s) {
  return std::ranges::upper_bound(uses, time_s, {}, &tasks::XrayUse::time_s);
}

/// From when on the volume that a use adds was injected. `n` > 0.
double injected_from_s(std::span<const tasks::XrayUse> uses, std::size_t n) {
  return std::max(uses[n - 1].time_s, uses[n].time_s - kNoteGap_s);
}

bool is_injecting(std::span<const tasks::XrayUse> uses, double time_s) {
  const auto n = static_cast<std::size_t>(find_next(uses, time_s) - uses.begin());
  if (n == 0 || n == uses.size()) return false;
  return uses[n].contrast_ml > uses[n - 1].contrast_ml && time_s >= injected_from_s(uses, n);
}

/// Volume up to a time.
double injected_ml(std::span<const tasks::XrayUse> uses, double time_s) {
  const auto n = static_cast<std::size_t>(find_next(uses, time_s) - uses.begin());
  if (n == 0) return 0.0;
  const double before_ml = uses[n - 1].contrast_ml;
  if (n == uses.size()) return before_ml;
  const double from_s = injected_from_s(uses, n);
  const double share = std::max(0.0, time_s - from_s) / (uses[n].time_s - from_s);
  return before_ml + share * std::max(0.0, uses[n].contrast_ml - before_ml);
}

/// A pulse shorter than the time between two uses is only seen in the dose.
bool has_exposure(std::span<const tasks::XrayUse> uses, std::size_t n) {
  return uses[n].is_beam_on || uses[n].beam_s > (n > 0 ? uses[n - 1].beam_s : 0.0);
}

}  // namespace

std::optional<XrayMoment> xray_moment(std::span<const tasks::XrayUse> uses, double time_s) {
  auto n = static_cast<std::size_t>(find_next(uses, time_s) - uses.begin());
  if (n == 0) return std::nullopt;
  XrayMoment moment;
  moment.use = uses[n - 1];
  while (n > 0 && !has_exposure(uses, n - 1)) --n;
  if (n == 0) return moment;
  moment.image = uses[n - 1];
  moment.image_s = moment.use.is_beam_on ? time_s : moment.image.time_s;
  moment.is_injecting_then = is_injecting(uses, *moment.image_s);
  return moment;
}

InjectionSteps injection_steps(std::span<const tasks::XrayUse> uses, const std::function<Vec3(double)>& tip_P_at) {
  constexpr double kStep_s = InjectionSteps::kStep_s, kLeast_ml = 1e-9;
  InjectionSteps made;
  const auto first = std::ranges::find_if(uses, [](const tasks::XrayUse& use) { return use.contrast_ml > 0.0; });
  if (first == uses.end()) return made;
  const double start_s =
      first == uses.begin() ? first->time_s : injected_from_s(uses, static_cast<std::size_t>(first - uses.begin()));
  made.start_s = std::floor(start_s / kStep_s) * kStep_s;
  const double all_ml = uses.back().contrast_ml;
  double given_ml = 0.0;
  for (std::size_t n = 0; given_ml < all_ml - kLeast_ml; ++n) {
    const double end_s = made.start_s + static_cast<double>(n + 1) * kStep_s;
    const double due_ml = std::clamp(injected_ml(uses, end_s) - given_ml, 0.0, kMostRate_ml_per_s * kStep_s);
    made.steps.push_back({tip_P_at(end_s - 0.5 * kStep_s), due_ml / kStep_s});
    given_ml += due_ml;
    if (end_s > uses.back().time_s && due_ml <= 0.0) break;  // the volume of a damaged session fell
  }
  return made;
}

namespace {

constexpr std::size_t kKeepEvery = 30;  ///< Steps: 1 s.
constexpr std::size_t kMostKept = 40;   ///< More than these: every second one is dropped.

}  // namespace

ContrastReplay::ContrastReplay(xray::ContrastFlow at_rest, std::shared_ptr<const InjectionSteps> injections,
                               double iodine_mg_per_ml)
    : injections_(std::move(injections)),
      iodine_mg_per_ml_(iodine_mg_per_ml),
      flow_(std::move(at_rest)),
      keep_every_(kKeepEvery) {
  kept_.emplace(0, flow_);
}

std::shared_ptr<const xray::Iodine> ContrastReplay::at(double time_s, const std::stop_token& stop) {
  const double since_s = time_s - injections_->start_s;
  constexpr double kRounding = 1e-6;
  if (injections_->steps.empty() || !(since_s >= 0.0)) return nullptr;
  const auto wanted = static_cast<std::size_t>(since_s / InjectionSteps::kStep_s + kRounding);
  go_back_to(wanted);
  while (step_ < wanted && !stop.stop_requested()) advance();
  if (!iodine_) iodine_ = std::make_shared<const xray::Iodine>(flow_.iodine());
  return iodine_;
}

/// Also skips forward to a later copy.
void ContrastReplay::go_back_to(std::size_t step) {
  const auto from = std::prev(kept_.upper_bound(step));
  if (step_ <= step && from->first <= step_) return;
  flow_ = from->second;
  step_ = from->first;
  iodine_.reset();
}

void ContrastReplay::advance() {
  flow_.stop_injection();
  if (step_ < injections_->steps.size() && injections_->steps[step_].ml_per_s > 0.0) {
    const InjectionStep& now = injections_->steps[step_];
    if (const Status status = flow_.inject(now.tip_P, now.ml_per_s, iodine_mg_per_ml_); !status)
      log_warning("{}", status.error().text());
  }
  flow_.step(InjectionSteps::kStep_s);
  ++step_;
  iodine_.reset();
  if (step_ % keep_every_ == 0) keep();
}

void ContrastReplay::keep() {
  kept_.emplace(step_, flow_);
  if (kept_.size() <= kMostKept) return;
  keep_every_ *= 2;
  std::erase_if(kept_, [this](const auto& entry) { return entry.first % keep_every_ != 0; });
}

}  // namespace trocar::attempt
