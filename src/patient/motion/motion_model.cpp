#include "motion/motion_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "motion/motion_file.h"

namespace trocar::motion {
namespace {

constexpr double kMostDisplacement_mm = 100.0;
constexpr double kLeastExtent_mm = 1.0, kMostExtent_mm = 1000.0, kMostOffset_mm = 10'000.0;
constexpr const char* kAdvice = "correct it";

bool is_unit(const Vec3& v) noexcept {
  constexpr double kRounding = 1e-6;
  return v.allFinite() && std::abs(v.norm() - 1.0) < kRounding;
}

bool is_near(const Vec3& p) noexcept {
  return p.allFinite() && p.norm() <= kMostOffset_mm;
}

/// The weight of a profile at a point, and its gradient per mm.
struct Weight {
  double value;
  Vec3 per_mm;
};

Weight weight_at(const MotionMode& mode, const Vec3& p_A) noexcept {
  switch (mode.profile) {
    case Profile::kUniform:
      break;
    case Profile::kRamp:
      return {mode.axis_A.dot(p_A - mode.centre_A) / mode.extent_mm, mode.axis_A / mode.extent_mm};
    case Profile::kBump: {
      const Vec3 from_centre = p_A - mode.centre_A;
      const double square = mode.extent_mm * mode.extent_mm;
      const double value = std::exp(-0.5 * from_centre.squaredNorm() / square);
      return {value, from_centre * (-value / square)};
    }
  }
  return {1.0, Vec3::Zero()};
}

/// Largest gradient of a mode's displacement, with its driver at 1.
double most_gradient(const MotionMode& mode) noexcept {
  const double per_mm = mode.displacement_mm.norm() / mode.extent_mm;
  switch (mode.profile) {
    case Profile::kUniform:
      return 0.0;
    case Profile::kRamp:
      return per_mm;
    case Profile::kBump:
      return per_mm * std::exp(-0.5);  // at r = extent
  }
  return 0.0;
}

Status check_mode(const MotionMode& mode, const MotionParts& parts, const std::string& where) {
  if (mode.driver < 0 || static_cast<std::size_t>(mode.driver) >= parts.drivers.size())
    return fail(fmt::format("a mode has the driver {}, of {}", mode.driver, parts.drivers.size()), where, kAdvice);
  if (mode.region < MotionMode::kEveryRegion || mode.region >= static_cast<int>(parts.regions.size()))
    return fail(fmt::format("a mode has the region {}, of {}", mode.region, parts.regions.size()), where, kAdvice);
  if (!mode.displacement_mm.allFinite() || mode.displacement_mm.norm() > kMostDisplacement_mm)
    return fail(fmt::format("a mode moves by more than {} mm", kMostDisplacement_mm), where, kAdvice);
  if (!is_near(mode.centre_A) || !is_unit(mode.axis_A))
    return fail("a mode has a centre far outside, or an axis that is no unit vector", where, kAdvice);
  if (!(mode.extent_mm >= kLeastExtent_mm && mode.extent_mm <= kMostExtent_mm))
    return fail(fmt::format("a mode has an extent outside {} to {} mm", kLeastExtent_mm, kMostExtent_mm), where,
                kAdvice);
  return {};
}

Status check_regions(const MotionParts& parts, const std::string& where) {
  if (parts.regions.empty() || !parts.regions.back().sides.empty())
    return fail("the last region has sides: points outside all regions would have no motion", where,
                "add a region without sides as the last one");
  for (const MotionRegion& region : parts.regions) {
    if (region.name.empty()) return fail("a region has no name", where, "name it");
    for (const HalfSpace& side : region.sides) {
      if (!is_unit(side.normal_A) || !(std::abs(side.offset_mm) <= kMostOffset_mm))
        return fail(fmt::format("region {}: a side needs a unit vector and a finite offset", region.name), where,
                    kAdvice);
    }
  }
  return {};
}

Status check_gradients(const MotionParts& parts, const std::string& where) {
  for (int region = 0; region < static_cast<int>(parts.regions.size()); ++region) {
    double sum = 0.0;
    for (const MotionMode& mode : parts.modes) {
      if (mode.region == region || mode.region == MotionMode::kEveryRegion) sum += kMostDrive * most_gradient(mode);
    }
    if (!(sum <= kMostGradient))
      return fail(fmt::format("region {}: its tissue could be stretched or sheared by {:.2f}, more than {}",
                              parts.regions[static_cast<std::size_t>(region)].name, sum, kMostGradient),
                  where, "use smaller displacements or larger extents");
  }
  return {};
}

}  // namespace

Result<std::shared_ptr<const MotionModel>> MotionModel::make(MotionParts parts, const std::string& where) {
  if (parts.drivers.empty() || parts.drivers.size() > kMostDrivers || parts.regions.size() > kMostRegions ||
      parts.modes.size() > kMostModes)
    return fail(
        fmt::format("needs 1 to {} drivers, at most {} regions and {} modes", kMostDrivers, kMostRegions, kMostModes),
        where, kAdvice);
  TROCAR_TRY_STATUS(check_regions(parts, where));
  for (const MotionMode& mode : parts.modes) TROCAR_TRY_STATUS(check_mode(mode, parts, where));
  TROCAR_TRY_STATUS(check_gradients(parts, where));
  return std::shared_ptr<const MotionModel>(new MotionModel(std::move(parts)));
}

MotionModel::MotionModel(MotionParts parts) : parts_(std::move(parts)), hash_(hash_motion(parts_)) {}

bool MotionModel::contains(std::size_t region, const Vec3& p_A) const noexcept {
  return std::ranges::all_of(parts_.regions[region].sides,
                             [&](const HalfSpace& side) { return side.normal_A.dot(p_A) <= side.offset_mm; });
}

int MotionModel::region_of(const Vec3& p_A) const noexcept {
  std::size_t region = 0;
  while (region + 1 < parts_.regions.size() && !contains(region, p_A)) ++region;
  return static_cast<int>(region);
}

double MotionModel::outside_mm(int region, const Vec3& p_A) const noexcept {
  const auto own = static_cast<std::size_t>(region);
  double most = 0.0;
  for (const HalfSpace& side : parts_.regions[own].sides)
    most = std::max(most, side.normal_A.dot(p_A) - side.offset_mm);
  // An earlier region that contains the point has it: the way out of that one.
  for (std::size_t earlier = 0; earlier < own; ++earlier) {
    if (!contains(earlier, p_A)) continue;
    double out = std::numeric_limits<double>::infinity();
    for (const HalfSpace& side : parts_.regions[earlier].sides)
      out = std::min(out, side.offset_mm - side.normal_A.dot(p_A));
    most = std::max(most, std::nextafter(out, std::numeric_limits<double>::infinity()));
  }
  return most;
}

Vec3 MotionModel::displacement_mm(int region, const Vec3& p_A, const Scalars& drivers) const noexcept {
  Vec3 sum = Vec3::Zero();
  for (const MotionMode& mode : parts_.modes) {
    if (mode.region != region && mode.region != MotionMode::kEveryRegion) continue;
    sum += drivers[static_cast<std::size_t>(mode.driver)] * weight_at(mode, p_A).value * mode.displacement_mm;
  }
  return sum;
}

MotionModel::Field MotionModel::field(int region, const Vec3& p_A, const Scalars& drivers) const noexcept {
  Field field{Vec3::Zero(), Mat3::Zero()};
  for (const MotionMode& mode : parts_.modes) {
    if (mode.region != region && mode.region != MotionMode::kEveryRegion) continue;
    const Vec3 moved = drivers[static_cast<std::size_t>(mode.driver)] * mode.displacement_mm;
    const Weight weight = weight_at(mode, p_A);
    field.displacement_mm += weight.value * moved;
    field.gradient += moved * weight.per_mm.transpose();
  }
  return field;
}

}  // namespace trocar::motion
