#pragma once

#include <memory>

#include "anatomy/patient.h"
#include "core/live/feed.h"
#include "core/result.h"
#include "xray/contrast/contrast_table.h"
#include "xray/contrast/duct_fill.h"
#include "xray/contrast/tissue_cloud.h"
#include "xray/contrast/vessel_streak.h"

namespace trocar::xray {

/// Contrast agent since the beginning. Of iodine: in_body + drained + washed_away + spilled = injected
/// (docs/physics.md, X17).
struct ContrastTotals {
  double injected_ml = 0.0;
  double injected_mg = 0.0;
  double ducts_mg = 0.0, vessels_mg = 0.0, tissue_mg = 0.0;  ///< tissue: also fluid, bowel, parenchyma.
  double drained_mg = 0.0;                                   ///< Through the papilla.
  double washed_away_mg = 0.0;  ///< By blood: out of vessels, parenchyma, and over-filled ducts.
  double spilled_mg = 0.0;      ///< Injected outside of the body.
  double ducts_ml = 0.0;        ///< Contrast agent in the ducts.

  double in_body_mg() const { return ducts_mg + vessels_mg + tissue_mg; }
};

/// Contrast agent in a patient: injected at the needle's tip into a duct, a vessel, a fluid or tissue, which carries it
/// on (docs/physics.md, X13 to X17). Frame P of the patient at rest: a tip in a moving patient is mapped back first.
/// Not real-time safe; one thread.
class ContrastFlow {
 public:
  /// Follows the bile ducts (takes up to some seconds). `blood` gives the flow in vessels, for example
  /// ultrasound::VesselFlow::velocity_P; without it contrast agent in a vessel fades where it is. Errors: a patient
  /// without labels.
  static Result<ContrastFlow> make(std::shared_ptr<const anatomy::VirtualPatient> patient, const ContrastTable& table,
                                   BloodVelocity blood = {});

  /// Injects at a point from now on. Errors (exit status 2), and the injection stops: a tip that is not finite, a rate
  /// outside of 0..50 ml/s, a concentration outside of 0..500 mg/ml.
  Status inject(const Vec3& tip_P, double ml_per_s, double iodine_mg_per_ml);
  void stop_injection() { ml_per_s_ = 0.0; }
  /// Advances by `dt_s`, 0..1 s (checked), in equal steps of at most 10 ms.
  void step(double dt_s);

  Iodine iodine() const;
  /// Outside for a point that is not finite.
  ContrastPlace place(const Vec3& tip_P) const;
  ContrastTotals totals() const;
  const DuctFill& ducts() const { return ducts_; }
  const TissueCloud& tissue() const { return tissue_; }  ///< Parenchyma and other tissue.
  const TissueCloud& fluid() const { return fluid_; }    ///< Fluid and bowel.

 private:
  ContrastFlow(std::shared_ptr<const anatomy::VirtualPatient> patient, const ContrastTable& table, BloodVelocity blood);

  /// The place of an injection.
  struct Target {
    ContrastPlace place = ContrastPlace::kOutside;
    int cell = -1;  ///< Of the ducts.
  };
  Target find_target(const Vec3& tip_P) const;
  void inject_for(double dt_s);

  std::shared_ptr<const anatomy::VirtualPatient> patient_;
  DuctFill ducts_;
  VesselStreak vessels_;
  TissueCloud tissue_, fluid_;
  Vec3 tip_P_ = Vec3::Zero();
  Target target_;
  double ml_per_s_ = 0.0;
  double iodine_mg_per_ml_ = 0.0;
  double injected_ml_ = 0.0, injected_mg_ = 0.0, spilled_mg_ = 0.0;
};

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
  /// For any thread; none before the ducts were followed, and for a patient for whom it failed (the log has the
  /// reason).
  const Feed<ContrastState>& states() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::xray
