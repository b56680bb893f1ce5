#include "ultrasound/engine/detail/scatterer_echo.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ultrasound/engine/detail/scatterer_echo.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which sets the instruction set that these headers compile for.
#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#ifndef TROCAR_ULTRASOUND_ECHO_TYPES
#define TROCAR_ULTRASOUND_ECHO_TYPES
namespace trocar::ultrasound::detail {

/// Scatterers near a cell, in T, collected for batch processing.
struct alignas(64) Candidates {
  static constexpr int kMost = 1024;
  float x[kMost + 64], y[kMost + 64], z[kMost + 64], rank[kMost + 64];
  int count = 0;
};

/// Echoes of some candidates: position in the task's field, and contributions to the real and imaginary part of two
/// adjacent scanlines.
struct alignas(64) Echoes {
  std::int32_t place[Candidates::kMost + 64];
  float parts[4 * (Candidates::kMost + 64)];
};

}  // namespace trocar::ultrasound::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace trocar::ultrasound::detail {
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

/// arctan for |t| <= 1.2; minimax approximation, error below 1e-4 rad for fans.
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

/// cos and sin of a number of cycles, to 3e-4.
HWY_INLINE void turn(VF cycles, VF& cosine, VF& sine) {
  const F f;
  // Half the angle is in -pi/2..pi/2, where short series suffice; then the double angle.
  const VF half = hn::Mul(hn::Set(f, 3.14159265F), hn::Sub(cycles, hn::Round(cycles)));
  const VF h2 = hn::Mul(half, half);
  VF s = hn::Set(f, -1.8363654e-4F);
  s = hn::MulAdd(s, h2, hn::Set(f, 8.3063250e-3F));
  s = hn::MulAdd(s, h2, hn::Set(f, -0.16664824F));
  s = hn::Mul(half, hn::MulAdd(s, h2, hn::Set(f, 0.99999661F)));
  VF c = hn::Set(f, 2.3153932e-5F);
  c = hn::MulAdd(c, h2, hn::Set(f, -1.3853704e-3F));
  c = hn::MulAdd(c, h2, hn::Set(f, 4.1663585e-2F));
  c = hn::MulAdd(c, h2, hn::Set(f, -0.49999905F));
  c = hn::MulAdd(c, h2, hn::Set(f, 0.99999995F));
  sine = hn::Mul(hn::Add(s, s), c);
  cosine = hn::NegMulAdd(hn::Add(s, s), s, hn::Set(f, 1.0F));
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

/// Position of resting tissue along the scanline now, in samples: pressed_depth_mm of probe_contact.h.
HWY_INLINE VF walk_of_rest(const FrameState& frame, VF rest, VF pressed) {
  const F f;
  const VF reach = hn::Set(f, frame.dent_reach);
  const VF one = hn::Set(f, 1.0F);
  const VF sum = hn::Add(pressed, rest);
  const VF b = hn::MulAdd(hn::Set(f, 2.0F / frame.dent_reach), pressed, one);
  const VF product = hn::Mul(hn::Mul(pressed, sum), hn::Set(f, 4.0F / (frame.dent_reach * frame.dent_reach)));
  const VF root = hn::Sqrt(hn::Max(hn::NegMulAdd(one, product, hn::Mul(b, b)), hn::Zero(f)));
  const VF yielding = hn::Div(hn::Add(sum, sum), hn::Add(b, root));
  return hn::IfThenElse(hn::Lt(rest, reach), yielding, rest);
}

/// Appends the scatterers of a brick that are within the cell's bounds.
void take_near(const ScanPlan& plan, const Drag* drag, const Cell& cell, const PlacedBrick& placed, Candidates& near) {
  const F f;
  const VF radius = hn::Set(f, plan.geometry.is_fan ? static_cast<float>(plan.geometry.radius_mm) : 0.0F);
  for (std::size_t s = 0; s < kBrickScatterers; s += hn::Lanes(f)) {
    const VF rank = hn::Load(f, placed.brick->rank.data() + s);
    const auto wanted = hn::Lt(hn::Abs(rank), hn::Set(f, cell.most_rank));
    if (hn::AllFalse(f, wanted)) return;  // they are sorted by rank
    const VF bx = hn::Load(f, placed.brick->x.data() + s);
    const VF by = hn::Load(f, placed.brick->y.data() + s);
    const VF bz = hn::Load(f, placed.brick->z.data() + s);
    VF z = axis_of(placed, 2, bx, by, bz);
    VF x = axis_of(placed, 0, bx, by, bz);
    VF y = axis_of(placed, 1, bx, by, bz);
    if (drag != nullptr) drag_along(*drag, x, y, z);
    auto near_by = hn::And(wanted, hn::Lt(hn::Abs(z), hn::Set(f, cell.half_thickness_mm)));
    const VF from_apex = hn::Add(y, radius);
    for (int side = 0; side < 2; ++side) {
      const VF out = hn::MulAdd(x, hn::Set(f, cell.side_x[side]),
                                hn::MulAdd(from_apex, hn::Set(f, cell.side_y[side]), hn::Set(f, cell.side_d[side])));
      near_by = hn::And(near_by, hn::Le(out, hn::Zero(f)));
    }
    if (hn::AllFalse(f, near_by)) continue;
    // CompressStore is slow: it compresses in memory on some processors.
    hn::StoreU(hn::Compress(x, near_by), f, near.x + near.count);
    hn::StoreU(hn::Compress(y, near_by), f, near.y + near.count);
    hn::StoreU(hn::Compress(z, near_by), f, near.z + near.count);
    hn::StoreU(hn::Compress(rank, near_by), f, near.rank + near.count);
    near.count += static_cast<int>(hn::CountTrue(f, near_by));
  }
}

HWY_INLINE VF at_depth(const float (&parabola)[3], VF sample) {
  const F f;
  return hn::MulAdd(hn::MulAdd(hn::Set(f, parabola[2]), sample, hn::Set(f, parabola[1])), sample,
                    hn::Set(f, parabola[0]));
}

/// Integers of [0, most] nearest to `values`.
HWY_INLINE VI nearest_index(VF values, VF most) {
  const F f;
  return hn::NearestInt(hn::Min(hn::Max(values, hn::Zero(f)), most));
}

/// The fractional scanline whose bent ray passes through a position on the straight `line`, `lines_per_mm` apart.
HWY_INLINE VF bent_line(const ScanPlan& plan, const FrameState& frame, VF line, VI sample, VF lines_per_mm) {
  const F f;
  const I d;
  const VF last_line = hn::Set(f, static_cast<float>(plan.lines - 1));
  const VI coarse = hn::Set(d, static_cast<std::int32_t>(plan.coarse_samples()));
  static_assert(kCoarse == 8);
  VF bent = line;
  for (int round = 0; round < 3; ++round) {
    const VI at = hn::Add(hn::Mul(nearest_index(bent, last_line), coarse), hn::ShiftRight<3>(sample));
    bent = hn::NegMulAdd(hn::GatherIndex(f, frame.bend_mm.data(), at), lines_per_mm, line);
  }
  return bent;
}

/// ScanPlan::row_of.
HWY_INLINE VI gain_row(const ScanPlan& plan, VI plane, VI line) {
  const I d;
  const bool has_outermost = plan.planes >= 5;
  const VI central = hn::Set(d, plan.central()), zero = hn::Zero(d);
  const VI behind = hn::IfThenElseZero(hn::Gt(plane, central), hn::Set(d, 1));
  const VI inner = hn::Sub(hn::Sub(plane, behind), hn::Set(d, has_outermost ? 1 : 0));
  const VI inner_row = hn::Add(hn::Mul(inner, hn::Set(d, plan.rows_of_shift(kOuterShift))),
                               hn::Add(hn::ShiftRight<kOuterShift>(line), hn::Set(d, plan.lines)));
  VI row = hn::IfThenElse(hn::Eq(plane, central), line, inner_row);
  if (has_outermost) {
    const auto is_last = hn::Eq(plane, hn::Set(d, plan.planes - 1));
    const VI last = hn::IfThenElseZero(is_last, hn::Set(d, plan.rows_of_shift(kOutermostShift)));
    const VI outermost =
        hn::Add(hn::Add(hn::ShiftRight<kOutermostShift>(line), hn::Set(d, plan.outermost_row())), last);
    row = hn::IfThenElse(hn::Or(is_last, hn::Eq(plane, zero)), outermost, row);
  }
  return row;
}

/// Echoes of the candidates on the cell's scanlines; returns their number.
int accumulate_echoes(const ScanPlan& plan, const FrameState& frame, const Cell& cell, const Candidates& near,
                      Echoes& echoes) {
  const F f;
  const I d;
  const ScanGeometry& g = plan.geometry;
  const VF radius = hn::Set(f, static_cast<float>(g.radius_mm));
  const VF per_line = hn::Set(f, static_cast<float>(1.0 / g.line_step));
  const VF middle = hn::Set(f, static_cast<float>(g.middle_line()));
  const VF per_mm = hn::Set(f, 1.0F / plan.sample_mm);
  const VF last_sample = hn::Set(f, static_cast<float>(plan.samples - 1));
  const VF half = hn::Set(f, 0.5F);
  constexpr float kFeltWarp = 0.05F;
  const bool is_bent = frame.widest_warp > kFeltWarp;
  int n = 0;
  for (int s = 0; s < near.count; s += static_cast<int>(hn::Lanes(f))) {
    const VF x = hn::Load(f, near.x + s);
    const VF y = hn::Load(f, near.y + s);
    VF line, rest;
    if (g.is_fan) {
      const VF from_apex = hn::Add(y, radius);
      line = hn::MulAdd(arctan(hn::Div(x, hn::Max(from_apex, hn::Set(f, 1e-3F)))), per_line, middle);
      rest = hn::Mul(hn::Sub(hn::Sqrt(hn::MulAdd(x, x, hn::Mul(from_apex, from_apex))), radius), per_mm);
    } else {
      line = hn::MulAdd(x, per_line, middle);
      rest = hn::Mul(y, per_mm);
    }
    // Depths start at the face, samples half a step before it.
    VF walk = hn::Sub(rest, half);
    auto contributes = hn::FirstN(f, static_cast<std::size_t>(near.count - s));
    if (cell.yields) {
      const VI near_line = nearest_index(line, hn::Set(f, static_cast<float>(plan.lines - 1)));
      walk = hn::Sub(walk_of_rest(frame, rest, hn::GatherIndex(f, frame.pressed_samples.data(), near_line)), half);
    }
    contributes = hn::And(contributes, hn::And(hn::Ge(walk, hn::Zero(f)), hn::Le(walk, last_sample)));
    const VI at = hn::ConvertTo(d, hn::Min(hn::Max(walk, hn::Zero(f)), last_sample));
    if (is_bent) {
      const VF step = hn::Set(f, static_cast<float>(g.line_step));
      const VF spacing_mm = g.is_fan ? hn::Mul(hn::MulAdd(walk, hn::Set(f, plan.sample_mm), radius), step) : step;
      const VF lines_per_mm = hn::Div(hn::Set(f, 1.0F), hn::Max(spacing_mm, hn::Set(f, 0.02F)));
      line = bent_line(plan, frame, line, at, lines_per_mm);
    }
    contributes = hn::And(contributes, hn::And(hn::Ge(line, hn::Set(f, static_cast<float>(cell.first_line - 1))),
                                               hn::Lt(line, hn::Set(f, static_cast<float>(cell.last_line)))));
    const VF zeta = hn::Mul(hn::Load(f, near.z + s), at_depth(cell.inverse_elevation_sigma, walk));
    contributes = hn::And(contributes, hn::Lt(hn::Abs(zeta), hn::Set(f, kBeamEdge)));
    const VF signed_rank = hn::Load(f, near.rank + s);
    const VF rank = hn::Abs(signed_rank), most_rank = at_depth(cell.rank, walk);
    contributes = hn::And(contributes, hn::Lt(rank, most_rank));
    if (hn::AllFalse(f, contributes)) continue;

    // Of the task's own scanlines: the gains of adjacent tasks may not be computed yet.
    const VI own_line = hn::NearestInt(hn::Min(hn::Max(line, hn::Set(f, static_cast<float>(cell.first_line))),
                                               hn::Set(f, static_cast<float>(cell.last_line - 1))));
    // One of the two nearest planes, the nearer with the larger share of scatterers: tissue changes gradually between
    // planes.
    const VF scaled_rank = hn::Mul(rank, hn::Set(f, static_cast<float>(kBrickScatterers)));
    const VF chance = hn::Sub(scaled_rank, hn::Floor(scaled_rank));
    const VF plane = hn::MulAdd(zeta, hn::Set(f, 1.0F / plan.plane_step),
                                hn::Add(chance, hn::Set(f, static_cast<float>(plan.central()) - 0.5F)));
    const VI plane_index = nearest_index(plane, hn::Set(f, static_cast<float>(plan.planes - 1)));
    const VI in_line = hn::Add(hn::Mul(own_line, hn::Set(d, plan.samples)), at);
    const VI place = hn::Add(hn::Mul(gain_row(plan, plane_index, own_line), hn::Set(d, plan.samples)), at);
    const VF shown = hn::Add(walk, hn::GatherIndex(f, frame.delay.data(), in_line));
    const VI packed =
        hn::And(hn::GatherOffset(d, reinterpret_cast<const std::int32_t*>(frame.gain.data()), hn::Add(place, place)),
                hn::Set(d, 0xffff));  // two bytes each: the upper half belongs to the next one
    const VF log_gain = hn::MulAdd(hn::ConvertTo(f, hn::ShiftRight<kShareBits>(packed)), hn::Set(f, kLogGainStep),
                                   hn::Set(f, kLeastLogGain));
    const VI share_class = hn::And(packed, hn::Set(d, (1 << kShareBits) - 1));
    VF share = hn::Set(f, kShares[0]);  // most tissues'
    if (!hn::AllTrue(d, hn::Eq(share_class, hn::Zero(d)))) share = hn::GatherIndex(f, kShares.data(), share_class);
    const VI sample = hn::ConvertTo(d, hn::Add(shown, half));
    contributes = hn::And(contributes, hn::And(hn::Lt(rank, hn::Mul(share, most_rank)), hn::Le(shown, last_sample)));
    contributes = hn::And(contributes, hn::RebindMask(f, hn::Gt(sample, hn::Set(d, -kBeforeFace - 1))));
    if (hn::AllFalse(f, contributes)) continue;
    const VF weight = hn::Mul(hn::Exp(f, hn::MulAdd(hn::Mul(zeta, zeta), hn::Set(f, -0.5F), log_gain)),
                              at_depth(cell.speckle_scale, walk));
    const VF amplitude = hn::CopySign(weight, signed_rank);
    VF cosine, sine;
    turn(hn::Mul(shown, hn::Set(f, plan.cycles_per_sample)), cosine, sine);
    const VF re = hn::Mul(amplitude, cosine), im = hn::Neg(hn::Mul(amplitude, sine));
    const VF lower = hn::Floor(line), part = hn::Sub(line, lower), rest_of_it = hn::Sub(hn::Set(f, 1.0F), part);
    const VI column = hn::Sub(hn::ConvertTo(d, lower), hn::Set(d, cell.first_line - 1));
    const VI row = hn::Mul(hn::Add(sample, hn::Set(d, kBeforeFace)), hn::Set(d, kFieldRow));
    hn::StoreU(hn::Compress(hn::Add(row, hn::Add(column, column)), hn::RebindMask(d, contributes)), d,
               echoes.place + n);
    hn::StoreInterleaved4(hn::Compress(hn::Mul(rest_of_it, re), contributes),
                          hn::Compress(hn::Mul(rest_of_it, im), contributes),
                          hn::Compress(hn::Mul(part, re), contributes), hn::Compress(hn::Mul(part, im), contributes), f,
                          echoes.parts + 4 * n);
    n += static_cast<int>(hn::CountTrue(f, contributes));
  }
  return n;
}

}  // namespace HWY_NAMESPACE
}  // namespace trocar::ultrasound::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trocar::ultrasound::detail {

