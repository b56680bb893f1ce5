#include "xray/contrast/vessel_streak.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "volume/sampling.h"

namespace trocar::xray {
namespace {

constexpr double kMm3PerMl = 1000.0;
constexpr double kProbe_mm = 0.5;  ///< Step of the search for the wall.
constexpr int kMostProbes = 40;    ///< Up to a radius of 20 mm.
constexpr double kLeastLength_mm = 1.0;
constexpr double kWallReach_mm = 2.0;       ///< From the wall; thinner layers are slow.
constexpr double kOffWall_mm_per_s = 30.0;  ///< Mixing across the section. Assumed, range 5..100.

}  // namespace

VesselStreak::VesselStreak(std::shared_ptr<const anatomy::VirtualPatient> patient, const VesselParams& params,
                           BloodVelocity blood)
    : patient_(std::move(patient)), params_(params), blood_(std::move(blood)) {}

bool VesselStreak::is_vessel(const Vec3& p_P) const {
  const anatomy::Label* label = anatomy::find_label(*patient_, p_P);
  return label != nullptr && label->tissue == "vessel";
}

Vec3 VesselStreak::velocity(const Vec3& p_P) const {
  const Vec3 v_P = blood_ ? blood_(p_P, time_s_) : Vec3::Zero();
  return v_P.allFinite() ? v_P : Vec3::Zero();
}

/// Away from the wall, towards the side on which there is more of the vessel; 0 in the middle.
Vec3 VesselStreak::towards_middle(const Vec3& p_P) const {
  Vec3 sum = Vec3::Zero();
  for (Eigen::Index a = 0; a < 3; ++a)
    for (const double side_mm : {-kWallReach_mm, kWallReach_mm}) {
      Vec3 away = Vec3::Zero();
      away[a] = side_mm;
      if (is_vessel(p_P + away)) sum += away;
    }
  return sum.norm() > 0.0 ? Vec3(sum.normalized()) : sum;
}

/// Second-order step along the flow. Mixing takes a portion off the wall, where the blood is slow.
Vec3 VesselStreak::moved(const Vec3& p_P, double dt_s) const {
  const Vec3 half_P = p_P + 0.5 * dt_s * velocity(p_P);
  const Vec3 to_P = p_P + dt_s * velocity(half_P);
  return to_P + dt_s * kOffWall_mm_per_s * towards_middle(to_P);
}

/// Distance from a point of a vessel to its wall, the least of four directions across.
double VesselStreak::lumen_mm(const Vec3& p_P, const Vec3& along) const {
  const Vec3 u = along.unitOrthogonal();
  const Vec3 v = along.cross(u);
  int least = kMostProbes;
  for (const Vec3& out : std::array<Vec3, 4>{u, -u, v, -v}) {
    int n = 1;
    while (n < least && is_vessel(p_P + n * kProbe_mm * out)) ++n;
    least = n;
  }
  return least * kProbe_mm;
}

void VesselStreak::inject(const Vec3& tip_P, double dt_s, double ml, double iodine_mg_per_ml) {
  Portion portion{moved(tip_P, dt_s), tip_P, ml * iodine_mg_per_ml, 0.0, 1.0};
  if (!is_vessel(portion.head_P)) portion.head_P = tip_P;
  const Vec3 way_P = portion.head_P - tip_P;
  const double length_mm = std::max(way_P.norm(), kLeastLength_mm);
  const Vec3 along = way_P.norm() > 1e-6 ? Vec3(way_P.normalized()) : Vec3(Vec3::UnitZ());
  // The portion fills at least its own volume; blood that stands still takes it over the whole section.
  const double own_mm = std::sqrt(ml * kMm3PerMl / (std::numbers::pi * length_mm));
  portion.radius_mm = way_P.norm() > kLeastLength_mm ? own_mm : std::max(own_mm, lumen_mm(tip_P, along));
  portions_.push_back(portion);
}

void VesselStreak::step(double dt_s) {
  const double kept = std::exp(-dt_s / params_.washout_s);
  for (Portion& portion : portions_) {
    portion.age_s += dt_s;
    const double rest_mg = portion.iodine_mg * kept;
    washed_away_mg_ += portion.iodine_mg - rest_mg;
    portion.iodine_mg = rest_mg;
    const Vec3 head_P = moved(portion.head_P, dt_s), tail_P = moved(portion.tail_P, dt_s);
    // At the vessel's end the head waits for the tail.
    if (is_vessel(head_P)) portion.head_P = head_P;
    const bool has_left = !is_vessel(tail_P) || portion.age_s > params_.longest_s;
    portion.tail_P = tail_P;
    const Vec3 way_P = portion.head_P - portion.tail_P;
    const double length_mm = way_P.norm();
    if (has_left) {
      washed_away_mg_ += portion.iodine_mg;
      portion.iodine_mg = 0.0;
    } else if (length_mm > 1e-6) {
      const double spread_mm = std::sqrt(portion.radius_mm * portion.radius_mm + params_.spread_mm2_per_s * dt_s);
      const double wall_mm = lumen_mm(0.5 * (portion.head_P + portion.tail_P), way_P / length_mm);
      portion.radius_mm = std::max(std::min(spread_mm, wall_mm), portion.radius_mm);
    }
  }
  std::erase_if(portions_, [](const Portion& portion) { return portion.iodine_mg <= 0.0; });
  time_s_ += dt_s;
}

double VesselStreak::iodine_mg() const {
  double sum = 0.0;
  for (const Portion& portion : portions_) sum += portion.iodine_mg;
  return sum;
}

void VesselStreak::add_pieces(double least_mg_per_ml, std::vector<IodinePiece>& pieces) const {
  for (const Portion& portion : portions_) {
    Vec3 way_P = portion.head_P - portion.tail_P;
    if (way_P.norm() < kLeastLength_mm) way_P = kLeastLength_mm * Vec3::UnitZ();
    const double ml = std::numbers::pi * portion.radius_mm * portion.radius_mm * way_P.norm() / kMm3PerMl;
    const double mg_per_ml = portion.iodine_mg / ml;
    if (mg_per_ml < least_mg_per_ml) continue;
    pieces.push_back({portion.tail_P, portion.tail_P + way_P, portion.radius_mm, portion.radius_mm, mg_per_ml});
  }
}

}  // namespace trocar::xray
