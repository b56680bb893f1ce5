#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "anatomy/patient.h"
#include "xray/contrast/contrast_table.h"
#include "xray/contrast/detail/vessel_course.h"

namespace trocar::xray {

/// Velocity of the blood (mm/s, P) at a point of P and a time; 0 where none flows.
using BloodVelocity = std::function<Vec3(const Vec3& p_P, double time_s)>;

/// Contrast agent in flowing blood: a stream from the tip that fans to the vessel's wall and follows the flow. It
/// consists of strands at different distances from the wall, whose portions move with the blood there and with the
/// injected volume, and are diluted with a time constant. A portion that reaches the vessel's end or its greatest age
/// is washed away. docs/physics.md, X16.
class VesselStreak {
 public:
  VesselStreak(std::shared_ptr<const anatomy::VirtualPatient> patient, const VesselParams& params, BloodVelocity blood);

  bool is_vessel(const Vec3& p_P) const;
  /// A portion of `dt_s` (> 0) at a point in a vessel.
  void inject(const Vec3& tip_P, double dt_s, double ml, double iodine_mg_per_ml);
  void step(double dt_s);

  double iodine_mg() const;
  double washed_away_mg() const { return washed_away_mg_; }
  bool is_empty() const { return streams_.empty(); }
  void add_pieces(double least_mg_per_ml, std::vector<IodinePiece>& pieces) const;

 private:
  /// Agent between two places along the way, tail_mm <= head_mm.
  struct Portion {
    double tail_mm = 0.0, head_mm = 0.0;
    double iodine_mg = 0.0;
    double age_s = 0.0;
  };
  struct Strand {
    double offset = 0.0;  ///< From the way's middle, relative to the stream's radius.
    double angle = 0.0;   ///< Around it, rad.
    double radius = 0.5;  ///< Relative to the stream's radius; offset + radius <= 1.
    std::vector<Portion> portions;
    std::vector<double> speed_mm_per_s;  ///< At the way's stations, at the present time; NaN: not yet needed.
  };
  /// One injection.
  struct Stream {
    Vec3 tip_P = Vec3::Zero();
    detail::VesselCourse course;
    std::vector<Strand> strands;
    double section = 1.0;    ///< Of all strands, relative to the stream's.
    double mm3_per_s = 0.0;  ///< Rate of the injection; 0 after it.
  };

  Vec3 velocity(const Vec3& p_P, double time_s) const;
  Stream make_stream(const Vec3& tip_P) const;
  void forget_speeds(Stream& stream) const;
  double speed_mm_per_s(const Stream& stream, Strand& strand, std::size_t station) const;
  double moved_mm(const Stream& stream, Strand& strand, double place_mm, double dt_s) const;
  void move(Stream& stream, double dt_s);
  static void add_pieces_of(const Stream& stream, const Strand& strand, double least_mg_per_ml,
                            std::vector<IodinePiece>& pieces);

  std::shared_ptr<const anatomy::VirtualPatient> patient_;
  VesselParams params_;
  BloodVelocity blood_;
  std::vector<Stream> streams_;
  double time_s_ = 0.0;
  double washed_away_mg_ = 0.0;
};

}  // namespace trocar::xray
