#include "ultrasound/panorama/panorama_on_demand.h"

#include <utility>

#include "core/live/live_thread.h"
#include "core/log.h"
#include "core/parallel.h"

namespace trocar::ultrasound {
namespace {

constexpr int kPanoramaNiceness = 5;  // as the live scanner's thread

/// On one thread of low priority: haptic servers and the window run at the same time.
Result<std::shared_ptr<const Panorama>> load_beside_attempt(const PanoramaOnDemand::Load& load) {
  lower_priority(kPanoramaNiceness);
  Result<std::shared_ptr<const Panorama>> panorama = nullptr;
  run_on_threads(1, [&] { panorama = load(); });
  return panorama;
}

}  // namespace

std::shared_ptr<const Panorama> PanoramaOnDemand::poll() {
  if (!is_possible_ || panorama_) return panorama_;
  if (!job_.has_work()) {
    job_ = BackgroundJob<std::shared_ptr<const Panorama>>(
        [load = load_](const Progress&, const std::stop_token&) { return load_beside_attempt(load); });
  }
  auto made = job_.take();
  if (!made) return nullptr;
  job_ = {};
  if (*made) {
    panorama_ = **std::move(made);
  } else {
    log_warning("no panorama: {}", made->error().text());
    is_possible_ = false;
  }
  return panorama_;
}

}  // namespace trocar::ultrasound
