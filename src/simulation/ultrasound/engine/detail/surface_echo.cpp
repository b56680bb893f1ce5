#include "ultrasound/engine/detail/surface_echo.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "core/random.h"
#include "ultrasound/engine/detail/border_fit.h"
#include "ultrasound/engine/detail/tissue_texture.h"
#include "ultrasound/engine/detail/tissue_walk.h"

namespace trocar::ultrasound::detail {
namespace {

/// Echo of a perfect, smooth, perpendicular reflector relative to liver's speckle, without attenuation: 48 dB (assumed;
/// range 40..60. Liver's backscatter makes it about 50 dB at 3.5 MHz).
constexpr float kPerfect = 250.0F;
/// Tilt at which the echo of a smooth surface has decreased to exp(-1/2), rad (assumed, range 0.1..0.35).
constexpr float kTilt_rad = 0.2F;
/// Echo share of a completely rough surface (assumed).
constexpr float kRoughShare = 0.22F;

std::uint32_t key_of(const std::array<float, 3>& index) noexcept {
  const auto part = [](float v, int shift) {
    return static_cast<std::uint64_t>(static_cast<std::uint32_t>(static_cast<std::int32_t>(std::floor(2.0F * v))) &
                                      0x1fffffU)
           << shift;
  };
  return static_cast<std::uint32_t>(mix64(part(index[0], 0) | part(index[1], 21) | part(index[2], 42)) >> 32);
}

/// Tilt of the surface relative to the wave front, rad.
float tilt_of(const ScanPlan& plan, const FrameState& frame, int line, const Border& border,
              const SurfaceFit& fit) noexcept {
  constexpr int kEnough = 3;
  if (fit.neighbours >= kEnough) return std::atan(std::hypot(fit.lateral, fit.elevation));
  // A small piece of a surface, or one nearly along the beam: from the volume.
  const LineWalk& path = frame.walks[static_cast<std::size_t>(line)];
  const Vec3 along = Vec3(path.along[0], path.along[1], path.along[2]).cwiseProduct(frame.scene->geometry.spacing_mm);
  const Vec3 slope = impedance_slope(frame, plan.rows, Vec3(border.index[0], border.index[1], border.index[2]));
  const double size = slope.norm();
  return size > 1e-6 ? static_cast<float>(std::acos(std::min(1.0, std::abs(slope.dot(along)) / size))) : 0.8F;
}

/// Smooth noise at the place of a border, -1..1, varying over `wave_mm`.
float noise_at(const FrameState& frame, const Border& border, float wave_mm) noexcept {
  const Vec3f spacing_mm = frame.scene->geometry.spacing_mm.cast<float>();
  const Vec3f at = Vec3f(border.index[0], border.index[1], border.index[2]).cwiseProduct(spacing_mm) / wave_mm;
  return smooth_noise(at.x(), at.y(), at.z());
}

void note_reflector(const FrameState& frame, Reflector& reflector, const Border& border, float shown, float strength,
                    float smooth_share, float rough) noexcept {
  constexpr float kGas = -0.6F;
  const bool is_gas = border.reflection < kGas;
  if (is_gas ? reflector.is_gas : reflector.is_gas || strength * smooth_share <= reflector.amplitude) return;
  // Bubbles are rough gas; the smooth surface of the lung has no ring-down.
  constexpr float kBubbly = 0.35F, kCluster_mm = 6.0F;
  reflector = {shown, strength * smooth_share, strength * std::max(0.0F, rough - kBubbly), is_gas,
               is_gas ? noise_at(frame, border, kCluster_mm) : 0.0F};
}

/// A surface that a plane crosses on a scanline.
struct Surface {
  std::uint16_t tissues = 0;
  SurfaceFit fit;
  float tilt = 0.0F;
  float unevenness = 1.0F;  ///< Of its wall's amplitude there.
};

/// The surfaces that one scanline crosses on the central plane.
struct CentralSurfaces {
  std::array<Surface, kMaxBorders> all;
  std::size_t count = 0;
};

/// Paints the surface echoes of one scanline. A surface is fitted once, on the central plane of every second scanline,
/// and followed to the next scanline and to the other planes; those fit only surfaces that cannot be followed.
class EchoPainter {
 public:
  EchoPainter(const ScanPlan& plan, FrameState& frame, int line, CentralSurfaces& surfaces) noexcept
      : plan_(plan),
        frame_(frame),
        line_(line),
        surfaces_(surfaces),
        reflector_(frame.reflectors[static_cast<std::size_t>(line)]),
        delay_(frame.delay.data() + static_cast<std::size_t>(line) * static_cast<std::size_t>(plan.samples)) {
    reflector_ = {};
    surfaces_.count = 0;
  }

