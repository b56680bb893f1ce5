#include "ultrasound/engine/detail/tissue_walk.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ultrasound/engine/detail/tissue_walk.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which sets the instruction set that this header compiles for.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace trocar::ultrasound::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::ScalableTag<float>;
using I = hn::RebindToSigned<F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;

void place_samples(const ScanPlan& plan, const FrameState& frame, const LineWalk& line, float zeta,
                   WalkResult& result) {
  const F f;
  const I d;
  const volume::GridGeometry& grid = frame.scene->geometry;
  // Offset in the tiles: (index / 4) * stride + (index % 4) * step per axis.
  const std::int32_t stride[3] = {TiledTissue::kTile, frame.tiles.row(), frame.tiles.slab()};
  const std::int32_t step[3] = {1, 4, 16};
  const VF zeta_v = hn::Set(f, zeta);
  const VF pressed = hn::Set(f, -line.pressed_mm);
  const VF mm = hn::Set(f, plan.sample_mm);
  const bool has_mirror = line.has_mirror();
  const bool is_moving = !frame.motion.is_rest();
  for (int s = 0; s < plan.samples; s += static_cast<int>(hn::Lanes(f))) {
    const VF at = hn::Iota(f, static_cast<float>(s) + 0.5F);
    const VF along = hn::MulAdd(pressed, hn::LoadU(f, frame.contact_shape.data() + s), hn::Mul(at, mm));
    const VF elevation = hn::Mul(zeta_v, hn::LoadU(f, plan.elevation_sigma_mm.data() + s));
    const VF sideways = hn::Load(f, result.sideways_mm.data() + s);
    VF behind = hn::Zero(f);
    if (has_mirror) {
      behind = hn::MulAdd(along, hn::Set(f, line.mirror[1]), hn::Set(f, line.mirror[0]));
      behind = hn::MulAdd(elevation, hn::Set(f, line.mirror[2]), behind);
      behind = hn::Max(hn::MulAdd(sideways, hn::Set(f, line.mirror[3]), behind), hn::Zero(f));
    }
    VI cell = hn::Zero(d);
    auto inside = hn::FirstN(f, hn::Lanes(f));
    for (std::size_t a = 0; a < 3; ++a) {
      VF index = hn::MulAdd(along, hn::Set(f, line.along[a]), hn::Set(f, line.origin[a]));
      index = hn::MulAdd(elevation, hn::Set(f, frame.elevation[a]), index);
      index = hn::MulAdd(sideways, hn::Set(f, line.lateral[a]), index);
      index = hn::NegMulAdd(behind, hn::Set(f, line.mirror_normal[a]), index);
      if (is_moving) index = hn::Add(index, hn::Load(f, result.to_rest[a].data() + s));
      const float last = static_cast<float>(grid.size[a] - 1);
      inside = hn::And(inside, hn::And(hn::Gt(index, hn::Set(f, -0.5F)), hn::Lt(index, hn::Set(f, last + 0.5F))));
      const VF clamped = hn::Min(hn::Max(index, hn::Zero(f)), hn::Set(f, last - 1e-3F));
      hn::Store(clamped, f, result.index[a].data() + s);
      const VI voxel = hn::ConvertTo(d, clamped);
      cell = hn::Add(cell, hn::Mul(hn::ShiftRight<2>(voxel), hn::Set(d, stride[a])));
      cell = hn::Add(cell, hn::Mul(hn::And(voxel, hn::Set(d, 3)), hn::Set(d, step[a])));
    }
    hn::Store(hn::IfThenElse(hn::RebindMask(d, inside), cell, hn::Set(d, -1)), d, result.cell.data() + s);
  }
}

