#include "ultrasound/detail/scatterer_bricks.h"

#include <algorithm>
#include <cmath>

#include "core/random.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ultrasound/detail/scatterer_bricks.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which sets the instruction set that these headers compile for.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#ifndef TROCAR_ULTRASOUND_BRICK_TYPES
#define TROCAR_ULTRASOUND_BRICK_TYPES
namespace trocar::detail {

/// A brick as it lies in T: middle + x * scatterer.x + y * scatterer.y + z * scatterer.z.
struct PlacedBrick {
  float middle[3], x[3], y[3], z[3];
  const Brick* brick;
};

/// The scanlines and resting depths that a task looks for scatterers in.
struct Cell {
  int first_line, last_line;
  float first_rest, last_rest;
};

/// Echoes of one brick, compact.
struct alignas(64) Echoes {
  float line[kBrickScatterers], sample[kBrickScatterers], re[kBrickScatterers], im[kBrickScatterers];
  float rank[kBrickScatterers];
  std::int32_t place[kBrickScatterers];
};

}  // namespace trocar::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace trocar::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::ScalableTag<float>;
using I = hn::RebindToSigned<F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;

HWY_INLINE VF axis_of(const PlacedBrick& brick, int a, VF x, VF y, VF z) {
  const F f;
  const VF far = hn::MulAdd(hn::Set(f, brick.z[a]), z, hn::Set(f, brick.middle[a]));
  return hn::MulAdd(hn::Set(f, brick.x[a]), x, hn::MulAdd(hn::Set(f, brick.y[a]), y, far));
}

/// arctan for |t| <= 1.2; Taylor-like minimax, error below 1e-4 rad where fans are.
HWY_INLINE VF arctan(VF t) {
  const F f;
  const VF t2 = hn::Mul(t, t);
  VF p = hn::Set(f, -0.01172120F);
  p = hn::MulAdd(p, t2, hn::Set(f, 0.05265332F));
  p = hn::MulAdd(p, t2, hn::Set(f, -0.11643287F));
  p = hn::MulAdd(p, t2, hn::Set(f, 0.19354346F));
  p = hn::MulAdd(p, t2, hn::Set(f, -0.33262347F));
  p = hn::MulAdd(p, t2, hn::Set(f, 0.99997726F));
  return hn::Mul(p, t);
}

/// cos and sin of a number of cycles.
HWY_INLINE void turn(VF cycles, VF& cosine, VF& sine) {
  const F f;
  const VF part = hn::Mul(hn::Set(f, 6.28318531F), hn::Sub(cycles, hn::Round(cycles)));  // -pi..pi
  cosine = hn::Cos(f, part);
  sine = hn::Sin(f, part);
}

HWY_INLINE void drag_along(const Drag& drag, VF& x, VF& y, VF& z) {
  const F f;
  const VF dx = hn::Sub(x, hn::Set(f, drag.tip_T.x()));
  const VF dy = hn::Sub(y, hn::Set(f, drag.tip_T.y()));
  const VF dz = hn::Sub(z, hn::Set(f, drag.tip_T.z()));
  const VF r2 = hn::MulAdd(dx, dx, hn::MulAdd(dy, dy, hn::Mul(dz, dz)));
  const VF falls = hn::Exp(f, hn::Mul(r2, hn::Set(f, -4.0F / (drag.reach_mm * drag.reach_mm))));
  x = hn::MulAdd(falls, hn::Set(f, drag.shift_T.x()), x);
  y = hn::MulAdd(falls, hn::Set(f, drag.shift_T.y()), y);
  z = hn::MulAdd(falls, hn::Set(f, drag.shift_T.z()), z);
}

/// Where along the scanline that resting tissue lies now: walk = rest + pressed * shape(walk), two rounds.
HWY_INLINE VF walk_of_rest(const ScanPlan& plan, VF rest, VF pressed_samples) {
  const F f;
  const I d;
  const VF last = hn::Set(f, static_cast<float>(plan.samples - 1));
  VF walk = rest;
  for (int round = 0; round < 3; ++round) {
    const VI at = hn::ConvertTo(d, hn::Min(hn::Max(walk, hn::Zero(f)), last));
    walk = hn::MulAdd(pressed_samples, hn::GatherIndex(f, plan.contact_shape.data(), at), rest);
  }
  return walk;
}

