#include "ultrasound/panorama/detail/panorama_sampler.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ultrasound/panorama/detail/panorama_sampler.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which sets the instruction set that these headers compile for.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "ultrasound/engine/detail/rest_shift.h"

#ifndef TROCAR_ULTRASOUND_PANORAMA_TYPES
#define TROCAR_ULTRASOUND_PANORAMA_TYPES
namespace trocar::ultrasound::detail {

/// A plane of a scanline in voxel indices: origin + along * rest_mm + across * sigma_mm.
struct PlaneLine {
  std::array<float, 3> origin{}, along{}, across{};
  std::array<float, 3> last{};            ///< Largest index.
  std::array<const float*, 3> to_rest{};  ///< Added to the index of each sample; nullptr: the patient does not move.
  std::int32_t row = 0, slab = 0;
  float share = 1.0F;
  float log_floor = 0.0F, log_step = 0.0F;  ///< Logarithm of the power of level 0, and of a level.
};

struct WeightRange {
  float least = 0.0F, most = 0.0F;
};

}  // namespace trocar::ultrasound::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace trocar::ultrasound::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, 16>;
using I = hn::RebindToSigned<F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;

/// Interpolates between the lowest byte and the next.
HWY_INLINE VF between_bytes(VI word, VF part) {
  const F f;
  const VI byte = hn::Set(I(), 0xff);
  const VF first = hn::ConvertTo(f, hn::And(word, byte));
  const VF second = hn::ConvertTo(f, hn::And(hn::ShiftRight<8>(word), byte));
  return hn::MulAdd(hn::Sub(second, first), part, first);
}

/// Trilinear values of a byte volume at samples `at` of a scanline; the place is clamped to the volume. `is_inside`
/// becomes false outside.
HWY_INLINE VF trilinear(const PlaneLine& plane, const std::uint8_t* voxels, VF rest_mm, VF sigma_mm, VI sample,
                        hn::Mask<F>& is_inside) {
  const F f;
  const I d;
  VF part[3];
  VI cell[3];
  is_inside = hn::FirstN(f, hn::Lanes(f));
  for (std::size_t a = 0; a < 3; ++a) {
    VF index = hn::MulAdd(rest_mm, hn::Set(f, plane.along[a]), hn::Set(f, plane.origin[a]));
    index = hn::MulAdd(sigma_mm, hn::Set(f, plane.across[a]), index);
    if (plane.to_rest[a] != nullptr) index = hn::Add(index, hn::GatherIndex(f, plane.to_rest[a], sample));
    const VF last = hn::Set(f, plane.last[a]);
    is_inside = hn::And(is_inside, hn::And(hn::Ge(index, hn::Zero(f)), hn::Le(index, last)));
    const VF held = hn::Min(hn::Max(index, hn::Zero(f)), hn::Sub(last, hn::Set(f, 1e-3F)));
    cell[a] = hn::ConvertTo(d, held);
    part[a] = hn::Sub(held, hn::ConvertTo(f, cell[a]));
  }
  const VI row = hn::Set(d, plane.row), slab = hn::Set(d, plane.slab);
  const VI at = hn::Add(cell[0], hn::Add(hn::Mul(cell[1], row), hn::Mul(cell[2], slab)));
  const auto* base = reinterpret_cast<const std::int32_t*>(voxels);
  const VF v00 = between_bytes(hn::GatherOffset(d, base, at), part[0]);
  const VF v10 = between_bytes(hn::GatherOffset(d, base, hn::Add(at, row)), part[0]);
  const VF v01 = between_bytes(hn::GatherOffset(d, base, hn::Add(at, slab)), part[0]);
  const VF v11 = between_bytes(hn::GatherOffset(d, base, hn::Add(hn::Add(at, slab), row)), part[0]);
  const VF near = hn::MulAdd(hn::Sub(v10, v00), part[1], v00);
  const VF far = hn::MulAdd(hn::Sub(v11, v01), part[1], v01);
  return hn::MulAdd(hn::Sub(far, near), part[2], near);
}

