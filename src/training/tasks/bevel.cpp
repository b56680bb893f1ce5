#include "tasks/bevel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "geometry/pose.h"
#include "tasks/detail/block_grid.h"

namespace trocar::tasks {
namespace {

constexpr double kReach_mm = 15.0;  // of the structure above and below the point, and to its sides
constexpr double kLeast_mm = 5.0;   // between the two centres
constexpr double kLeast = 1e-6;

}  // namespace

std::optional<Vec3> find_fibres(const Task& task, const anatomy::VirtualPatient& patient, const Vec3& near_P) {
  if (!task.bevel) return std::nullopt;
  std::array<bool, 256> is_along{};
  for (const anatomy::Label& label : patient.label_table.labels)
    is_along[label.id] = label.tissue == task.bevel->fibres || label.name == task.bevel->fibres;
  const volume::LabelGrid& labels = patient.labels;
  const detail::IndexBox box = detail::clipped(detail::box_around(labels.geometry, near_P, kReach_mm), labels.geometry);
  std::vector<Vec3> points_P;
  Vec3 middle_P = Vec3::Zero();
  for (std::int64_t k = box.low[2]; k <= box.high[2]; ++k)
    for (std::int64_t j = box.low[1]; j <= box.high[1]; ++j)
      for (std::int64_t i = box.low[0]; i <= box.high[0]; ++i) {
        if (!is_along[labels[{i, j, k}]]) continue;
        points_P.push_back(labels.geometry.centre_mm({i, j, k}));
        middle_P += points_P.back();
      }
  middle_P /= std::max<double>(1.0, static_cast<double>(points_P.size()));
  std::array<Vec3, 2> sum{Vec3::Zero(), Vec3::Zero()};  // below and above the middle: the scan may end near the point
  std::array<double, 2> count{};
  for (const Vec3& p_P : points_P) {
    const std::size_t half = p_P.z() < middle_P.z() ? 0 : 1;
    sum[half] += p_P;
    count[half] += 1.0;
  }
  if (count[0] < 1.0 || count[1] < 1.0) return std::nullopt;
  const Vec3 up_P = sum[1] / count[1] - sum[0] / count[0];
  if (up_P.norm() < kLeast_mm) return std::nullopt;
  return up_P.normalized();
}

double bevel_to_fibres_deg(const Mat3& R_PN, const Vec3& fibres_P) noexcept {
  const Vec3 across_P = fibres_P - fibres_P.dot(R_PN.col(2)) * R_PN.col(2);
  if (!(across_P.norm() > kLeast)) return 0.0;
  const double sine = std::abs(R_PN.col(1).dot(across_P.normalized()));
  return std::asin(std::min(sine, 1.0)) * 180.0 / std::numbers::pi;
}

Vec3 bevel_across_fibres_P(const Vec3& axis_P, const Vec3& fibres_P) noexcept {
  const Vec3 face_P = fibres_P.cross(axis_P);
  if (!(face_P.norm() > kLeast)) return axis_P.unitOrthogonal();
  return face_P.x() < 0.0 ? Vec3(-face_P.normalized()) : Vec3(face_P.normalized());
}

std::optional<Vec3> planned_bevel_P(const Task& task, const anatomy::VirtualPatient& patient, const Segment& path_P) {
  const auto fibres_P = find_fibres(task, patient, path_P.b);
  if (!fibres_P) return std::nullopt;
  return bevel_across_fibres_P(path_P.direction(), *fibres_P);
}

Mat3 needle_rotation(const Vec3& axis_P, const Vec3& bevel_P) noexcept {
  const Vec3 z_P = axis_P.normalized();
  const Vec3 y_P = bevel_P - bevel_P.dot(z_P) * z_P;
  if (!(y_P.norm() > kLeast)) return needle_pose(Vec3::Zero(), z_P).R();
  Mat3 R_PN;
  R_PN.col(2) = z_P;
  R_PN.col(1) = y_P.normalized();
  R_PN.col(0) = R_PN.col(1).cross(z_P);
  return R_PN;
}

}  // namespace trocar::tasks
