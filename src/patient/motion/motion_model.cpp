#include "motion/motion_model.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/motion_file.h"
#include "volume/sampling.h"

namespace trocar::motion {
namespace {

constexpr double kMostDisplacement_mm = 150.0;
constexpr std::int64_t kFewestNodes = 3, kMostNodes = 512;
constexpr std::size_t kMostVoxels = std::size_t{1} << 26;  ///< Of the lattice and of the border.
constexpr const char* kAdvice = "make the model again: trocar patient motion DIR --force";

/// The three nodes with an influence along one axis, with their weights and the derivatives of these per node.
struct Taps {
  std::int64_t first;
  std::array<float, 3> weight, slope;
};

/// `at`: place in nodes; held within the middles of the outermost cells, beyond which the spline is constant.
Taps taps(double at, std::int64_t nodes) noexcept {
  const double low = 0.5, high = static_cast<double>(nodes) - 1.5;
  const double held = at > low ? std::min(at, high) : low;  // NaN becomes low
  const bool is_held = held != at;
  const auto middle = std::min(static_cast<std::int64_t>(held + 0.5), nodes - 2);
  const auto t = static_cast<float>(held - static_cast<double>(middle));
  const float before = 0.5F - t, behind = 0.5F + t;
  Taps result{
      middle - 1, {0.5F * before * before, 0.75F - t * t, 0.5F * behind * behind}, {-before, -2.0F * t, behind}};
  if (is_held) result.slope = {};
  return result;
}

Status check_sizes(const MotionParts& parts, const std::string& where) {
  const auto is_empty = [](const std::string& name) { return name.empty(); };
  if (parts.drivers.empty() || parts.drivers.size() > kMostDrivers || parts.regions.empty() ||
      parts.regions.size() > kMostRegions || std::ranges::any_of(parts.drivers, is_empty) ||
      std::ranges::any_of(parts.regions, is_empty))
    return fail(fmt::format("needs 1 to {} drivers and 1 to {} regions, with names", kMostDrivers, kMostRegions), where,
                kAdvice);
  const volume::GridGeometry& lattice = parts.lattice;
  const auto is_count = [](std::int64_t n) { return n >= kFewestNodes && n <= kMostNodes; };
  if (!std::ranges::all_of(lattice.size, is_count) || lattice.voxel_count() > kMostVoxels ||
      !lattice.origin_P.allFinite() || !(lattice.spacing_mm.array() > 0.0).all() || !lattice.spacing_mm.allFinite() ||
      lattice.R_PV != Mat3::Identity())
    return fail("the lattice of the displacements has an impossible size or place", where, kAdvice);
  if (parts.modes.size() != parts.drivers.size() * parts.regions.size() ||
      std::ranges::any_of(parts.modes, [&](const auto& mode) { return mode.size() != lattice.voxel_count(); }))
    return fail("needs one displacement for each driver, region and node", where, kAdvice);
  if (parts.border_mm.empty() != (parts.regions.size() == 1) ||
      parts.border_mm.voxels.size() != parts.border_mm.geometry.voxel_count() ||
      parts.border_mm.voxels.size() > kMostVoxels)
    return fail("needs the border between its two regions", where, kAdvice);
  return {};
}

Status check_numbers(const MotionParts& parts, const std::string& where) {
  for (const auto& mode : parts.modes)
    for (const Vec3f& moved_mm : mode) {
      if (!moved_mm.allFinite() || moved_mm.norm() > kMostDisplacement_mm)
        return fail(fmt::format("a displacement is no number, or above {} mm", kMostDisplacement_mm), where, kAdvice);
    }
  const auto is_number = [](auto value) { return std::isfinite(value); };
  const auto is_drive = [](double value) { return value >= kLeastDrive && value <= kMostDrive; };
  if (!std::ranges::all_of(parts.border_mm.voxels, is_number) || !std::ranges::all_of(parts.at_ct, is_drive) ||
      !(parts.liver_mm >= 1.0 && parts.liver_mm <= 100.0))
    return fail("a number of the border or the drivers at the CT is out of its range", where, kAdvice);
  return {};
}

/// The smallest eigenvalue of the symmetric part.
double strongest_shortening(const Mat3& gradient) {
  const Mat3 symmetric = 0.5 * (gradient + gradient.transpose());
  if (symmetric.norm() < kMostShortening) return symmetric.norm();  // no eigenvalue is larger
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(symmetric, Eigen::EigenvaluesOnly);
  return -solver.eigenvalues()[0];
}

/// Strongest shortening at a node with the drivers at the corners of their range: it is convex in them.
double shortening_at(const std::vector<Mat3>& gradients, const MotionParts::Scalars& at_ct) {
  double strongest = 0.0;
  for (unsigned corner = 0; corner < 1U << gradients.size(); ++corner) {
    Mat3 sum = Mat3::Zero();
    for (std::size_t d = 0; d < gradients.size(); ++d)
      sum += (((corner >> d & 1U) != 0 ? kMostDrive : kLeastDrive) - at_ct[d]) * gradients[d];
    strongest = std::max(strongest, strongest_shortening(sum));
  }
  return strongest;
}

Status check_shortening(const MotionModel& model, const std::string& where) {
  const MotionParts& parts = model.parts();
  for (int region = 0; region < static_cast<int>(parts.regions.size()); ++region)
    for (std::size_t node = 0; node < parts.lattice.voxel_count(); ++node) {
      const double strongest = model.shortening(region, node);
      if (strongest <= kMostShortening) continue;
      const Vec3 p_A = parts.lattice.centre_mm(parts.lattice.index_of(node));
      return fail(
          fmt::format("region {}: tissue at {:.0f}, {:.0f}, {:.0f} mm would be shortened by {:.0f} %, more than {:.0f}",
                      parts.regions[static_cast<std::size_t>(region)], p_A.x(), p_A.y(), p_A.z(), 100.0 * strongest,
                      100.0 * kMostShortening),
          where, "use smaller displacements");
    }
  return {};
}

}  // namespace

Result<std::shared_ptr<const MotionModel>> MotionModel::make(MotionParts parts, const std::string& where) {
  TROCAR_TRY(auto model, unchecked(std::move(parts), where));
  TROCAR_TRY_STATUS(check_shortening(*model, where));
  return model;
}

Result<std::shared_ptr<const MotionModel>> MotionModel::unchecked(MotionParts parts, const std::string& where) {
  TROCAR_TRY_STATUS(check_sizes(parts, where));
  TROCAR_TRY_STATUS(check_numbers(parts, where));
  // Files do not keep the sign of a zero, which would give another hash.
  for (std::vector<Vec3f>& mode : parts.modes)
    for (Vec3f& moved_mm : mode) moved_mm.array() += 0.0F;
  for (float& depth_mm : parts.border_mm.voxels) depth_mm += 0.0F;
  return std::shared_ptr<const MotionModel>(new MotionModel(std::move(parts)));
}

/// At the node and half way to the next ones, where the slopes of a quadratic spline have their extremes.
double MotionModel::shortening(int region, std::size_t node) const {
  std::vector<Mat3> gradients(parts_.drivers.size());
  double strongest = 0.0;
  for (const double half : {0.0, 0.5}) {
    const Vec3 p_A = parts_.lattice.to_mm(volume::to_vec3(parts_.lattice.index_of(node)) + half * Vec3::Ones());
    for (std::size_t d = 0; d < gradients.size(); ++d) {
      Scalars one{};
      one[d] = 1.0;
      gradients[d] = field(region, p_A, one).gradient;
    }
    strongest = std::max(strongest, shortening_at(gradients, parts_.at_ct));
  }
  return strongest;
}

MotionModel::MotionModel(MotionParts parts) : parts_(std::move(parts)), hash_(hash_motion(parts_)) {
  last_region_ = static_cast<int>(parts_.regions.size()) - 1;
  nodes_per_mm_ = parts_.lattice.spacing_mm.cwiseInverse();
  const std::size_t drivers = parts_.drivers.size(), nodes = parts_.lattice.voxel_count();
  region_stride_ = 4 * drivers * nodes;
  coefficients_.assign(region_stride_ * parts_.regions.size(), 0.0F);
  for (std::size_t d = 0; d < drivers; ++d) {
    for (std::size_t n = 0; n < nodes; ++n) {
      for (std::size_t r = 0; r < parts_.regions.size(); ++r) {
        const Vec3f& moved = parts_.modes[r * drivers + d][n];
        std::copy_n(moved.data(), 3, &coefficients_[r * region_stride_ + 4 * (n * drivers + d)]);
        longest_mm_[d] = std::max(longest_mm_[d], static_cast<double>(moved.norm()));
      }
      if (last_region_ == 0) continue;
      const Vec3f slide = parts_.modes[d][n] - parts_.modes[drivers + d][n];
      widest_mm_[d] = std::max(widest_mm_[d], static_cast<double>(slide.norm()));
    }
  }
}

double MotionModel::depth_mm(const Vec3& p_A) const noexcept {
  return last_region_ == 0 ? 0.0 : volume::sample_linear(parts_.border_mm, p_A);
}

/// Value and derivatives per node of the spline of a region. In floats only what differs from the middle node: the same
/// displacement everywhere is exact, and others to 1e-6 of how much they vary from node to node.
template <bool kHasSlope>
MotionModel::Sums MotionModel::sums(int region, const Vec3& p_A, const Scalars& drives) const noexcept {
  const auto& size = parts_.lattice.size;
  const Vec3 at = (p_A - parts_.lattice.origin_P).cwiseProduct(nodes_per_mm_);
  const Taps x = taps(at.x(), size[0]), y = taps(at.y(), size[1]), z = taps(at.z(), size[2]);
  const std::size_t drivers = parts_.drivers.size();
  const float* const base = coefficients_.data() + static_cast<std::size_t>(region) * region_stride_;
  std::array<float, kMostDrivers> shares{};
  for (std::size_t d = 0; d < kMostDrivers; ++d) shares[d] = static_cast<float>(drives[d]);
  Sums all;
  const auto combined = [&](const float* node) {
    Eigen::Array4f moved = shares[0] * Eigen::Map<const Eigen::Array4f>(node);
    for (std::size_t d = 1; d < drivers; ++d) moved += shares[d] * Eigen::Map<const Eigen::Array4f>(node + 4 * d);
    return moved;
  };
  const std::int64_t middle = ((z.first + 1) * size[1] + y.first + 1) * size[0] + x.first + 1;
  const float* const middle_node = base + 4 * drivers * static_cast<std::size_t>(middle);
  const Eigen::Array4f middle_value = combined(middle_node);
  for (std::size_t d = 0; d < drivers; ++d)
    all.middle_mm += drives[d] * Eigen::Map<const Eigen::Vector3f>(middle_node + 4 * d).cast<double>();
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t j = 0; j < 3; ++j) {
      const std::int64_t row =
          ((z.first + static_cast<std::int64_t>(k)) * size[1] + y.first + static_cast<std::int64_t>(j)) * size[0];
      const float* node = base + 4 * drivers * static_cast<std::size_t>(row + x.first);
      Eigen::Array4f row_value = Eigen::Array4f::Zero(), row_slope = Eigen::Array4f::Zero();
      for (std::size_t i = 0; i < 3; ++i, node += 4 * drivers) {
        const Eigen::Array4f moved = combined(node) - middle_value;
        row_value += x.weight[i] * moved;
        if constexpr (kHasSlope) row_slope += x.slope[i] * moved;
      }
      const float weight = z.weight[k] * y.weight[j];
      all.value += weight * row_value;
      if constexpr (!kHasSlope) continue;
      all.along[0] += weight * row_slope;
      all.along[1] += z.weight[k] * y.slope[j] * row_value;
      all.along[2] += z.slope[k] * y.weight[j] * row_value;
    }
  return all;
}

