#include "ultrasound/engine/detail/point_echo.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "ultrasound/probe/probe_contact.h"

namespace trocar::ultrasound::detail {
namespace {

/// The point's position among scanlines and samples of `walk`, and in elevation; line < -1: no echo.
struct ImagedPoint {
  double line = -10.0, walk = 0.0, zeta = 0.0;
};

ImagedPoint image_point(const ScanPlan& plan, const FrameState& frame, const Vec3& p_T) noexcept {
  const Polar at = plan.geometry.to_polar(Vec2(p_T.x(), p_T.y()));
  const auto nearest = [&](double line) {
    return static_cast<std::size_t>(std::clamp(std::lround(line), 0L, plan.lines - 1L));
  };
  if (at.line < -1.0 || at.line > plan.lines || at.depth_mm < -static_cast<double>(frame.deepest_dent_mm)) return {};
  const double sample_mm = plan.geometry.sample_mm();
  const double pressed = static_cast<double>(frame.pressed_samples[nearest(at.line)]);
  const double walk = pressed_depth_mm(at.depth_mm / sample_mm, pressed, static_cast<double>(frame.dent_reach)) - 0.5;
  if (!(walk >= 0.0 && walk <= plan.samples - 1)) return {};
  const auto s = static_cast<std::size_t>(walk);
  // The scanline whose bent ray passes through it receives the echo.
  const double spacing_mm = plan.geometry.line_spacing_mm((walk + 0.5) * sample_mm);
  double line = at.line;
  for (int round = 0; round < 3; ++round)
    line =
        at.line - static_cast<double>(frame.bend_mm[nearest(line) * plan.coarse_samples() + s / kCoarse]) / spacing_mm;
  return {line, walk, p_T.z() * static_cast<double>(plan.inverse_elevation_sigma[s])};
}

}  // namespace

std::vector<PointGroup> group_points(const AcousticScene& scene) {
  constexpr std::size_t kTogether = 32;  // neighbours in the list are neighbours in space
  std::vector<PointGroup> groups;
  for (std::size_t first = 0; first < scene.points.size(); first += kTogether) {
    PointGroup group{first, std::min(first + kTogether, scene.points.size()), Vec3::Zero(), 0.0};
    Eigen::AlignedBox3d box;
    for (std::size_t n = group.first; n < group.last; ++n) box.extend(scene.points[n].p_P);
    group.centre_P = box.center();
    group.radius_mm = 0.5 * box.diagonal().norm();
    groups.push_back(group);
  }
  return groups;
}

namespace {

void add_point(const ScanPlan& plan, FrameState& frame, const AcousticPoint& point, const Pose& X_TP, int first,
               int last) noexcept {
  const ImagedPoint imaged = image_point(plan, frame, X_TP * frame.motion.to_now(point.p_P));
  if (imaged.line < -1.0 || std::abs(imaged.zeta) > static_cast<double>(kBeamEdge)) return;
  const auto line = static_cast<int>(std::floor(imaged.line));
  const auto nearest = std::clamp(static_cast<int>(std::lround(imaged.line)), 0, plan.lines - 1);
  const std::size_t place = static_cast<std::size_t>(nearest) * static_cast<std::size_t>(plan.samples) +
                            static_cast<std::size_t>(imaged.walk);
  // Its own strength and the losses of the path, without the tissue's backscatter.
  const double amplitude = std::pow(10.0, point.amplitude_db / 20.0) * std::exp(-0.5 * imaged.zeta * imaged.zeta) *
                           static_cast<double>(frame.way_gain[place]);
  const double shown = imaged.walk + static_cast<double>(frame.delay[place]);
  const auto sample = static_cast<std::ptrdiff_t>(std::lround(shown));
  if (sample < 0 || sample >= plan.samples) return;
  const double turn = 2.0 * std::numbers::pi * shown * static_cast<double>(plan.cycles_per_sample);
  for (int side = 0; side < 2; ++side) {
    if (line + side < first || line + side >= last) continue;
    const double part = side == 0 ? 1.0 - (imaged.line - line) : imaged.line - line;
    const auto to = plan.echo_row(line + side) + static_cast<std::size_t>(sample);
    frame.re[to] += static_cast<float>(part * amplitude * std::cos(turn));
    frame.im[to] -= static_cast<float>(part * amplitude * std::sin(turn));
  }
}

}  // namespace

/// Motion moves the points of a group apart by no more than this. [assumed]
constexpr double kMostSpread_mm = 60.0;

void add_points(const ScanPlan& plan, FrameState& frame, int first, int last) noexcept {
  const Pose X_TP = frame.X_PT.inverse();
  const double thickest_mm = static_cast<double>(
      kBeamEdge * *std::max_element(plan.elevation_sigma_mm.begin(), plan.elevation_sigma_mm.end()));
  const double deepest_mm = plan.geometry.depth_mm;
  for (const PointGroup& group : frame.point_groups) {
    const Vec3 centre_T = X_TP * frame.motion.to_now(group.centre_P);
    const double radius_mm = group.radius_mm + (frame.motion.is_rest() ? 0.0 : kMostSpread_mm);
    if (std::abs(centre_T.z()) > thickest_mm + radius_mm || centre_T.y() > deepest_mm + radius_mm) continue;
    for (std::size_t n = group.first; n < group.last; ++n) {
      const AcousticPoint& point = frame.scene->points[n];
      if (std::abs(X_TP.R().row(2).dot(frame.motion.to_now(point.p_P)) + X_TP.p().z()) > thickest_mm) continue;
      add_point(plan, frame, point, X_TP, first, last);
    }
  }
}

}  // namespace trocar::ultrasound::detail