/// Values that change evenly: first + step / 2, first + 3 step / 2 …
void fill_evenly(float first, float step, int n, float* to) {
  const F f;
  const auto lanes = static_cast<int>(hn::Lanes(f));
  for (int s = 0; s < n; s += lanes) {
    const VF value = hn::MulAdd(hn::Iota(f, static_cast<float>(s) + 0.5F), hn::Set(f, step), hn::Set(f, first));
    if (n - s >= lanes)
      hn::StoreU(value, f, to + s);
    else
      hn::BlendedStore(value, hn::FirstN(f, static_cast<std::size_t>(n - s)), f, to + s);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace trocar::ultrasound::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trocar::ultrasound::detail {

HWY_EXPORT(place_samples);
HWY_EXPORT(fill_evenly);

void place_line(const ScanPlan& plan, const FrameState& frame, const LineWalk& line, float zeta,
                WalkResult& result) noexcept {
  if (!frame.motion.is_rest()) find_rest(plan, frame, line, zeta, result);
  HWY_DYNAMIC_DISPATCH(place_samples)(plan, frame, line, zeta, result);
}

Blend blend_at(const FrameState& frame, const std::array<TissueRow, kTissues>& rows, float i, float j,
               float k) noexcept {
  const auto& size = frame.scene->geometry.size;
  const auto within = [](float v, std::int64_t n) { return std::clamp(v, 0.0F, static_cast<float>(n - 1) - 1e-3F); };
  const CellCorners corners = corners_at(frame.tiles, within(i, size[0]), within(j, size[1]), within(k, size[2]));
  using Row = Eigen::Array4f;
  static_assert(sizeof(TissueRow) == sizeof(Row));
  Row sum = Row::Zero();
  for (std::size_t n = 0; n < 8; ++n) {
    const auto tissue = static_cast<std::size_t>(frame.tiles.tissue(corners.offset[n]) & ~kMixedCell);
    sum += corners.weight[n] * Eigen::Map<const Row, Eigen::Aligned16>(&rows[tissue].log_z);
  }
  Blend blend{};
  Eigen::Map<Row, Eigen::Aligned16>(&blend.row.log_z) = sum;
  blend.tissue = static_cast<std::uint8_t>(frame.tiles.tissue(corners.offset[corners.nearest]) & ~kMixedCell);
  return blend;
}

Vec3 impedance_slope(const FrameState& frame, const std::array<TissueRow, kTissues>& rows, const Vec3& index) noexcept {
  // The corners of a tetrahedron: four samples instead of six.
  constexpr double kReach = 0.87;  // voxels along each axis, 1.5 from the centre
  const Vec3 corners[4] = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  Vec3 slope = Vec3::Zero();
  for (const Vec3& corner : corners) {
    const Vec3f p = (index + kReach * corner).cast<float>();
    slope += static_cast<double>(blend_at(frame, rows, p.x(), p.y(), p.z()).row.log_z) * corner;
  }
  return (slope / (4.0 * kReach)).cwiseQuotient(frame.scene->geometry.spacing_mm);
}

namespace {

constexpr int kWalkBlock = 16;
constexpr float kSilence = -60.0F;  // neper
/// Organs have capsules: minimum reflection of a border, even between tissues of equal impedance (assumed).
constexpr float kWrapping = 0.03F;
/// If the volume has air at the face, tissue up to this distance is reached through coupling gel.
constexpr float kEntry_mm = 5.0F;

/// Reflected amplitude for an increase of the impedance's logarithm: tanh(rise / 2). A series suffices for most
/// borders.
float reflection_of(float rise) noexcept {
  constexpr float kSmall = 0.1F;
  const float half = 0.5F * rise;
  return std::abs(half) < kSmall ? half * (1.0F - half * half / 3.0F) : std::tanh(half);
}

/// The transmitted intensity is 1 - R^2 for each direction; its logarithm.
float log_passed(float reflection) noexcept {
  constexpr float kSmall = 0.01F;
  const float lost = reflection * reflection;
  return lost < kSmall ? -lost * (1.0F + 0.5F * lost) : std::log(std::max(1.0F - lost, 1e-4F));
}

/// Computes the walk along one scanline.
class Walk {
 public:
  Walk(const ScanPlan& plan, const FrameState& frame, const LineWalk& line, float zeta, int reach, WalkResult& result,
       float* delay) noexcept
      : plan_(plan), frame_(frame), line_(line), result_(result), delay_(delay) {
    log_gain_ = 2.0F * std::log(std::max(line.coupling, 1e-6F));
    entry_samples_ = static_cast<int>(kEntry_mm / plan.sample_mm);
    reach_ = std::max(reach, entry_samples_);
    constexpr double kBlends = 2.5;  // per voxel
    const double voxel_samples =
        frame.scene->geometry.spacing_mm.minCoeff() / static_cast<double>(plan.sample_mm) / kBlends;
    blend_step_ = std::clamp(static_cast<int>(voxel_samples + 0.5), 1, 8);
    if (line.has_mirror()) stand_mirror(zeta);
  }

  void run() noexcept {
    result_.border_count = 0;
    result_.audible = plan_.samples;
    int s = 0;
    while (s < plan_.samples) {
      if (log_gain_ < kInaudible && s >= reach_) return fall_silent(s);
      const int same = s >= entry_samples_ ? same_tissue(s) : 0;
      if (same > 0)
        step_same(s, same);
      else
        step(s);
      s += std::max(same, 1);
    }
    finish_ramp();
  }

 private:
  /// Ends the scanline: the rest is in shadow.
  void fall_silent(int s) noexcept {
    const auto left = static_cast<std::size_t>(plan_.samples - s);
    std::fill_n(result_.log_gain.begin() + s, left, kSilence);
    std::fill_n(result_.tissue.begin() + s, left, kNoData);
    std::fill_n(result_.share.begin() + s, left, plan_.share[kNoData]);
    std::fill_n(result_.path_loss.begin() + s, left, kSilence);
    if (delay_ != nullptr) std::fill_n(delay_ + s, left, late_);
    result_.audible = s;
  }

  /// Samples around the mirror on this plane, where the walk reverses within the mixed cells of the border.
  void stand_mirror(float zeta) noexcept {
    const auto near = static_cast<std::size_t>(
        std::clamp(line_.mirror_depth_mm / plan_.sample_mm, 0.0F, static_cast<float>(plan_.samples - 1)));
    const float elevation_mm = zeta * plan_.elevation_sigma_mm[near];
    const float along_mm =
        -(line_.mirror[0] + line_.mirror[2] * elevation_mm + line_.mirror[3] * result_.sideways_mm[near]) /
        line_.mirror[1];
    const float walk = (along_mm + line_.pressed_mm * frame_.contact_shape[near]) / plan_.sample_mm - 0.5F;
    const auto spacing_mm = static_cast<float>(frame_.scene->geometry.spacing_mm.maxCoeff());
    const float reach = 1.8F * spacing_mm / line_.mirror[1] / plan_.sample_mm;
    mirror_from_ = static_cast<int>(walk - reach);
    mirror_at_ = static_cast<int>(walk);
    mirror_to_ = static_cast<int>(walk + reach) + 1;
  }

  /// Near the mirror: the tissue in front of it, and the mirror at its centre.
  void step_at_mirror(int s) noexcept {
    if (is_in_ramp_) finish_ramp();
    const std::uint8_t tissue = settled_ == kNoData ? line_.mirror_before : settled_;
    const TissueRow& row = plan_.rows[tissue];
    pass(s, tissue, row);
    tissue_ = settled_ = tissue;
    log_z_ = row.log_z;
    if (s != mirror_at_) return;
    if (result_.border_count < kMaxBorders)
      result_.borders[static_cast<std::size_t>(result_.border_count++)] = {
          static_cast<float>(s), line_.mirror_reflection, log_gain_, place_of(static_cast<float>(s)), tissue,
          line_.mirror_behind};
    log_gain_ += std::log(std::max(line_.mirror_gain, 1e-6F));
  }

  /// Number of the next samples in whole cells of the present tissue, up to where the scanline falls silent.
  int same_tissue(int s) const noexcept {
    if (is_in_ramp_ || tissue_ == kNoData) return 0;
    if (s >= mirror_from_ && s < mirror_to_) return 0;
    const int end = std::min(s < mirror_from_ ? std::min(mirror_from_, plan_.samples) : plan_.samples, silence(s));
    // A tile is as wide as several blocks: mostly a single-tissue tile contains the whole block.
    constexpr int kAhead = 16;  // samples: a part of a tile
    const std::int32_t* const cells = result_.cell.data();
    const auto is_whole = [&](int n) { return cells[n] >= 0 && frame_.tiles.tile_tissue(cells[n]) == tissue_; };
    int n = s;
    while (n + kWalkBlock <= end && is_whole(n) && is_whole(n + 5) && is_whole(n + 10) && is_whole(n + 15))
      n += kWalkBlock;
    for (; n < end && cells[n] >= 0 && frame_.tiles.tissue(cells[n]) == tissue_; ++n)
      if (n % kAhead == 0) frame_.tiles.prefetch(cells[n + kAhead]);
    return n - s;
  }

  /// Sample from which on the present tissue leaves nothing that returns, behind the reach of sound from the sides.
  int silence(int s) const noexcept {
    const float loss = plan_.rows[tissue_].loss;
    const float left = log_gain_ - kInaudible;
    if (!(left < loss * static_cast<float>(plan_.samples))) return plan_.samples;
    return std::max(reach_, s + 1 + static_cast<int>(left / loss));
  }

  /// `n` samples of the present tissue.
  void step_same(int s, int n) noexcept {
    const TissueRow& row = plan_.rows[tissue_];
    const auto at = static_cast<std::size_t>(s);
    const auto fill = HWY_DYNAMIC_DISPATCH(fill_evenly);
    fill(log_gain_ + row.log_b, -row.loss, n, result_.log_gain.data() + at);
    fill(log_gain_, -row.loss, n, result_.path_loss.data() + at);
    std::fill_n(result_.tissue.begin() + s, n, tissue_);
    std::fill_n(result_.share.begin() + s, n, plan_.share[tissue_]);
    log_gain_ -= row.loss * static_cast<float>(n);
    if (delay_ == nullptr) return;
    fill(late_, row.delay, n, delay_ + s);
    late_ += row.delay * static_cast<float>(n);
  }

  /// One sample of a tissue, or of a blend.
  void pass(int s, std::uint8_t tissue, const TissueRow& row) noexcept {
    const auto at = static_cast<std::size_t>(s);
    const float way = log_gain_ - 0.5F * row.loss;
    result_.tissue[at] = tissue;
    result_.share[at] = plan_.share[tissue];
    result_.log_gain[at] = row.log_b + way;
    log_gain_ -= row.loss;
    result_.path_loss[at] = way;
    if (delay_ == nullptr) return;
    delay_[s] = late_ + 0.5F * row.delay;
    late_ += row.delay;
  }

  void step(int s) noexcept {
    if (s >= mirror_from_ && s < mirror_to_) return step_at_mirror(s);
    const auto at = static_cast<std::size_t>(s);
    const auto& rows = s < entry_samples_ && !is_entered_ ? plan_.entry_rows : plan_.rows;
    const std::int32_t cell = result_.cell[at];
    std::uint8_t tissue = kNoData;
    TissueRow row = rows[kNoData];
    bool is_mixed = false;
    if (cell >= 0) {
      const std::uint8_t voxel = frame_.tiles.tissue(cell);
      if ((voxel & kMixedCell) == 0) {
        tissue = voxel;
        row = rows[tissue];
      } else {
        // A voxel is several samples long: within a border every second or third sample suffices.
        if (!was_blended_ || s % blend_step_ == 0)
          blend_ = blend_at(frame_, rows, result_.index[0][at], result_.index[1][at], result_.index[2][at]);
        tissue = blend_.tissue;
        row = blend_.row;
        is_mixed = true;
      }
    }
    was_blended_ = is_mixed;
    if (tissue != 0 && !is_mixed) is_entered_ = true;
    meet(s, tissue, row, is_mixed);
    pass(s, tissue, row);
  }

  /// Borders are impedance ramps over one or two voxels; each becomes one border at its centre.
  void meet(int s, std::uint8_t tissue, const TissueRow& row, bool is_mixed) noexcept {
    if (tissue == kNoData || tissue_ == kNoData) {
      is_in_ramp_ = false;
      tissue_ = tissue;
      log_z_ = row.log_z;
      if (!is_mixed) settled_ = tissue;
      return;
    }
    const float rise = row.log_z - log_z_;
    if (rise != 0.0F || is_mixed) {
      if (!is_in_ramp_) begin_ramp(s);
      const float size = std::abs(rise);
      if (rise > 0.0F) {
        up_ += rise;
        up_at_ += size * (static_cast<float>(s) - 0.5F);
      } else {
        down_ += rise;
        down_at_ += size * (static_cast<float>(s) - 0.5F);
      }
      ramp_end_ = s;
      most_ = std::max(most_, size);
    }
    log_z_ = row.log_z;
    tissue_ = tissue;
    if (!is_mixed) {
      behind_ = tissue;
      finish_ramp();
      settled_ = tissue;
    }
  }

  void begin_ramp(int s) noexcept {
    is_in_ramp_ = true;
    ramp_begin_ = s;
    up_ = down_ = up_at_ = down_at_ = most_ = 0.0F;
    behind_ = settled_;
    // A border's echo has the losses of the tissue in front of it, not those of an absorber within its own ramp.
    ramp_log_gain_ = log_gain_;
  }

  void finish_ramp() noexcept {
    if (!is_in_ramp_) return;
    is_in_ramp_ = false;
    constexpr float kNothing = 2e-3F;
    const bool has_up = up_ > kNothing, has_down = -down_ > kNothing;
    const float up_at = has_up ? up_at_ / up_ : 0.0F, down_at = has_down ? down_at_ / -down_ : 0.0F;
    if (has_up && has_down && up_at < down_at) {
      add_border(up_at, reflection_of(up_));
      add_border(down_at, reflection_of(down_));
    } else {
      if (has_down) add_border(down_at, reflection_of(down_));
      if (has_up) add_border(up_at, reflection_of(up_));
    }
    if (!has_up && !has_down && behind_ != settled_)
      add_border(0.5F * static_cast<float>(ramp_begin_ + ramp_end_), kWrapping);
  }

  void add_border(float walk, float reflection) noexcept {
    if (result_.border_count < kMaxBorders) {
      const float size = std::max(std::abs(reflection), behind_ != settled_ ? kWrapping : 0.0F);
      result_.borders[static_cast<std::size_t>(result_.border_count++)] = {
          walk, std::copysign(size, reflection), ramp_log_gain_, place_of(walk), settled_, behind_};
    }
    const float passed = log_passed(reflection);
    ramp_log_gain_ += passed;
    if (plan_.acquisition.artefacts.attenuation) log_gain_ += passed;
  }

  std::array<float, 3> place_of(float walk) const noexcept {
    const auto at = static_cast<std::size_t>(std::clamp(walk, 0.0F, static_cast<float>(plan_.samples - 1)));
    return {result_.index[0][at], result_.index[1][at], result_.index[2][at]};
  }

  const ScanPlan& plan_;
  const FrameState& frame_;
  const LineWalk& line_;
  WalkResult& result_;
  float* delay_;
  float log_gain_ = 0.0F;
  int mirror_from_ = kMaxSamples * 4, mirror_at_ = -1, mirror_to_ = -1;
  float late_ = 0.0F;
  int entry_samples_ = 0, reach_ = 0, blend_step_ = 1;
  bool is_entered_ = false;
  bool was_blended_ = false;
  Blend blend_{};

  std::uint8_t tissue_ = kNoData;   ///< Of the last sample.
  std::uint8_t settled_ = kNoData;  ///< Tissue of the last whole cell.
  std::uint8_t behind_ = kNoData;
  float log_z_ = 0.0F;
  bool is_in_ramp_ = false;
  int ramp_begin_ = 0, ramp_end_ = 0;
  float ramp_log_gain_ = 0.0F;
  float up_ = 0.0F, down_ = 0.0F, up_at_ = 0.0F, down_at_ = 0.0F, most_ = 0.0F;
};

}  // namespace

void walk_line(const ScanPlan& plan, const FrameState& frame, const LineWalk& line, float zeta, int reach,
               WalkResult& result, float* delay) noexcept {
  place_line(plan, frame, line, zeta, result);
  Walk(plan, frame, line, zeta, reach, result, delay).run();
}

void store_borders(FrameState& frame, const WalkResult& result, int row) noexcept {
  const auto at = static_cast<std::size_t>(row);
  for (std::size_t b = 0; b < static_cast<std::size_t>(result.border_count); ++b) {
    const Border& border = result.borders[b];
    frame.borders[at * kMaxBorders + b] = border;
    frame.border_keys[at * kMaxBorders + b] = {border.walk, tissues_of(border)};
  }
  frame.border_counts[at] = static_cast<std::uint8_t>(result.border_count);
}

void store_borders_between(FrameState& frame, int from, int other, int row) noexcept {
  constexpr float kReach = 16.0F;  // samples
  const auto borders_of = [&](int of) { return frame.borders.data() + static_cast<std::size_t>(of) * kMaxBorders; };
  const auto count_of = [&](int of) -> std::uint8_t& { return frame.border_counts[static_cast<std::size_t>(of)]; };
  count_of(row) = count_of(from);
  for (std::size_t b = 0; b < count_of(row); ++b) {
    Border border = borders_of(from)[b];
    const Border* same = nullptr;
    float nearest = kReach;
    for (std::size_t n = 0; n < count_of(other); ++n) {
      const Border& next = borders_of(other)[n];
      const float far = std::abs(next.walk - border.walk);
      if (far >= nearest || tissues_of(next) != tissues_of(border)) continue;
      nearest = far;
      same = &next;
    }
    if (same != nullptr) {
      border.walk = 0.5F * (border.walk + same->walk);
      for (std::size_t a = 0; a < 3; ++a) border.index[a] = 0.5F * (border.index[a] + same->index[a]);
    }
    borders_of(row)[b] = border;
    frame.border_keys[static_cast<std::size_t>(row) * kMaxBorders + b] = {border.walk, tissues_of(border)};
  }
}

}  // namespace trocar::ultrasound::detail
#endif