HWY_EXPORT(take_near);
HWY_EXPORT(accumulate_echoes);

namespace {

void splat(const Echoes& echoes, int n, float* field) noexcept {
  using Parts = Eigen::Array4f;
  for (int e = 0; e < n; ++e) {
    Eigen::Map<Parts> at(field + echoes.place[e]);
    at += Eigen::Map<const Parts, Eigen::Aligned16>(echoes.parts + 4 * e);
  }
}

/// Computes the echoes of the collected scatterers and adds them to the field.
void flush(const ScanPlan& plan, const FrameState& frame, const Cell& cell, Candidates& near, Echoes& echoes,
           float* field) noexcept {
  const int n = HWY_DYNAMIC_DISPATCH(accumulate_echoes)(plan, frame, cell, near, echoes);
  splat(echoes, n, field);
  near.count = 0;
}

/// From the field to the scanlines [first, last).
void add_field(const ScanPlan& plan, const ScattererField& field, FrameState& frame, int first, int last) noexcept {
  constexpr int kRows = 16;  // they stay in the first-level cache
  for (int begin = -kBeforeFace; begin < plan.samples; begin += kRows) {
    const int end = std::min(begin + kRows, plan.samples);
    for (int line = first; line < last; ++line) {
      const std::size_t to = plan.echo_row(line);
      const float* from = field.data() + 2 * (line - first + 1);
      for (int s = begin; s < end; ++s) {
        frame.re[to + static_cast<std::size_t>(s)] += from[(s + kBeforeFace) * kFieldRow];
        frame.im[to + static_cast<std::size_t>(s)] += from[(s + kBeforeFace) * kFieldRow + 1];
      }
    }
  }
}

/// Where the patient moves: the bricks of tissue that is in a cell now, each where its middle is, with the slope of the
/// map there. `take(placed, middle_T)`.
template <class Take>
void take_moving(const ScanPlan& plan, const FrameState& frame, const Cell& cell, const Pose& X_TP,
                 const std::vector<Brick>& library, const Take& take) noexcept {
  const auto brick_mm = static_cast<double>(plan.brick_mm);
  const CellAtRest at_rest = rest_of(plan, frame, cell);
  const Mat3 side_T = X_TP.R() * at_rest.jacobian * brick_mm;
  const double drag_mm = frame.drag.reach_mm > 0.0F ? static_cast<double>(frame.drag.shift_T.norm()) : 0.0;
  const BrickReach reach =
      reach_of(cell, side_T.cast<float>(), static_cast<float>(drag_mm + at_rest.slack_mm + 0.2 * brick_mm));
  const CellBox& box = at_rest.box;
  BrickIndex b{};
  for (b[2] = box.low[2]; b[2] <= box.high[2]; ++b[2]) {
    for (b[1] = box.low[1]; b[1] <= box.high[1]; ++b[1]) {
      const Vec3 row_A = (Vec3(box.low[0], b[1], b[2]) + Vec3::Constant(0.5)) * brick_mm;
      int first_i = 0, last_i = box.high[0] - box.low[0];
      stay_in_cell(plan, cell, reach, (X_TP * at_rest.now_P(row_A)).cast<float>(), side_T.col(0).cast<float>(), first_i,
                   last_i);
      for (int i = first_i; i <= last_i; ++i) {
        const motion::PatientMotion::Moved moved =
            frame.motion.moved_with_jacobian(row_A + i * brick_mm * Vec3::UnitX());
        const Vec3f middle_T = (X_TP * moved.p_P).cast<float>();
        if (!is_at_depth(cell, plan.geometry.is_fan, static_cast<float>(plan.geometry.radius_mm), middle_T)) continue;
        b[0] = box.low[0] + i;
        const Eigen::Matrix3f sides = (X_TP.R() * moved.jacobian * brick_mm).cast<float>();
        take(place_brick(b, library, middle_T, sides), middle_T);
      }
    }
  }
}

}  // namespace

