#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "anatomy/patient.h"
#include "xray/contrast/contrast_table.h"
#include "xray/contrast/iodine.h"

namespace trocar::xray {

/// Velocity of the blood (mm/s, P) at a point of P and a time; 0 where none flows.
using BloodVelocity = std::function<Vec3(const Vec3& p_P, double time_s)>;

/// Contrast agent in flowing blood: portions that the blood carries away, that spread over the vessel's section and are
/// diluted with a time constant. A portion that reaches the vessel's end or its greatest age is washed away. Without
/// flow at the tip portions stay there and are diluted all the same. docs/physics.md, X16.
class VesselStreak {
 public:
  VesselStreak(std::shared_ptr<const anatomy::VirtualPatient> patient, const VesselParams& params, BloodVelocity blood);

  bool is_vessel(const Vec3& p_P) const;
  /// A portion of `dt_s` (> 0) at a point in a vessel.
  void inject(const Vec3& tip_P, double dt_s, double ml, double iodine_mg_per_ml);
  void step(double dt_s);

  double iodine_mg() const;
  double washed_away_mg() const { return washed_away_mg_; }
  bool is_empty() const { return portions_.empty(); }
  void add_pieces(double least_mg_per_ml, std::vector<IodinePiece>& pieces) const;

 private:
  struct Portion {
    Vec3 head_P, tail_P;
    double iodine_mg = 0.0;
    double age_s = 0.0;
    double radius_mm = 1.0;
  };

  Vec3 velocity(const Vec3& p_P) const;
  Vec3 towards_middle(const Vec3& p_P) const;
  Vec3 moved(const Vec3& p_P, double dt_s) const;
  double lumen_mm(const Vec3& p_P, const Vec3& along) const;

  std::shared_ptr<const anatomy::VirtualPatient> patient_;
  VesselParams params_;
  BloodVelocity blood_;
  std::vector<Portion> portions_;
  double time_s_ = 0.0;
  double washed_away_mg_ = 0.0;
};

}  // namespace trocar::xray