/// Weights of `count` samples whose places are gathered from every weight_step-th of the line.
WeightRange sample_weights(const PlaneLine& plane, const std::uint8_t* weights, const PanoramaLine& line, int count,
                           float* HWY_RESTRICT to) {
  const F f;
  const I d;
  VF least = hn::Set(f, 1.0F), most = hn::Zero(f);
  for (int n = 0; n < count; n += static_cast<int>(hn::Lanes(f))) {
    const VI at = hn::Min(hn::Mul(hn::Iota(d, n), hn::Set(d, line.weight_step)), hn::Set(d, line.samples - 1));
    hn::Mask<F> is_inside;
    const VF value = trilinear(plane, weights, hn::GatherIndex(f, line.rest_mm, at),
                               hn::GatherIndex(f, line.sigma_mm, at), at, is_inside);
    const VF weight = hn::IfThenElseZero(is_inside, hn::Mul(value, hn::Set(f, 1.0F / 255.0F)));
    hn::StoreU(weight, f, to + n);
    least = hn::Min(least, weight);
    most = hn::Max(most, weight);
  }
  return {hn::GetLane(hn::MinOfLanes(f, least)), hn::GetLane(hn::MaxOfLanes(f, most))};
}

/// Adds a plane's power and weights; `weights`: its own at each step, `is_whole` if all are 1.
void add_plane(const PlaneLine& plane, const std::uint8_t* levels, const PanoramaLine& line, const float* weights,
               bool is_whole, float* HWY_RESTRICT power, float* HWY_RESTRICT weight) {
  const F f;
  const I d;
  const VF share = hn::Set(f, plane.share), step = hn::Set(f, static_cast<float>(line.weight_step));
  const VF steps = hn::Set(f, 1.0F / static_cast<float>(line.weight_step));
  for (int s = 0; s < line.samples; s += static_cast<int>(hn::Lanes(f))) {
    VF own = share;
    if (!is_whole) {
      const VF at = hn::Iota(f, static_cast<float>(s));
      // Half a sample keeps the quotient off whole numbers, where it would be rounded down.
      const VI before = hn::ConvertTo(d, hn::Mul(hn::Add(at, hn::Set(f, 0.5F)), steps));
      const VF part = hn::Mul(hn::NegMulAdd(hn::ConvertTo(f, before), step, at), steps);
      const VF from = hn::GatherIndex(f, weights, before), to = hn::GatherIndex(f, weights + 1, before);
      own = hn::Mul(share, hn::MulAdd(hn::Sub(to, from), part, from));
      if (hn::AllTrue(f, hn::Eq(own, hn::Zero(f)))) continue;
    }
    hn::Mask<F> is_inside;
    const VF level = trilinear(plane, levels, hn::LoadU(f, line.rest_mm + s), hn::LoadU(f, line.sigma_mm + s),
                               hn::Iota(d, s), is_inside);
    const VF value = hn::Exp(f, hn::MulAdd(level, hn::Set(f, plane.log_step), hn::Set(f, plane.log_floor)));
    hn::StoreU(hn::MulAdd(own, value, hn::LoadU(f, power + s)), f, power + s);
    hn::StoreU(hn::Add(own, hn::LoadU(f, weight + s)), f, weight + s);
  }
}