ScattererField make_scatterer_field(const ScanPlan& plan) {
  return ScattererField(static_cast<std::size_t>((kBeforeFace + plan.samples) * kFieldRow));
}

void add_scatterers(const ScanPlan& plan, const std::vector<Brick>& library, FrameState& frame, int first, int last,
                    ScattererField& field) noexcept {
  const Pose X_TP = frame.X_PT.inverse();
  const Eigen::Matrix3f side_T = (X_TP.R() * static_cast<double>(plan.brick_mm)).cast<float>();
  const bool has_drag = frame.drag.reach_mm > 0.0F;
  const float drag_mm = has_drag ? frame.drag.shift_T.norm() : 0.0F;
  const float radius_mm = 0.5F * std::sqrt(3.0F) * plan.brick_mm;
  const float radius = radius_mm / plan.sample_mm;
  const auto face_mm = static_cast<float>(plan.geometry.radius_mm);
  constexpr int kSegments = 16;  // per depth: the variation along one is nearly a parabola
  const float segment = static_cast<float>(plan.samples) / kSegments;
  const auto take = HWY_DYNAMIC_DISPATCH(take_near);
  Candidates near{};  // vectors also read behind the last candidate
  Echoes echoes;
  std::fill(field.begin(), field.end(), 0.0F);
  const auto audible =
      static_cast<float>(*std::max_element(frame.audible.begin() + first, frame.audible.begin() + last));
  for (float rest = -frame.deepest_dent_mm / plan.sample_mm - radius; rest < audible + radius; rest += segment) {
    const Cell cell = make_cell(plan, frame, first, last, rest, rest + segment, radius);
    if (!frame.motion.is_rest()) {
      take_moving(plan, frame, cell, X_TP, library, [&](const PlacedBrick& placed, const Vec3f& middle_T) {
        const bool is_dragged =
            has_drag && (middle_T - frame.drag.tip_T).norm() < frame.drag.reach_mm + radius_mm + drag_mm;
        take(plan, is_dragged ? &frame.drag : nullptr, cell, placed, near);
        if (near.count > Candidates::kMost - kBrickScatterers) flush(plan, frame, cell, near, echoes, field.data());
      });
      flush(plan, frame, cell, near, echoes, field.data());
      continue;
    }
    const CellBox box = box_of(plan, frame, cell);
    const BrickReach reach = reach_of(cell, side_T, drag_mm);
    BrickIndex b{};
    for (b[2] = box.low[2]; b[2] <= box.high[2]; ++b[2]) {
      for (b[1] = box.low[1]; b[1] <= box.high[1]; ++b[1]) {
        const Vec3 row_P = (Vec3(box.low[0], b[1], b[2]) + Vec3::Constant(0.5)) * static_cast<double>(plan.brick_mm);
        const Vec3f row_T = (X_TP * row_P).cast<float>();
        int first_i = 0, last_i = box.high[0] - box.low[0];
        stay_in_cell(plan, cell, reach, row_T, side_T.col(0), first_i, last_i);
        for (int i = first_i; i <= last_i; ++i) {
          const Vec3f middle_T = row_T + static_cast<float>(i) * side_T.col(0);
          if (!is_at_depth(cell, plan.geometry.is_fan, face_mm, middle_T)) continue;
          const bool is_dragged =
              has_drag && (middle_T - frame.drag.tip_T).norm() < frame.drag.reach_mm + radius_mm + drag_mm;
          b[0] = box.low[0] + i;
          take(plan, is_dragged ? &frame.drag : nullptr, cell, place_brick(b, library, middle_T, side_T), near);
          if (near.count > Candidates::kMost - kBrickScatterers) flush(plan, frame, cell, near, echoes, field.data());
        }
      }
    }
    flush(plan, frame, cell, near, echoes, field.data());
  }
  add_field(plan, field, frame, first, last);
}

}  // namespace trocar::ultrasound::detail
#endif