  /// `beside`: those of the scanline before; nullptr: none.
  void paint_central(const CentralSurfaces* beside) noexcept {
    for (const Border& border : borders_of(plan_.central())) {
      const float strength = strength_of(border);
      if (strength < kLeast) continue;
      Surface& surface = surfaces_.all[surfaces_.count++];
      if (beside == nullptr || !follow(*beside, border, surface)) {
        surface.tissues = tissues_of(border);
        surface.fit = fit_surface(plan_, frame_, plan_.central(), line_, border);
        surface.tilt = tilt_of(plan_, frame_, line_, border, surface.fit);
        surface.unevenness = unevenness_at(border);
      }
      paint(border, strength, surface, plan_.central(), 0.0F);
    }
  }

  void paint_outer(int plane) noexcept {
    for (const Border& border : borders_of(plane)) {
      const float strength = strength_of(border);
      if (strength < kLeast) continue;
      const float z_mm = static_cast<float>(plane - plan_.central()) * plane_mm(border.walk);
      if (const Surface* same = find_central(border, plane, z_mm)) {
        paint(border, strength, *same, plane, z_mm);
      } else {
        const SurfaceFit fit = fit_surface(plan_, frame_, plane, line_, border);
        const float tilt = tilt_of(plan_, frame_, line_, border, fit);
        paint(border, strength, {tissues_of(border), fit, tilt, 1.0F}, plane, 0.0F);
      }
    }
  }

 private:
  static constexpr float kLeast = 1e-4F;  // about 30 dB below liver's speckle
  static constexpr float kLeastEven = 0.05F;

  std::span<const Border> borders_of(int plane) const noexcept {
    const auto row = static_cast<std::size_t>(plan_.row_of(plane, line_));
    return {frame_.borders.data() + row * kMaxBorders, frame_.border_counts[row]};
  }
  static float strength_of(const Border& border) noexcept {
    return std::abs(border.reflection) * std::exp(std::max(border.log_gain, -60.0F));
  }
  std::size_t sample_at(float walk) const noexcept {
    return static_cast<std::size_t>(std::clamp(walk, 0.0F, static_cast<float>(plan_.samples - 1)));
  }
  float plane_mm(float walk) const noexcept { return plan_.plane_step * plan_.elevation_sigma_mm[sample_at(walk)]; }

  float spacing_mm(const Border& border) const noexcept {
    const double depth_mm = (static_cast<double>(border.walk) + 0.5) * static_cast<double>(plan_.sample_mm);
    return static_cast<float>(plan_.geometry.line_spacing_mm(std::max(depth_mm, 0.1)));
  }

  /// The surface of the scanline before that continues to a border; false: none.
  bool follow(const CentralSurfaces& beside, const Border& border, Surface& surface) const noexcept {
    constexpr float kStep_mm = 0.7F;  // a voxel's step, and less than the distance of two surfaces
    constexpr int kEnough = 4;
    const std::uint16_t tissues = tissues_of(border);
    const float aside_mm = spacing_mm(border);
    for (std::size_t n = 0; n < beside.count; ++n) {
      const Surface& before = beside.all[n];
      if (before.tissues != tissues || before.fit.neighbours < kEnough) continue;
      const float walk = before.fit.walk + before.fit.lateral * aside_mm / plan_.sample_mm;
      if (std::abs(border.walk - walk) * plan_.sample_mm > kStep_mm) continue;
      surface = before;
      surface.fit.walk = walk;
      return true;
    }
    return false;
  }

