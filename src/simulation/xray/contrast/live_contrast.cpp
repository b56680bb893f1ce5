#include "xray/contrast/live_contrast.h"

#include <chrono>
#include <mutex>
#include <thread>
#include <utility>

#include "core/files/data_dir.h"
#include "core/live/live_thread.h"
#include "core/log.h"
#include "core/start_thread.h"

namespace trocar::xray {
namespace {

constexpr std::chrono::milliseconds kPeriod{33};
constexpr double kLongestCatchUp_s = 0.5;  // after a stall the agent does not catch up
constexpr int kNice = 5;

}  // namespace

struct LiveContrast::Impl {
  void run(const std::stop_token& stop, std::shared_ptr<const anatomy::VirtualPatient> patient, BloodVelocity blood);
  void advance(ContrastFlow& flow, double iodine_mg_per_ml, double dt_s);

  mutable std::mutex mutex;
  InjectionRequest wanted;
  std::shared_ptr<const ContrastState> newest;
  std::jthread thread;
};

void LiveContrast::Impl::run(const std::stop_token& stop, std::shared_ptr<const anatomy::VirtualPatient> patient,
                             BloodVelocity blood) {
  lower_priority(kNice);
  const auto table = load_contrast_table(data_dir() / "contrast.toml");
  if (!table) return log_warning("{}", table.error().text());
  auto flow = ContrastFlow::make(std::move(patient), *table, std::move(blood));
  if (!flow) return log_warning("no contrast agent: {}", flow.error().text());
  auto last = std::chrono::steady_clock::now();
  while (!stop.stop_requested()) {
    const auto now = std::chrono::steady_clock::now();
    advance(*flow, table->iodine_mg_per_ml,
            std::min(kLongestCatchUp_s, std::chrono::duration<double>(now - std::exchange(last, now)).count()));
    std::this_thread::sleep_until(now + kPeriod);
  }
}

void LiveContrast::Impl::advance(ContrastFlow& flow, double iodine_mg_per_ml, double dt_s) {
  InjectionRequest request;
  std::shared_ptr<const ContrastState> before;
  {
    const std::lock_guard lock(mutex);
    request = wanted;
    before = newest;
  }
  if (request.ml_per_s <= 0.0 || !request.tip_P.allFinite()) {
    flow.stop_injection();
  } else if (const Status status = flow.inject(request.tip_P, request.ml_per_s, iodine_mg_per_ml); !status) {
    log_warning("{}", status.error().text());
  }
  flow.step(dt_s);
  auto state = std::make_shared<ContrastState>();
  state->place = flow.place(request.tip_P);
  state->injected_ml = flow.totals().injected_ml;
  state->iodine_mg_per_ml = iodine_mg_per_ml;
  // Without agent in the body the pointer stays the same: nothing changes in the image.
  state->iodine =
      flow.totals().in_body_mg() > 0.0 || !before ? std::make_shared<const Iodine>(flow.iodine()) : before->iodine;
  const std::lock_guard lock(mutex);
  newest = std::move(state);
}

LiveContrast::LiveContrast() : impl_(std::make_unique<Impl>()) {}
LiveContrast::~LiveContrast() = default;

void LiveContrast::open(std::shared_ptr<const anatomy::VirtualPatient> patient, BloodVelocity blood) {
  close();
  auto thread = start_stoppable_thread(
      "contrast agent", [impl = impl_.get(), patient = std::move(patient),
                         blood = std::move(blood)](const std::stop_token& stop) { impl->run(stop, patient, blood); });
  if (!thread) return log_warning("no contrast agent: {}", thread.error().text());
  impl_->thread = *std::move(thread);
}

void LiveContrast::close() {
  impl_->thread = {};  // stops and joins
  impl_->newest.reset();
  impl_->wanted = {};
}

void LiveContrast::request(const InjectionRequest& request) {
  const std::lock_guard lock(impl_->mutex);
  impl_->wanted = request;
}

std::shared_ptr<const ContrastState> LiveContrast::newest() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->newest;
}

}  // namespace trocar::xray
