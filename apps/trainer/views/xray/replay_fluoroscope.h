#pragma once

#include <memory>
#include <optional>

#include "anatomy/patient.h"
#include "attempt/record/xray_replay.h"
#include "xray/contrast/vessel_streak.h"
#include "xray/fluoroscopy/live_fluoroscope.h"

namespace trocar::trainer {

/// Request for the X-ray image of a moment of a recorded attempt.
struct ReplayXrayRequest {
  double image_s = 0.0;  ///< Session time of the exposure.
  /// Needle, C-arm and settings at that time; contrast agent, times and pedal are set by ReplayFluoroscope.
  xray::FluoroscopyRequest scene;
  bool is_injecting = false;  ///< The bore of the needle, scene.tools[0], contains contrast agent.
};

/// Data of a replay.
struct ReplayXraySource {
  std::shared_ptr<const anatomy::VirtualPatient> patient;
  std::shared_ptr<const xray::XrayVolume> volume;
  xray::BloodVelocity blood;
  std::shared_ptr<const attempt::InjectionSteps> injections;
};

/// X-ray images of a recorded attempt, on a thread: each is a fresh exposure of its moment, with the contrast agent
/// computed again up to that time. Older requests are dropped; a moment that stays is computed once. One thread makes
/// all calls; only the destructor waits, for an image (for the first one with contrast agent the ducts are followed,
/// which takes seconds).
class ReplayFluoroscope {
 public:
  ReplayFluoroscope(ReplayXraySource source, const xray::LiveFluoroscopeOptions& options);
  ~ReplayFluoroscope();
  ReplayFluoroscope(const ReplayFluoroscope&) = delete;
  ReplayFluoroscope& operator=(const ReplayFluoroscope&) = delete;

  void request(ReplayXrayRequest request);
  /// Newest image; its time_s is the image_s of its request, its dose is of no examination. nullptr before the first.
  const Feed<xray::FluoroscopyFrame>& frames() const noexcept;
  /// The error of the last request, if it failed.
  std::optional<Error> error() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::trainer