  /// The central surface that continues to a border of an outer plane, `z_mm` across the image; nullptr: none.
  const Surface* find_central(const Border& border, int plane, float z_mm) const noexcept {
    const std::uint16_t tissues = tissues_of(border);
    const float aside_mm = static_cast<float>(plan_.walked_line(plane, line_) - line_) * spacing_mm(border);
    float least_mm = 1.2F;  // a voxel's step
    const Surface* found = nullptr;
    for (std::size_t n = 0; n < surfaces_.count; ++n) {
      const SurfaceFit& fit = surfaces_.all[n].fit;
      if (surfaces_.all[n].tissues != tissues) continue;
      const float off_mm =
          std::abs((border.walk - fit.walk) * plan_.sample_mm - fit.deeper_mm(z_mm) - fit.lateral * aside_mm);
      if (off_mm >= least_mm) continue;
      least_mm = off_mm;
      found = &surfaces_.all[n];
    }
    return found;
  }

  /// Slow variation of a wall along its surface.
  float unevenness_at(const Border& border) const noexcept {
    constexpr float kDepth = 0.4F, kWave_mm = 12.0F;  // up to 3.5 dB (assumed)
    const WallRow* wall = wall_of(border);
    return wall == nullptr || wall->even < kLeastEven ? 1.0F : std::exp(kDepth * noise_at(frame_, border, kWave_mm));
  }
  /// nullptr: none.
  const WallRow* wall_of(const Border& border) const noexcept {
    const std::uint8_t wall =
        plan_.wall_at[static_cast<std::size_t>(border.before & 127U) * kTissues + (border.behind & 127U)];
    return wall == 0 ? nullptr : &plan_.walls[wall - 1U];
  }

  /// The echo of a border on one plane, `z_mm` across the image from where `surface` was fitted. A surface that runs
  /// across the image returns it from several depths.
  void paint(const Border& border, float strength, const Surface& surface, int plane, float z_mm) noexcept {
    const SurfaceFit& fit = surface.fit;
    const float tilt = surface.tilt;
    const float step_mm = plane_mm(fit.walk);
    const float run_mm = std::abs(fit.elevation + 2.0F * fit.bow_per_mm * z_mm) * step_mm;
    constexpr float kMostParts = 6.0F;
    const float part_mm = 2.0F * static_cast<float>(plan_.beam.axial_sigma_mm);
    const auto parts = static_cast<int>(std::clamp(std::ceil(run_mm / part_mm), 1.0F, kMostParts));
    const float rough = std::max(plan_.roughness[border.before & 127U], plan_.roughness[border.behind & 127U]);
    const float smooth_share = (1.0F - rough) * std::exp(-0.5F * (tilt / kTilt_rad) * (tilt / kTilt_rad));
    const float weight = plan_.plane_weight[static_cast<std::size_t>(plane)] / static_cast<float>(parts);
    const std::uint32_t key = key_of(border.index);
    if (const WallRow* wall = wall_of(border)) paint_wall(border, *wall, surface, plane, z_mm);
    for (int part = 0; part < parts; ++part) {
      const float off = (static_cast<float>(part) + 0.5F) / static_cast<float>(parts) - 0.5F;
      const float walk = fit.walk + fit.deeper_mm(z_mm + off * step_mm) / plan_.sample_mm;
      const std::size_t at = sample_at(walk);
      const float shown = walk + delay_[at];
      if (shown < 0.0F || shown + 0.5F >= static_cast<float>(plan_.samples)) continue;
      // Rough echoes of adjacent scanlines, planes and parts add up incoherently: each needs more amplitude for the
      // same level.
      const float rough_part =
          rough * kRoughShare * std::cos(tilt) * std::sqrt(static_cast<float>(parts) / plan_.surface_scale[at]);
      add(kPerfect * strength * weight * plan_.surface_scale[at], smooth_share, rough_part,
          key + static_cast<std::uint32_t>(part) * 0x9e3779b9U, static_cast<int>(shown + 0.5F));
      if (plane == plan_.central() && part == parts / 2)
        note_reflector(frame_, reflector_, border, shown, strength, smooth_share, rough);
    }
  }