/// Divides the power by the weight.
void finish(int n, PanoramaSamples& samples) {
  const F f;
  for (int s = 0; s < n; s += static_cast<int>(hn::Lanes(f))) {
    const VF weight = hn::Min(hn::LoadU(f, samples.weight.data() + s), hn::Set(f, 1.0F));
    const VF power = hn::LoadU(f, samples.power.data() + s);
    const auto is_there = hn::Gt(weight, hn::Zero(f));
    hn::StoreU(hn::IfThenElseZero(is_there, hn::Div(power, hn::Max(weight, hn::Set(f, 1e-12F)))), f,
               samples.power.data() + s);
    hn::StoreU(weight, f, samples.weight.data() + s);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace trocar::ultrasound::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trocar::ultrasound::detail {

static_assert(std::endian::native == std::endian::little, "the lowest byte of a gathered word must be its first voxel");

HWY_EXPORT(sample_weights);
HWY_EXPORT(add_plane);
HWY_EXPORT(finish);

namespace {

constexpr std::size_t kMostWeights = 4096 + 2 + 48;
constexpr float kWhole = 1.0F - 1e-6F;

std::array<float, 3> single_precision(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

PlaneLine plane_line(const PanoramaMap& map, const PanoramaLine& line, float zeta, float share) noexcept {
  const volume::GridGeometry& grid = map.panorama->geometry;
  PlaneLine plane;
  for (std::size_t a = 0; a < 3; ++a) {
    plane.origin[a] =
        map.index_of_origin[a] + map.index_of_T[0][a] * line.origin_T[0] + map.index_of_T[1][a] * line.origin_T[1];
    plane.along[a] = map.index_of_T[0][a] * line.along_T[0] + map.index_of_T[1][a] * line.along_T[1];
    plane.across[a] = zeta * map.index_of_T[2][a];
    plane.last[a] = static_cast<float>(grid.size[a] - 1);
  }
  plane.row = static_cast<std::int32_t>(grid.size[0]);
  plane.slab = static_cast<std::int32_t>(grid.size[0] * grid.size[1]);
  plane.share = share;
  constexpr double kPowerPerDb = std::numbers::ln10 / 10.0;
  plane.log_step = static_cast<float>(map.panorama->step_db * kPowerPerDb);
  plane.log_floor =
      static_cast<float>((map.panorama->floor_db - map.panorama->step_db - map.panorama->tissue_db) * kPowerPerDb);
  return plane;
}

/// Fills `to_rest` for a plane of a scanline and lets the plane use it.
void move_plane(const PanoramaMap& map, const motion::PatientMotion& motion, const PanoramaLine& line,
                std::array<std::vector<float>, 3>& to_rest, PlaneLine& plane) noexcept {
  const volume::GridGeometry& grid = map.panorama->geometry;
  const Pose &X_PU = map.panorama->X_PU, X_UP = X_PU.inverse();
  find_rest_shifts(
      motion, line.samples,
      [&](int s) {
        Vec3 index;
        for (std::size_t a = 0; a < 3; ++a)
          index[static_cast<Eigen::Index>(a)] = static_cast<double>(plane.origin[a] + plane.along[a] * line.rest_mm[s] +
                                                                    plane.across[a] * line.sigma_mm[s]);
        return index;
      },
      [&](const Vec3& index) { return X_PU * grid.to_mm(index); },
      [&](const Vec3& p_A) { return grid.to_index(X_UP * p_A); }, to_rest);
  for (std::size_t a = 0; a < 3; ++a) plane.to_rest[a] = to_rest[a].data();
}

}  // namespace

BeamPlanes make_beam_planes(int count) noexcept {
  // The outermost planes have a tenth of the central one's power: exp(-zeta^2) of the two-way profile's power.
  constexpr float kOutermost = 1.5F, kWidest = 1.2F;
  BeamPlanes planes;
  planes.count = std::clamp(count, 1, kMostLinePlanes);
  const float step =
      planes.count == 1 ? 0.0F : std::min(kWidest, 2.0F * kOutermost / static_cast<float>(planes.count - 1));
  float sum = 0.0F;
  for (int n = 0; n < planes.count; ++n) {
    const auto at = static_cast<std::size_t>(n);
    planes.zeta[at] = step * static_cast<float>(n - planes.count / 2);
    sum += planes.share[at] = std::exp(-planes.zeta[at] * planes.zeta[at]);
  }
  for (float& share : planes.share) share /= sum;
  return planes;
}

PanoramaMap make_panorama_map(const Panorama& panorama, const Pose& X_PT) noexcept {
  const Pose X_UT = panorama.X_PU.inverse() * X_PT;
  const volume::GridGeometry& grid = panorama.geometry;
  const Mat3 index_of_T = grid.spacing_mm.cwiseInverse().asDiagonal() * Mat3(grid.R_PV.transpose() * X_UT.R());
  PanoramaMap map;
  map.panorama = &panorama;
  for (std::size_t a = 0; a < 3; ++a)
    map.index_of_T[a] = single_precision(index_of_T.col(static_cast<Eigen::Index>(a)));
  map.index_of_origin = single_precision(grid.to_index(X_UT.p()));
  return map;
}

int weight_step(double sample_mm) noexcept {
  return std::clamp(static_cast<int>(kWeightStep_mm / sample_mm), 1, kWeightSteps);
}

int sample_stride(const Panorama& panorama, double sample_mm) noexcept {
  constexpr double kPerVoxel = 2.0;
  return panorama.geometry.spacing_mm.minCoeff() >= 2.0 * kPerVoxel * sample_mm * (1.0 - 1e-9) ? 2 : 1;
}

void expand_samples(const std::vector<float>& from, int stride, int samples, float* to) noexcept {
  if (stride == 1) {
    std::copy_n(from.begin(), samples, to);
    return;
  }
  const int pairs = samples / 2;
  const float* const values = from.data();
  for (int n = 0; n < pairs; ++n) {
    to[2 * n] = values[n];
    to[2 * n + 1] = 0.5F * (values[n] + values[n + 1]);
  }
  if (samples % 2 != 0) to[samples - 1] = values[pairs];
}

void PanoramaSamples::fit(int samples) {
  power.assign(static_cast<std::size_t>(samples + kReadAhead), 0.0F);
  weight = power;
  for (std::vector<float>& shift : to_rest) shift = power;
}

void sample_panorama(const PanoramaMap& map, const motion::PatientMotion& motion, const BeamPlanes& planes,
                     const PanoramaLine& line, PanoramaSamples& samples) noexcept {
  std::fill(samples.power.begin(), samples.power.end(), 0.0F);
  std::fill(samples.weight.begin(), samples.weight.end(), 0.0F);
  std::array<float, kMostWeights> weights;
  const int count = (line.samples + line.weight_step - 1) / line.weight_step + 1;
  // The outermost planes first: between two that are whole, the others are.
  bool is_within = planes.count > 2;
  for (int order = 0; order < planes.count; ++order) {
    const int n = order == 1 ? planes.count - 1 : std::max(order - 1, 0);
    const auto at = static_cast<std::size_t>(n);
    PlaneLine plane = plane_line(map, line, planes.zeta[at], planes.share[at]);
    if (!motion.is_rest()) move_plane(map, motion, line, samples.to_rest, plane);
    WeightRange range{1.0F, 1.0F};
    if (order < 2 || !is_within)
      range = HWY_DYNAMIC_DISPATCH(sample_weights)(plane, map.panorama->weights.data(), line, count, weights.data());
    if (order < 2) is_within = is_within && range.least >= kWhole;
    if (range.most == 0.0F) continue;
    HWY_DYNAMIC_DISPATCH(add_plane)
    (plane, map.panorama->levels.data(), line, weights.data(), range.least >= kWhole, samples.power.data(),
     samples.weight.data());
  }
  HWY_DYNAMIC_DISPATCH(finish)(line.samples, samples);
}

NearEnd find_near_end(const float* weight, int near_samples, int far_samples) noexcept {
  // The near field of the acquisition is bright: only what lies behind its first millimetres is continued.
  constexpr float kRisen = 0.99F, kKnown = 0.4F;
  NearEnd end;
  while (end.whole < far_samples && weight[end.whole] < kRisen) ++end.whole;
  if (end.whole >= far_samples) return {0, 0, 0.0F};
  end.known = end.whole;
  while (end.known > 0 && weight[end.known - 1] > kKnown) --end.known;
  const auto beyond = static_cast<float>(end.whole - near_samples);
  end.share = std::clamp(1.0F - beyond / static_cast<float>(std::max(far_samples - near_samples, 1)), 0.0F, 1.0F);
  return end;
}

void smooth_shares(const std::vector<NearEnd>& ends, int reach, std::vector<float>& working,
                   std::vector<float>& shares) noexcept {
  const auto lines = static_cast<int>(ends.size());
  const auto over = [&](int line, const auto& take) {
    for (int l = std::max(line - reach, 0); l <= std::min(line + reach, lines - 1); ++l)
      take(static_cast<std::size_t>(l));
  };
  for (int line = 0; line < lines; ++line) {
    float least = 1.0F;
    over(line, [&](std::size_t l) { least = std::min(least, ends[l].share); });
    working[static_cast<std::size_t>(line)] = least;
  }
  for (int line = 0; line < lines; ++line) {
    float sum = 0.0F;
    int count = 0;
    over(line, [&](std::size_t l) {
      sum += working[l];
      ++count;
    });
    shares[static_cast<std::size_t>(line)] = sum / static_cast<float>(count);
  }
}

void continue_to_face(const NearEnd& end, float share, int samples, float* power, float* weight) noexcept {
  for (int s = 0; s < end.whole; ++s) {
    const float own = weight[s], mirrored = power[std::clamp(2 * end.known - s, s, samples - 1)];
    weight[s] = std::lerp(own, 1.0F, share);
    if (weight[s] > 0.0F) power[s] = std::lerp(mirrored, power[s], own / weight[s]);
  }
}

}  // namespace trocar::ultrasound::detail
#endif
