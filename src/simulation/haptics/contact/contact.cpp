#include "haptics/contact/contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "haptics/contact/contact_balance.h"
#include "haptics/insertion/insertion_path.h"

namespace trocar::haptics {
namespace {

constexpr double kNear_mm = 1.0;           // points further from the skin need only one distance lookup
constexpr double kJump_mm = 5.0;           // exceeds hand motion between two ticks of any length ...
constexpr double kJump_mm_per_s = 5000.0;  // ... or at this speed
constexpr double kJump_rad = 0.5;

Mat3 rotation_of(const Vec3& turn) noexcept {
  const double angle = turn.norm();
  constexpr double kNone_rad = 1e-12;
  if (!(angle > kNone_rad)) return Mat3::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

struct SkinHere {
  double distance_mm;
  Vec3 normal_P;  ///< Unit, outwards.
  Vec3 p_A;       ///< The tissue there, at rest.
};

/// The signed distance to the skin with its gradient in the cell of voxels around a point.
class SkinField {
 public:
  explicit SkinField(const PatientNow& now) noexcept
      : motion_(now.motion),
        distance_(now.scene.patient->skin_distance_mm),
        per_mm_(distance_.geometry.spacing_mm.cwiseInverse()),
        row_(static_cast<std::size_t>(distance_.geometry.size[0])),
        plane_(row_ * static_cast<std::size_t>(distance_.geometry.size[1])) {}

  /// Empty outside the volume or without a gradient.
  std::optional<SkinHere> at(const Vec3& p_P) const noexcept {
    auto skin = at_rest(motion_.to_rest(p_P));
    if (!skin || motion_.is_rest()) return skin;
    // The unit gradient of the distance at rest, now: its length is how much nearer the skin is now than at rest.
    const Vec3 gradient_P = motion_.gradient_to_now(skin->p_A, skin->normal_P);
    const double length = gradient_P.norm();
    return SkinHere{skin->distance_mm / length, gradient_P / length, skin->p_A};
  }

 private:
  std::optional<SkinHere> at_rest(const Vec3& p_A) const noexcept {
    const volume::GridGeometry& g = distance_.geometry;
    const Vec3 index = (g.R_PV.transpose() * (p_A - g.origin_P)).cwiseProduct(per_mm_);
    std::int64_t low[3];
    double f[3];
    for (int a = 0; a < 3; ++a) {
      const auto last = static_cast<double>(g.size[static_cast<std::size_t>(a)] - 1);
      if (!(index[a] >= 0.0 && index[a] < last)) return {};  // also NaN
      low[a] = static_cast<std::int64_t>(index[a]);
      f[a] = index[a] - static_cast<double>(low[a]);
    }
    const float* v = distance_.voxels.data() + g.offset({low[0], low[1], low[2]});
    const auto mix = [](double a, double b, double t) { return a + t * (b - a); };
    const auto step_i = [&](std::size_t at) { return static_cast<double>(v[at + 1]) - static_cast<double>(v[at]); };
    const double s00 = step_i(0);
    const double s10 = step_i(row_);
    const double s01 = step_i(plane_);
    const double s11 = step_i(plane_ + row_);
    const double v00 = v[0] + f[0] * s00;
    const double v10 = v[row_] + f[0] * s10;
    const double v01 = v[plane_] + f[0] * s01;
    const double v11 = v[plane_ + row_] + f[0] * s11;
    const double v0 = mix(v00, v10, f[1]);
    const double v1 = mix(v01, v11, f[1]);
    const Vec3 slope_V(mix(mix(s00, s10, f[1]), mix(s01, s11, f[1]), f[2]), mix(v10 - v00, v11 - v01, f[2]), v1 - v0);
    const Vec3 gradient_P = g.R_PV * slope_V.cwiseProduct(per_mm_);
    const double norm = gradient_P.norm();
    constexpr double kNoDirection = 0.1;
    if (!(norm > kNoDirection)) return {};
    return SkinHere{mix(v0, v1, f[2]), gradient_P / norm, p_A};
  }

  const motion::PatientMotion& motion_;
  const volume::FloatGrid& distance_;
  Vec3 per_mm_;
  std::size_t row_;
  std::size_t plane_;
};

TissueColumn blend(const TissueColumn& from, const TissueColumn& to, double share) noexcept {
  const auto mix = [share](double a, double b) { return a + share * (b - a); };
  return {mix(from.stiffness_n_per_mm3, to.stiffness_n_per_mm3), mix(from.length_mm, to.length_mm),
          mix(from.stiffening_per_mm, to.stiffening_per_mm)};
}

/// The points of the face near the skin, with the tool at `X_PT`; `index` gives their numbers.
void find_points(ContactBalance& balance, std::array<std::uint8_t, kMaxContactPoints>& index, const ContactState& state,
                 const PatientNow& now, const Pose& X_PT, const Pose& X_PT_before) noexcept {
  const ContactFace& face = now.scene.face;
  const SkinField field(now);
  for (std::size_t i = 0; i < static_cast<std::size_t>(std::min(face.count, kMaxContactPoints)); ++i) {
    const Vec3 p_PQ = X_PT * face.point_T[i];
    const auto skin = field.at(p_PQ);
    if (!skin || !(skin->distance_mm < kNear_mm)) continue;
    const double facing = -skin->normal_P.dot(X_PT.R() * face.normal_T[i]);
    if (!(facing > 0.0)) continue;
    const auto n = static_cast<std::size_t>(balance.count++);
    index[n] = static_cast<std::uint8_t>(i);
    PressedPoint& point = balance.points[n];
    point.arm_P = p_PQ - X_PT.p();
    point.normal_P = skin->normal_P;
    point.depth_mm = -skin->distance_mm;
    point.depth_before_mm = state.depth_mm[i];
    point.area_mm2 = facing * face.area_mm2[i];
    point.column = tissue_column(now, p_PQ - skin->distance_mm * skin->normal_P, -skin->normal_P);
    if (state.depth_mm[i] > 0.0)
      point.column = blend(state.column[i], point.column, balance.dt_s / (balance.dt_s + kColumnBlend_s));
    const auto across = [&](const Vec3& v) -> Vec3 { return v - skin->normal_P * skin->normal_P.dot(v); };
    point.stretch_before_P = across(state.stretch_P[i]);
    Vec3 slide_P = state.stretch_P[i] + p_PQ - X_PT_before * face.point_T[i];
    if (!now.motion.is_rest()) slide_P -= balance.dt_s * now.motion.velocity(skin->p_A);
    point.stretch_P = state.depth_mm[i] > 0.0 ? across(slide_P) : Vec3(Vec3::Zero());
  }
}

bool has_jumped(const ContactState& state, const Pose& X_PT, double dt_s) noexcept {
  const double way_mm = (X_PT.p() - state.X_PT_device.p()).norm();
  const double cosine = 0.5 * ((state.X_PT_device.R().transpose() * X_PT.R()).trace() - 1.0);
  return !(way_mm <= kJump_mm + kJump_mm_per_s * dt_s) || !(cosine > std::cos(kJump_rad));
}

/// Sets the tool to the device's pose: outside the body at once, inside it with forces that increase from zero.
bool start(ContactState& state, const PatientNow& now, const Pose& X_PT) noexcept {
  const HapticScene& scene = now.scene;
  state = {};
  state.is_started = true;
  state.X_PT_device = state.X_PT = X_PT;
  const SkinField field(now);
  for (std::size_t i = 0; i < static_cast<std::size_t>(std::min(scene.face.count, kMaxContactPoints)); ++i) {
    const auto skin = field.at(X_PT * scene.face.point_T[i]);
    if (!skin || !(skin->distance_mm < 0.0)) continue;
    state.depth_mm[i] = -skin->distance_mm;
    state.column[i] =
        tissue_column(now, X_PT * scene.face.point_T[i] - skin->distance_mm * skin->normal_P, -skin->normal_P);
    state.engagement = 0.0;
  }
  return state.engagement == 0.0;
}

}  // namespace

ContactStep step_contact(ContactState& state, const PatientNow& now, const Pose& X_PT, double dt_s) noexcept {
  const HapticScene& scene = now.scene;
  ContactStep step;
  step.has_jumped = state.is_started && has_jumped(state, X_PT, dt_s);
  if (!state.is_started || step.has_jumped) step.started_inside = start(state, now, X_PT);

  // The previous virtual tool, moved with the device.
  ContactBalance balance;
  balance.offset_P = state.offset_P;
  balance.tilt_P = state.tilt_P;
  balance.coupling = scene.options.coupling;
  balance.lever_mm = scene.face.lever_mm;
  balance.friction_mu = scene.face.friction_mu;
  balance.engagement = state.engagement;
  balance.dt_s = dt_s;
  const Pose X_PT_carried(rotation_of(state.tilt_P) * X_PT.R(), X_PT.p() + state.offset_P);
  std::array<std::uint8_t, kMaxContactPoints> index{};
  find_points(balance, index, state, now, X_PT_carried, state.X_PT);

  const ContactSolution solution = solve(balance);
  const Vec3 offset_P = state.offset_P + solution.move_P;
  const Vec3 tilt_P = state.tilt_P + solution.turn_P;
  if (!offset_P.allFinite() || !tilt_P.allFinite()) {
    state = {};
    step.is_bound = true;
    return step;
  }

  state.depth_mm.fill(0.0);
  state.stretch_P.fill(Vec3::Zero());
  for (std::size_t n = 0; n < static_cast<std::size_t>(balance.count); ++n) {
    if (!(solution.depth_mm[n] > 0.0)) continue;
    state.depth_mm[index[n]] = solution.depth_mm[n];
    state.stretch_P[index[n]] = solution.stretch_P[n];
    state.column[index[n]] = balance.points[n].column;
    ++step.points_in_contact;
    step.depth_mm = std::max(step.depth_mm, solution.depth_mm[n]);
    step.normal_n += solution.normal_n[n];
    step.friction_n += solution.friction_P[n].norm();
  }
  state.engagement = step.points_in_contact > 0 ? std::min(1.0, state.engagement + dt_s / kEngage_s) : 1.0;
  state.offset_P = offset_P;
  state.tilt_P = tilt_P;
  state.X_PT_device = X_PT;
  state.X_PT = Pose(rotation_of(tilt_P) * X_PT.R(), X_PT.p() + offset_P);
  step.wrench_P = solution.wrench_P;
  step.is_bound = solution.hit_bound;
  return step;
}

namespace {

/// The points of a fingertip's face and the tissue under them.
class Fingertip {
 public:
  Fingertip(const PatientNow& now, const Vec3& skin_P, const Vec3& along_P) noexcept : count_(now.scene.face.count) {
    const HapticScene& scene = now.scene;
    // The finger's frame: y into the body.
    Mat3 R_PT;
    R_PT.col(1) = along_P;
    R_PT.col(0) = along_P.unitOrthogonal();
    R_PT.col(2) = R_PT.col(0).cross(R_PT.col(1));
    for (std::size_t n = 0; n < static_cast<std::size_t>(count_); ++n) {
      const Vec3& point_T = scene.face.point_T[n];
      const Vec3 beside_P = skin_P + R_PT * Vec3(point_T.x(), 0.0, point_T.z());
      const double off_skin_mm = skin_distance_mm(now, beside_P);
      Point& point = points_[n];
      point.before_mm = off_skin_mm - point_T.y();
      point.area_mm2 = scene.face.area_mm2[n] * scene.face.normal_T[n].y();
      point.column = tissue_column(now, beside_P + off_skin_mm * along_P, along_P);
    }
  }