int echoes_of(const ScanPlan& plan, const FrameState& frame, const float* pressed_samples, const Cell& cell,
              const PlacedBrick& placed, bool is_dragged, Echoes& echoes) {
  const F f;
  const I d;
  const ScanGeometry& g = plan.geometry;
  const VF radius = hn::Set(f, static_cast<float>(g.radius_mm));
  const VF per_line = hn::Set(f, static_cast<float>(1.0 / g.line_step));
  const VF middle = hn::Set(f, static_cast<float>(g.middle_line()));
  const VF per_mm = hn::Set(f, 1.0F / plan.sample_mm);
  const VF last_sample = hn::Set(f, static_cast<float>(plan.samples - 1));
  const VF last_line = hn::Set(f, static_cast<float>(plan.lines - 1));
  const VI samples = hn::Set(d, plan.samples);
  const auto coarse = static_cast<std::int32_t>(plan.coarse_samples());
  int n = 0;
  for (std::size_t s = 0; s < kBrickScatterers; s += hn::Lanes(f)) {
    const VF bx = hn::Load(f, placed.brick->x.data() + s);
    const VF by = hn::Load(f, placed.brick->y.data() + s);
    const VF bz = hn::Load(f, placed.brick->z.data() + s);
    VF x = axis_of(placed, 0, bx, by, bz);
    VF y = axis_of(placed, 1, bx, by, bz);
    VF z = axis_of(placed, 2, bx, by, bz);
    if (is_dragged) drag_along(frame.drag, x, y, z);

    VF line, rest;
    if (g.is_fan) {
      const VF from_apex = hn::Add(y, radius);
      line = hn::MulAdd(arctan(hn::Div(x, hn::Max(from_apex, hn::Set(f, 1e-3F)))), per_line, middle);
      rest = hn::Mul(hn::Sub(hn::Sqrt(hn::MulAdd(x, x, hn::Mul(from_apex, from_apex))), radius), per_mm);
    } else {
      line = hn::MulAdd(x, per_line, middle);
      rest = hn::Mul(y, per_mm);
    }
    rest = hn::Sub(rest, hn::Set(f, 0.5F));  // samples lie at (s + 1/2)
    auto heard = hn::And(hn::Ge(rest, hn::Set(f, cell.first_rest)), hn::Lt(rest, hn::Set(f, cell.last_rest)));
    const VI near_line = hn::ConvertTo(d, hn::Min(hn::Max(hn::Round(line), hn::Zero(f)), last_line));
    const VF walk = walk_of_rest(plan, rest, hn::GatherIndex(f, pressed_samples, near_line));
    heard = hn::And(heard, hn::And(hn::Ge(walk, hn::Zero(f)), hn::Le(walk, last_sample)));
    if (hn::AllFalse(f, heard)) continue;
    const VI at = hn::ConvertTo(d, hn::Min(hn::Max(walk, hn::Zero(f)), last_sample));
    const VI at_coarse = hn::Add(hn::Mul(near_line, hn::Set(d, coarse)), hn::ShiftRight<3>(at));
    static_assert(kCoarse == 8);
    const VF depth_mm = hn::Mul(walk, hn::Set(f, plan.sample_mm));
    const VF spacing_mm = g.is_fan ? hn::Mul(hn::Add(depth_mm, radius), hn::Set(f, static_cast<float>(g.line_step)))
                                   : hn::Set(f, static_cast<float>(g.line_step));
    line = hn::Sub(
        line, hn::Div(hn::GatherIndex(f, frame.bend_mm.data(), at_coarse), hn::Max(spacing_mm, hn::Set(f, 0.02F))));
    heard = hn::And(heard, hn::And(hn::Ge(line, hn::Set(f, static_cast<float>(cell.first_line - 1))),
                                   hn::Lt(line, hn::Set(f, static_cast<float>(cell.last_line)))));
    const VF zeta = hn::Mul(z, hn::GatherIndex(f, plan.inverse_elevation_sigma.data(), at));
    heard = hn::And(heard, hn::Lt(hn::Abs(zeta), hn::Set(f, kBeamEdge)));
    if (hn::AllFalse(f, heard)) continue;

    const VI line_index = hn::ConvertTo(d, hn::Min(hn::Max(hn::Round(line), hn::Zero(f)), last_line));
    const VF plane = hn::Round(
        hn::MulAdd(zeta, hn::Set(f, 1.0F / plan.plane_step), hn::Set(f, static_cast<float>(plan.planes / 2))));
    const VI plane_index =
        hn::ConvertTo(d, hn::Min(hn::Max(plane, hn::Zero(f)), hn::Set(f, static_cast<float>(plan.planes - 1))));
    const VI in_line = hn::Add(hn::Mul(line_index, samples), at);
    const VI place = hn::Add(in_line, hn::Mul(plane_index, hn::Set(d, plan.lines * plan.samples)));
    const VF shown = hn::Add(walk, hn::GatherIndex(f, frame.delay.data(), in_line));
    const VF weight = hn::Mul(hn::Exp(f, hn::Mul(hn::Mul(zeta, zeta), hn::Set(f, -0.5F))),
                              hn::GatherIndex(f, plan.speckle_scale.data(), at));
    const VF amplitude = hn::Mul(hn::Mul(hn::Load(f, placed.brick->amplitude.data() + s), weight),
                                 hn::GatherIndex(f, frame.gain.data(), place));
    VF cosine, sine;
    turn(hn::Mul(shown, hn::Set(f, plan.cycles_per_sample)), cosine, sine);
    heard = hn::And(heard, hn::Le(shown, last_sample));
    hn::CompressStore(line, heard, f, echoes.line + n);
    hn::CompressStore(shown, heard, f, echoes.sample + n);
    hn::CompressStore(hn::Mul(amplitude, cosine), heard, f, echoes.re + n);
    hn::CompressStore(hn::Neg(hn::Mul(amplitude, sine)), heard, f, echoes.im + n);
    hn::CompressStore(hn::Load(f, placed.brick->rank.data() + s), heard, f, echoes.rank + n);
    n += static_cast<int>(hn::CompressStore(place, hn::RebindMask(d, heard), d, echoes.place + n));
  }
  return n;
}

}  // namespace HWY_NAMESPACE
}  // namespace trocar::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trocar::detail {

