#include "cases/force_curve.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace trocar::cases {

std::vector<CurvePoint> force_curve(const haptics::HapticScene& scene, const PrescribedMotion& motion) {
  const auto state = std::make_unique<haptics::HapticState>();
  const Vec3 axis_P = motion.line_P.direction();
  std::vector<CurvePoint> curve;
  const double length_mm = motion.line_P.length_mm();
  const int count = tick_count(motion);
  curve.reserve(static_cast<std::size_t>(count));
  for (int i = 1; i <= count; ++i) {
    const telemetry::TickSample sample = haptics::tick(*state, input_at(motion, i), scene).sample;
    CurvePoint point;
    point.time_s = sample.time_s;
    point.way_mm = way_mm(motion, i);
    point.tip_mm = sample.depth_mm;
    point.force_n = -sample.device_f_n.dot(axis_P);
    point.tissue = sample.tissue;
    for (const telemetry::TickEvent& event : sample.events)
      if (event.kind == telemetry::EventKind::kPuncture) point.layer = event.id;
    curve.push_back(point);
    if (motion.after_mm > 0.0 && point.way_mm >= length_mm && point.tip_mm >= length_mm) break;
  }
  return curve;
}

std::vector<CurveEvent> find_curve_events(const std::vector<CurvePoint>& curve, const anatomy::TissueTable& tissues) {
  // The record may name the puncture one or two ticks after the maximum of the force.
  constexpr std::size_t kPeakWindow = 5;
  std::vector<std::size_t> punctures;
  for (std::size_t i = 0; i < curve.size(); ++i)
    if (curve[i].layer != haptics::kNoLayer) punctures.push_back(i);

  const auto lower = [](const CurvePoint& a, const CurvePoint& b) { return a.force_n < b.force_n; };
  std::vector<CurveEvent> events;
  for (std::size_t n = 0; n < punctures.size(); ++n) {
    const std::size_t i = punctures[n];
    const std::size_t from = std::max(i > kPeakWindow ? i - kPeakWindow : 0, n > 0 ? punctures[n - 1] + 1 : 0);
    const auto begin = curve.begin();
    const auto peak =
        std::max_element(begin + static_cast<std::ptrdiff_t>(from), begin + static_cast<std::ptrdiff_t>(i) + 1, lower);
    const std::size_t next = n + 1 < punctures.size() ? punctures[n + 1] : curve.size();
    auto end = peak;
    while (end + 1 < begin + static_cast<std::ptrdiff_t>(next) && (end + 1)->time_s <= peak->time_s + kAfter_s) ++end;
    const auto lowest = std::min_element(peak, end + 1, lower);
    CurveEvent event;
    event.layer = tissues.layers[curve[i].layer].name;
    event.at = static_cast<std::size_t>(peak - begin);
    event.way_mm = peak->way_mm;
    event.tip_mm = peak->tip_mm;
    event.peak_n = peak->force_n;
    event.after_n = lowest->force_n;
    event.highest_n = std::max_element(peak, lowest + 1, lower)->force_n;
    const double fallen_n = event.peak_n - 0.9 * event.drop_n();
    const auto fallen = std::find_if(peak, lowest, [&](const CurvePoint& point) { return point.force_n <= fallen_n; });
    event.fall_ms = event.drop_n() > 0.0 ? 1e3 * (fallen->time_s - peak->time_s) : 0.0;
    events.push_back(event);
  }
  return events;
}

std::vector<CurveBorder> find_curve_borders(const std::vector<CurvePoint>& curve,
                                            const std::vector<PathPiece>& pieces) {
  constexpr double kBefore_mm = 3.0;
  constexpr double kBehind_mm = 10.0;
  constexpr double kStandsOut_n = 0.2;
  std::vector<CurveBorder> borders;
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const double at_mm = pieces[i].from_mm;
    const double to_mm = std::min(at_mm + kBehind_mm, pieces[i].to_mm);
    const CurvePoint* peak = nullptr;
    double before_n = 0.0, after_n = 0.0;
    bool has_puncture = false;
    for (const CurvePoint& point : curve) {
      if (point.tip_mm < at_mm - kBefore_mm || point.tip_mm > to_mm) continue;
      has_puncture = has_puncture || point.layer != haptics::kNoLayer;
      if (peak == nullptr) before_n = point.force_n;
      if (peak == nullptr || point.force_n > peak->force_n) peak = &point;
      after_n = point.force_n;
    }
    if (peak == nullptr || has_puncture || peak->force_n < std::max(before_n, after_n) + kStandsOut_n) continue;
    borders.push_back({pieces[i].name, at_mm, peak->tip_mm, peak->force_n});
  }
  return borders;
}

std::vector<PathPiece> pieces_along(const haptics::HapticScene& scene, const anatomy::TissueTable& tissues,
                                    const Segment& line_P) {
  constexpr double kStep_mm = 0.05;
  std::vector<PathPiece> pieces;
  const double length_mm = line_P.length_mm();
  const auto count = static_cast<int>(length_mm / kStep_mm);
  for (int i = 0; i <= count; ++i) {
    const double s_mm = kStep_mm * i;
    const haptics::TissueAt at = haptics::tissue_at(scene, line_P.a + s_mm * line_P.direction());
    if (at.tissue == 0) continue;  // rounding at the skin
    const anatomy::Label* label = at.tissue == scene.skin ? nullptr : scene.patient->label_table.find(at.label);
    const std::string tissue = tissues.tissues[at.tissue].name;
    const std::string name = label ? label->name : tissue;
    if (pieces.empty() || pieces.back().name != name)
      pieces.push_back({pieces.empty() ? 0.0 : s_mm, s_mm, name, tissue});
    pieces.back().to_mm = std::min(s_mm + kStep_mm, length_mm);
  }
  return pieces;
}

namespace {

/// 0 at the skin, 1 at the path's end, with continuous speed.
double share_of_drift(const PrescribedMotion& motion, double s_mm) noexcept {
  const double x = std::clamp(s_mm / std::max(motion.line_P.length_mm(), 1e-9), 0.0, 1.0);
  return x * x * (3.0 - 2.0 * x);
}

}  // namespace

int tick_count(const PrescribedMotion& motion) noexcept {
  const double step_mm = motion.speed_mm_per_s * motion.dt_s;
  return static_cast<int>((motion.before_mm + motion.line_P.length_mm() + motion.after_mm) / step_mm);
}

double way_mm(const PrescribedMotion& motion, int tick) noexcept {
  return motion.speed_mm_per_s * motion.dt_s * tick - motion.before_mm;
}

haptics::HapticInput input_at(const PrescribedMotion& motion, int tick) noexcept {
  const double s_mm = way_mm(motion, tick);
  const double share = share_of_drift(motion, s_mm);
  const Vec3 axis_P = motion.line_P.direction();
  const Vec3 tip_P = motion.line_P.a + s_mm * axis_P + share * motion.drift_P;
  const double angle_rad = share * motion.tilt_rad_P.norm();
  Mat3 R_PN = needle_pose(tip_P, axis_P).R();
  if (angle_rad > 0.0) R_PN = Eigen::AngleAxisd(angle_rad, motion.tilt_rad_P.normalized()).toRotationMatrix() * R_PN;
  haptics::HapticInput input;
  input.time_s = motion.dt_s * tick;
  input.dt_s = motion.dt_s;
  input.tool = telemetry::to_tool_pose({R_PN, tip_P});
  return input;
}

}  // namespace trocar::cases