  /// Force and its slope.
  ColumnResponse respond_to(double pressed_mm) const noexcept {
    ColumnResponse all;
    for (std::size_t n = 0; n < static_cast<std::size_t>(count_); ++n) {
      const ColumnResponse one = respond(points_[n].column, pressed_mm - points_[n].before_mm);
      all.pressure += points_[n].area_mm2 * one.pressure;
      all.tangent += points_[n].area_mm2 * one.tangent;
    }
    return all;
  }

 private:
  struct Point {
    double before_mm = 0.0;  ///< Press at which it touches the skin.
    double area_mm2 = 0.0;   ///< Across the press.
    TissueColumn column;
  };
  int count_;
  std::array<Point, kMaxContactPoints> points_{};
};

bool is_place(const Vec3& skin_P, const Vec3& inward_P) noexcept {
  return skin_P.allFinite() && inward_P.allFinite() && inward_P.norm() > 0.0;
}

Palpation felt_at(const PatientNow& now, const Vec3& skin_P, const Vec3& along_P, const Fingertip& finger,
                  double pressed_mm) noexcept {
  const ColumnResponse response = finger.respond_to(pressed_mm);
  Palpation felt{response.pressure, pressed_mm, response.tangent, {}};
  const TissueColumn middle = tissue_column(now, skin_P, along_P);
  if (middle.length_mm < kColumn_mm) felt.bone_mm = middle.length_mm;
  return felt;
}

}  // namespace

Palpation press(const PatientNow& now, const Vec3& skin_P, const Vec3& inward_P, double pressed_mm) noexcept {
  if (!is_place(skin_P, inward_P) || !(pressed_mm > 0.0)) return {};
  const Vec3 along_P = inward_P.normalized();
  return felt_at(now, skin_P, along_P, Fingertip(now, skin_P, along_P), pressed_mm);
}

Palpation palpate(const PatientNow& now, const Vec3& skin_P, const Vec3& inward_P, double force_n) noexcept {
  if (!is_place(skin_P, inward_P) || !(force_n > 0.0)) return {};
  constexpr int kHalvings = 12;  // 0.01 mm
  const Vec3 along_P = inward_P.normalized();
  const Fingertip finger(now, skin_P, along_P);
  double low_mm = 0.0, high_mm = kColumn_mm;
  for (int n = 0; n < kHalvings; ++n) {
    const double middle_mm = 0.5 * (low_mm + high_mm);
    (finger.respond_to(middle_mm).pressure < force_n ? low_mm : high_mm) = middle_mm;
  }
  return felt_at(now, skin_P, along_P, finger, 0.5 * (low_mm + high_mm));
}

Hardness hardness_of(const Palpation& palpation) noexcept {
  if (palpation.stiffness_n_per_mm >= kHard_n_per_mm) return Hardness::kHard;
  return palpation.stiffness_n_per_mm >= kFirm_n_per_mm ? Hardness::kFirm : Hardness::kSoft;
}

}  // namespace trocar::haptics