HWY_EXPORT(echoes_of);

std::vector<Brick> make_brick_library() {
  constexpr std::uint64_t kSeed = 0x7573;
  Random random(kSeed);
  std::vector<Brick> library(kBricks);
  for (Brick& brick : library) {
    for (std::size_t s = 0; s < kBrickScatterers; ++s) {
      brick.x[s] = static_cast<float>(random.uniform() - 0.5);
      brick.y[s] = static_cast<float>(random.uniform() - 0.5);
      brick.z[s] = static_cast<float>(random.uniform() - 0.5);
      brick.amplitude[s] = static_cast<float>(random.uniform(-1.0, 1.0));
      brick.rank[s] = static_cast<float>(random.uniform(0.0, 255.0));
    }
  }
  return library;
}

namespace {

using Index = std::array<std::int32_t, 3>;

std::uint64_t hash_of(const Index& brick) noexcept {
  const auto part = [&](std::size_t a, int shift) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(brick[a]) & 0x1fffffU) << shift;
  };
  return mix64(part(0, 0) | part(1, 21) | part(2, 42));
}

/// The brick of that place in the lattice: which of the library, its axes exchanged and mirrored.
PlacedBrick place(const Index& index, const std::vector<Brick>& library, const Vec3f& middle_T,
                  const Eigen::Matrix3f& side_T) {
  constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  const std::uint64_t hash = hash_of(index);
  const int* order = kOrders[(hash >> 16) % 6];
  PlacedBrick placed{};
  placed.brick = &library[hash % library.size()];
  float* const columns[3] = {placed.x, placed.y, placed.z};
  for (int c = 0; c < 3; ++c) {
    const float sign = ((hash >> (32 + c)) & 1U) != 0 ? -1.0F : 1.0F;
    for (int a = 0; a < 3; ++a) columns[c][a] = sign * side_T(a, order[c]);
  }
  for (int a = 0; a < 3; ++a) placed.middle[a] = middle_T[a];
  return placed;
}

void splat(const ScanPlan& plan, const Echoes& echoes, int n, const Cell& cell, FrameState& frame) noexcept {
  for (int e = 0; e < n; ++e) {
    if (echoes.rank[e] > static_cast<float>(frame.share[static_cast<std::size_t>(echoes.place[e])])) continue;
    const float floor_line = std::floor(echoes.line[e]);
    const float part = echoes.line[e] - floor_line;
    const int line = static_cast<int>(floor_line);
    const int sample = static_cast<int>(echoes.sample[e] + 0.5F);
    if (sample < -kPad / 2) continue;
    const std::ptrdiff_t at = static_cast<std::ptrdiff_t>(line) * plan.stride + kPad + sample;
    if (line >= cell.first_line) {
      frame.re[static_cast<std::size_t>(at)] += (1.0F - part) * echoes.re[e];
      frame.im[static_cast<std::size_t>(at)] += (1.0F - part) * echoes.im[e];
    }
    if (line + 1 < cell.last_line) {
      frame.re[static_cast<std::size_t>(at + plan.stride)] += part * echoes.re[e];
      frame.im[static_cast<std::size_t>(at + plan.stride)] += part * echoes.im[e];
    }
  }
}

/// Bricks of a cell: those of the box in P around its corners that come near it.
struct CellBox {
  Index low, high;
  float half_thickness_mm;
};

