#include "bench/liver_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "volume/sampling.h"

namespace trocar::bench {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kIndentation_mm = 3.0;           ///< A convex face sinks in that far to have contact over its width.
constexpr double kSteepest_rad = 40.0 * kDegree;  ///< Of the beam's middle to the skin's normal.
constexpr double kNearest_mm = 25.0, kDeepest_mm = 130.0, kStep_mm = 5.0;  ///< Depths that count.
constexpr int kLines = 13;

enum class Role : std::uint8_t { kOther, kLiver, kBlock };

std::array<Role, 256> roles_of(const LabelTable& table) {
  std::array<Role, 256> roles{};
  for (const Label& label : table.labels) {
    if (label.tissue == "liver") roles[label.id] = Role::kLiver;
    if (label.tissue == "bone" || label.tissue == "lung" || label.tissue == "gas") roles[label.id] = Role::kBlock;
  }
  return roles;
}

std::optional<Vec3> middle_of_liver(const VirtualPatient& patient, const std::array<Role, 256>& roles) {
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  const GridGeometry& grid = patient.labels.geometry;
  for (std::size_t at = 0; at < patient.labels.voxels.size(); at += 7) {
    if (roles[patient.labels.voxels[at]] != Role::kLiver) continue;
    const Index3 ijk = grid.index_of(at);
    sum += grid.to_mm(Vec3(static_cast<double>(ijk[0]), static_cast<double>(ijk[1]), static_cast<double>(ijk[2])));
    count += 1.0;
  }
  if (count == 0.0) return std::nullopt;
  return sum / count;
}

/// Samples of liver that sound reaches.
int liver_seen(const VirtualPatient& patient, const std::array<Role, 256>& roles, const ScanGeometry& scan,
               const Pose& X_PT) {
  int seen = 0;
  for (int n = 0; n < kLines; ++n) {
    const double line = static_cast<double>(n) * (scan.lines - 1) / (kLines - 1);
    for (double depth_mm = 0.0; depth_mm < kDeepest_mm; depth_mm += kStep_mm) {
      const Vec2 p = scan.to_cartesian({line, depth_mm});
      const Vec3 p_P = X_PT * Vec3(p.x(), p.y(), 0.0);
      const Role role = roles[sample_nearest(patient.labels, p_P, std::uint8_t{0})];
      if (role == Role::kBlock) break;
      if (role == Role::kLiver && depth_mm >= kNearest_mm) ++seen;
    }
  }
  return seen;
}

/// From the middle outwards to the skin; nothing where the volume ends before.
std::optional<Vec3> skin_along(const VirtualPatient& patient, Vec3 p_P, const Vec3& direction) {
  for (double way_mm = 0.0; way_mm < 400.0; way_mm += 1.0) {
    p_P += direction;
    const Vec3 index = patient.skin_distance_mm.geometry.to_index(p_P);
    const auto& size = patient.skin_distance_mm.geometry.size;
    for (std::size_t a = 0; a < 3; ++a)
      if (index[static_cast<Eigen::Index>(a)] < 2.0 ||
          index[static_cast<Eigen::Index>(a)] > static_cast<double>(size[a]) - 3.0)
        return std::nullopt;
    if (sample_linear_at_index(patient.skin_distance_mm, index) >= 0.0) return p_P;
  }
  return std::nullopt;
}

Vec3 outwards(int azimuth_deg, int height_deg) {
  const double a = azimuth_deg * kDegree, h = height_deg * kDegree;
  return {-std::sin(a) * std::cos(h), -std::cos(a) * std::cos(h), std::sin(h)};
}

/// The direction itself and rings about it, as steep as a transducer is held.
std::vector<Vec3> directions_about(const Vec3& middle) {
  std::vector<Vec3> directions{middle};
  const Vec3 side = middle.unitOrthogonal();
  for (const double tilt_rad : {0.5 * kSteepest_rad, kSteepest_rad})
    for (int turn = 0; turn < 360; turn += 45)
      directions.push_back(Eigen::AngleAxisd(turn * kDegree, middle) * (Eigen::AngleAxisd(tilt_rad, side) * middle));
  return directions;
}

Pose pose_looking(const Vec3& face_P, const Vec3& along, double roll_rad) {
  const Vec3 y = along.normalized();
  const Vec3 x_plain = Vec3::UnitX() - y * y.x();
  const Vec3 x0 = x_plain.norm() > 0.1 ? x_plain.normalized() : (Vec3::UnitZ() - y * y.z()).normalized();
  const Vec3 x = Eigen::AngleAxisd(roll_rad, y) * x0;
  Mat3 R;
  R.col(0) = x;
  R.col(1) = y;
  R.col(2) = x.cross(y);
  return {R, face_P};
}

}  // namespace

std::optional<Pose> find_liver_view(const VirtualPatient& patient, const ScanGeometry& scan) {
  const auto roles = roles_of(patient.label_table);
  const auto middle_P = middle_of_liver(patient, roles);
  if (!middle_P) return std::nullopt;
  std::optional<Pose> best;
  int most = 0;
  // Skin from the front to the right side (LPS: -y is in front, -x right), from below the ribs to the dome.
  for (int azimuth = -20; azimuth <= 100; azimuth += 10)
    for (int height = -60; height <= 30; height += 10) {
      const auto skin_P = skin_along(patient, *middle_P, outwards(azimuth, height));
      if (!skin_P) continue;
      const Vec3 normal = gradient_per_mm(patient.skin_distance_mm, *skin_P).normalized();
      const Vec3 face_P = *skin_P - kIndentation_mm * normal;
      for (const Vec3& along : directions_about(-normal))
        for (int roll = 0; roll < 180; roll += 30) {
          const Pose X_PT = pose_looking(face_P, along, roll * kDegree);
          const int seen = liver_seen(patient, roles, scan, X_PT);
          if (seen <= most) continue;
          most = seen;
          best = X_PT;
        }
    }
  return best;
}

}  // namespace trocar::bench
