#include "attempt/record/contrast_replay.h"

#include <cmath>
#include <utility>

#include "core/log.h"

namespace trocar::attempt {
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
