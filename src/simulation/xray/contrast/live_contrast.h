#pragma once

#include <memory>

#include "xray/contrast/contrast_flow.h"

namespace trocar::xray {

/// An injection at the needle's tip; none at a tip that is not finite.
struct InjectionRequest {
  Vec3 tip_P = Vec3::Zero();
  double ml_per_s = 0.0;  ///< Range 0..50.
};

/// Contrast agent at one moment.
struct ContrastState {
  std::shared_ptr<const Iodine> iodine;
  ContrastPlace place = ContrastPlace::kOutside;  ///< Of the tip.
  double injected_ml = 0.0;
  double iodine_mg_per_ml = 0.0;  ///< Of the agent in the syringe (data/contrast.toml).
};

/// Contrast agent of a patient in real time, on a thread of its own that follows the ducts first. One thread, e.g. that
/// of the window, makes all calls; only open(), close() and the destructor wait for a step.
class LiveContrast {
 public:
  LiveContrast();
  ~LiveContrast();
  LiveContrast(const LiveContrast&) = delete;
  LiveContrast& operator=(const LiveContrast&) = delete;

  /// Begins anew with a patient. `blood` as in ContrastFlow::make.
  void open(std::shared_ptr<const anatomy::VirtualPatient> patient, BloodVelocity blood = {});
  void close();
  /// Holds until the next request.
  void request(const InjectionRequest& request);
  /// nullptr before the ducts were followed, and for a patient for whom it failed (the log has the reason).
  std::shared_ptr<const ContrastState> newest() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::xray
