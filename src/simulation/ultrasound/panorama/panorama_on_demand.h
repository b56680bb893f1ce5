#pragma once

#include <functional>
#include <memory>

#include "core/background_job.h"
#include "core/result.h"
#include "ultrasound/panorama/panorama.h"

namespace trocar::ultrasound {

/// Panorama of a patient, loaded in the background at its first use: it is as large as the CT, and only its engine
/// needs it. One thread makes all calls, e.g. that of the window.
class PanoramaOnDemand {
 public:
  using Load = std::function<Result<std::shared_ptr<const Panorama>>()>;

  explicit PanoramaOnDemand(Load load) : load_(std::move(load)) {}

  /// False if loading has failed.
  bool is_possible() const noexcept { return is_possible_; }
  /// Starts loading at the first call. Returns null until it is done, and if it has failed (the log has the reason).
  std::shared_ptr<const Panorama> poll();
  bool is_loading() const noexcept { return job_.has_work(); }

 private:
  Load load_;
  BackgroundJob<std::shared_ptr<const Panorama>> job_;
  std::shared_ptr<const Panorama> panorama_;
  bool is_possible_ = true;
};

}  // namespace trocar::ultrasound