  /// The even band of a wall along a border: sheets that echo in phase, as the border's smooth part, at any tilt.
  void paint_wall(const Border& border, const WallRow& wall, const Surface& surface, int plane, float z_mm) noexcept {
    constexpr float kLeastCosine = 0.35F;  // limits the length along the scanline; less is a glancing beam
    const SurfaceFit& fit = surface.fit;
    const float run_mm = std::abs(fit.elevation + 2.0F * fit.bow_per_mm * z_mm) * plane_mm(fit.walk);
    const float facing = std::cos(surface.tilt), cosine = std::max(facing, kLeastCosine);
    const float length = std::hypot(wall.thickness_mm / cosine, run_mm) / plan_.sample_mm;
    const float at_border = fit.walk + fit.deeper_mm(z_mm) / plan_.sample_mm;
    const float begin = wall.is_behind ? at_border : at_border - length;
    const float level = wall.even * std::sqrt(cosine) * std::clamp(facing / kLeastCosine, 0.0F, 1.0F) *
                        std::exp(std::max(border.log_gain, -60.0F));
    if (wall.even < kLeastEven || level < kLeast) return;
    const std::size_t at = sample_at(at_border);
    // A band of equal samples adds up over the pulse, and over the scanlines.
    const float amplitude = level * plan_.plane_weight[static_cast<std::size_t>(plane)] * plan_.surface_scale[at] *
                            plan_.band_scale * surface.unevenness;
    const float delayed = begin + delay_[at];
    const int first = std::max(0, static_cast<int>(std::ceil(delayed)));
    const int last = std::min(plan_.samples - 1, static_cast<int>(std::floor(delayed + length)));
    const std::size_t row = plan_.echo_row(line_);
    for (int s = first; s <= last; ++s) {
      const float off = 2.0F * (static_cast<float>(s) - delayed) / length - 1.0F;
      frame_.re[row + static_cast<std::size_t>(s)] += amplitude * (1.0F - off * off);
    }
  }

  void add(float amplitude, float smooth_share, float rough_part, std::uint32_t key, int sample) noexcept {
    const float* const gaussian = plan_.noise.data() + 2U * (key % (ScanPlan::kNoise / 2));
    const float rough = amplitude * rough_part / std::numbers::sqrt2_v<float>;
    const std::size_t to = plan_.echo_row(line_) + static_cast<std::size_t>(sample);
    frame_.re[to] += amplitude * smooth_share + rough * gaussian[0];
    frame_.im[to] += rough * gaussian[1];
  }

  const ScanPlan& plan_;
  FrameState& frame_;
  int line_;
  CentralSurfaces& surfaces_;
  Reflector& reflector_;
  const float* delay_;
};

}  // namespace

void add_surface_echoes(const ScanPlan& plan, FrameState& frame, int first, int last) noexcept {
  CentralSurfaces fitted, followed;
  for (int line = first; line < last; ++line) {
    const bool follows = (line - first) % 2 == 1;
    EchoPainter painter(plan, frame, line, follows ? followed : fitted);
    painter.paint_central(follows ? &fitted : nullptr);
    for (int plane = 0; plane < plan.planes; ++plane)
      if (plane != plan.central()) painter.paint_outer(plane);
  }
}

}  // namespace trocar::ultrasound::detail