CellBox box_of(const ScanPlan& plan, const FrameState& frame, const Cell& cell) noexcept {
  const double margin_lines = 1.0 + static_cast<double>(frame.widest_warp);
  const auto sample_of = [&](float s) {
    return static_cast<std::size_t>(std::clamp(s, 0.0F, static_cast<float>(plan.samples - 1)));
  };
  const float thick =
      std::max(plan.elevation_sigma_mm[sample_of(cell.first_rest)], plan.elevation_sigma_mm[sample_of(cell.last_rest)]);
  CellBox box{};
  box.half_thickness_mm = kBeamEdge * thick;
  Vec3 low = Vec3::Constant(1e30), high = Vec3::Constant(-1e30);
  for (const double line :
       {static_cast<double>(cell.first_line) - margin_lines, 0.5 * (cell.first_line + cell.last_line),
        static_cast<double>(cell.last_line) + margin_lines}) {
    for (const float rest : {cell.first_rest, cell.last_rest}) {
      const Vec2 p = plan.geometry.to_cartesian({line, (rest + 0.5) * plan.sample_mm});
      for (const double z : {-box.half_thickness_mm, box.half_thickness_mm}) {
        const Vec3 p_P = frame.X_PT * Vec3(p.x(), p.y(), z);
        low = low.cwiseMin(p_P);
        high = high.cwiseMax(p_P);
      }
    }
  }
  const double reach_mm = frame.drag.reach_mm > 0.0F ? frame.drag.shift_T.norm() : 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    box.low[a] = static_cast<std::int32_t>(std::floor((low[axis] - reach_mm) / plan.brick_mm));
    box.high[a] = static_cast<std::int32_t>(std::floor((high[axis] + reach_mm) / plan.brick_mm));
  }
  return box;
}

/// Whether a brick of that middle can hold a scatterer of the cell.
bool comes_near(const ScanPlan& plan, const FrameState& frame, const Cell& cell, const CellBox& box,
                const Vec3f& middle_T, float radius_mm) noexcept {
  if (std::abs(middle_T.z()) > box.half_thickness_mm + radius_mm) return false;
  const Polar at = plan.geometry.to_polar(Vec2(middle_T.x(), middle_T.y()));
  const double margin_lines =
      1.0 + frame.widest_warp + radius_mm / std::max(plan.geometry.line_spacing_mm(std::max(at.depth_mm, 0.0)), 0.02);
  const double radius = radius_mm / plan.sample_mm + 1.0;
  const double rest = at.depth_mm / plan.sample_mm;
  return at.line > cell.first_line - margin_lines && at.line < cell.last_line + margin_lines &&
         rest > cell.first_rest - radius && rest < cell.last_rest + radius;
}

}  // namespace

void add_scatterers(const ScanPlan& plan, const std::vector<Brick>& library, FrameState& frame, int first,
                    int last) noexcept {
  const Pose X_TP = frame.X_PT.inverse();
  const Eigen::Matrix3f side_T = (X_TP.R() * static_cast<double>(plan.brick_mm)).cast<float>();
  const float drag_reach_mm = frame.drag.reach_mm;
  const float radius_mm = 0.87F * plan.brick_mm + (drag_reach_mm > 0.0F ? frame.drag.shift_T.norm() : 0.0F);
  const float deepest = frame.deepest_dent_mm / plan.sample_mm;
  const float segment = 12.0F / plan.sample_mm;
  const auto per_call = HWY_DYNAMIC_DISPATCH(echoes_of);
  for (float rest = -deepest - 1.0F; rest < static_cast<float>(plan.samples); rest += segment) {
    const Cell cell{first, last, rest, std::min(rest + segment, static_cast<float>(plan.samples))};
    const CellBox box = box_of(plan, frame, cell);
    Index b{};
    for (b[2] = box.low[2]; b[2] <= box.high[2]; ++b[2]) {
      for (b[1] = box.low[1]; b[1] <= box.high[1]; ++b[1]) {
        for (b[0] = box.low[0]; b[0] <= box.high[0]; ++b[0]) {
          const Vec3 middle_P = (Vec3(b[0], b[1], b[2]) + Vec3::Constant(0.5)) * static_cast<double>(plan.brick_mm);
          const Vec3f middle_T = (X_TP * middle_P).cast<float>();
          if (!comes_near(plan, frame, cell, box, middle_T, radius_mm)) continue;
          const bool is_dragged =
              drag_reach_mm > 0.0F && (middle_T - frame.drag.tip_T).norm() < drag_reach_mm + radius_mm;
          Echoes echoes;
          const int n = per_call(plan, frame, frame.pressed_samples.data(), cell, place(b, library, middle_T, side_T),
                                 is_dragged, echoes);
          splat(plan, echoes, n, cell, frame);
        }
      }
    }
  }
}

}  // namespace trocar::detail
#endif