Vec3 MotionModel::displacement_mm(int region, const Vec3& p_A, const Scalars& drives) const noexcept {
  const Sums all = sums<false>(region, p_A, drives);
  return all.middle_mm + all.value.head<3>().matrix().cast<double>();
}

MotionModel::Field MotionModel::field(int region, const Vec3& p_A, const Scalars& drives) const noexcept {
  const Sums all = sums<true>(region, p_A, drives);
  Field result;
  result.displacement_mm = all.middle_mm + all.value.head<3>().matrix().cast<double>();
  for (int axis = 0; axis < 3; ++axis)
    result.gradient.col(axis) =
        nodes_per_mm_[axis] * all.along[static_cast<std::size_t>(axis)].head<3>().matrix().cast<double>();
  return result;
}

double MotionModel::most_displacement_mm(const Scalars& drives) const noexcept {
  double sum_mm = 0.0;
  for (std::size_t d = 0; d < kMostDrivers; ++d) sum_mm += std::abs(drives[d]) * longest_mm_[d];
  return sum_mm;
}

double MotionModel::most_slide_mm(const Scalars& drives) const noexcept {
  double sum_mm = 0.0;
  for (std::size_t d = 0; d < kMostDrivers; ++d) sum_mm += std::abs(drives[d]) * widest_mm_[d];
  return sum_mm;
}

}  // namespace trocar::motion
