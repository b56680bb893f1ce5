#include "xray/contrast/detail/vessel_course.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace trocar::xray::detail {
namespace {

constexpr double kDown_mm = 200.0, kUp_mm = 15.0;
constexpr double kProbe_mm = 0.4;  ///< Step of the search for the wall.
constexpr int kMostProbes = 50;    ///< Up to a radius of 20 mm.
constexpr int kProbeDirections = 8;
constexpr double kCentring = 0.35;   ///< Greatest sideways part of a step, relative to it.
constexpr double kNeedle_mm = 0.35;  ///< Radius of the stream at the tip, the needle's.
constexpr double kLeastFlow = 1.0;   ///< mm/s
constexpr std::size_t kDip = 5;      ///< Stations.
constexpr double kInertia = 0.5;     ///< Share of the direction so far in the next one.

using Station = VesselCourse::Station;

class Tracer {
 public:
  Tracer(const std::function<bool(const Vec3&)>& is_vessel, const std::function<Vec3(const Vec3&)>& flow)
      : is_vessel_(is_vessel), flow_(flow) {}

  double free_mm(const Vec3& p_P, const Vec3& out) const {
    int n = 1;
    while (n < kMostProbes && is_vessel_(p_P + n * kProbe_mm * out)) ++n;
    return (n - 0.5) * kProbe_mm;
  }

  /// Distance to the wall across a direction, and the offset of the section's middle.
  double lumen(const Vec3& p_P, const Vec3& along, Vec3& to_middle) const {
    const Vec3 u = along.unitOrthogonal();
    const Vec3 w = along.cross(u);
    double least = kMostProbes * kProbe_mm;
    to_middle = Vec3::Zero();
    for (int n = 0; n < kProbeDirections; ++n) {
      const double angle = 2.0 * std::numbers::pi * n / kProbeDirections;
      const Vec3 out = std::cos(angle) * u + std::sin(angle) * w;
      const double mm = free_mm(p_P, out);
      least = std::min(least, mm);
      to_middle += (2.0 / kProbeDirections) * mm * out;
    }
    return least;
  }

  /// Direction of the flow, or of the longest free way if there is no flow.
  Vec3 first_direction(const Vec3& p_P) const {
    const Vec3 flow = flow_(p_P);
    if (flow.norm() > kLeastFlow) return flow.normalized();
    Vec3 best = Vec3::UnitZ();
    double longest = 0.0;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        for (int k = 0; k <= 1; ++k) {
          if (i == 0 && j == 0 && k == 0) continue;
          const Vec3 out = Vec3(i, j, k).normalized();
          const double mm = free_mm(p_P, out) + free_mm(p_P, -out);
          if (mm <= longest) continue;
          longest = mm;
          best = out;
        }
    return best;
  }

  /// Stations after a first one, along the flow (sign 1) or against it (-1).
  std::vector<Station> follow(const Station& first, double sign, double length_mm) const {
    std::vector<Station> stations;
    Vec3 p_P = first.p_P, direction = sign * first.along_P;
    for (double mm = 0.0; mm < length_mm; mm += VesselCourse::kStep_mm) {
      const Vec3 flow = sign * flow_(p_P);
      if (flow.norm() > kLeastFlow) {
        const Vec3 mean = kInertia * direction + (1.0 - kInertia) * flow.normalized();
        if (mean.norm() > 1e-3) direction = mean.normalized();
      }
      Vec3 to_middle = Vec3::Zero();
      lumen(p_P, direction, to_middle);
      const double sideways_mm = std::min(0.5 * to_middle.norm(), kCentring * VesselCourse::kStep_mm);
      Vec3 step = VesselCourse::kStep_mm * direction;
      if (sideways_mm > 1e-9) step += sideways_mm * to_middle.normalized();
      step = VesselCourse::kStep_mm * step.normalized();
      if (!is_vessel_(p_P + step)) break;
      p_P += step;
      direction = step.normalized();
      Station station;
      station.p_P = p_P;
      station.along_P = sign * direction;
      stations.push_back(station);
    }
    return stations;
  }

 private:
  const std::function<bool(const Vec3&)>& is_vessel_;
  const std::function<Vec3(const Vec3&)>& flow_;
};

/// Mean of neighbouring directions; axes across that do not twist.
void smooth_axes(std::vector<Station>& stations) {
  const std::vector<Station> before = stations;
  for (std::size_t n = 0; n < stations.size(); ++n) {
    Vec3 sum = Vec3::Zero();
    for (std::size_t m = n >= 2 ? n - 2 : 0; m <= std::min(n + 2, stations.size() - 1); ++m) sum += before[m].along_P;
    if (sum.norm() > 1e-3) stations[n].along_P = sum.normalized();
    const Vec3 u = n == 0 ? stations[n].along_P.unitOrthogonal() : stations[n - 1].u_P;
    const Vec3 across = u - u.dot(stations[n].along_P) * stations[n].along_P;
    stations[n].u_P = across.norm() > 1e-3 ? Vec3(across.normalized()) : stations[n].along_P.unitOrthogonal();
    stations[n].w_P = stations[n].along_P.cross(stations[n].u_P);
  }
}

/// Fills dips of the lumen that are shorter than twice kDip stations (morphological closing): corners of a confluence.
void close_dips(std::vector<Station>& stations) {
  const auto filter = [&](const auto& better) {
    std::vector<double> result(stations.size());
    for (std::size_t n = 0; n < stations.size(); ++n) {
      result[n] = stations[n].lumen_mm;
      for (std::size_t m = n >= kDip ? n - kDip : 0; m <= std::min(n + kDip, stations.size() - 1); ++m)
        result[n] = better(result[n], stations[m].lumen_mm);
    }
    for (std::size_t n = 0; n < stations.size(); ++n) stations[n].lumen_mm = result[n];
  };
  filter([](double a, double b) { return std::max(a, b); });
  filter([](double a, double b) { return std::min(a, b); });
}

}  // namespace

VesselCourse::Station VesselCourse::at(double place_mm) const {
  const double x = std::clamp((place_mm - first_mm) / kStep_mm, 0.0, static_cast<double>(stations.size() - 1));
  const auto n = std::min(static_cast<std::size_t>(x), stations.size() - 1);
  const Station& a = stations[n];
  const Station& b = stations[std::min(n + 1, stations.size() - 1)];
  const double f = x - static_cast<double>(n);
  return {(1.0 - f) * a.p_P + f * b.p_P,         f < 0.5 ? a.along_P : b.along_P,
          (1.0 - f) * a.u_P + f * b.u_P,         (1.0 - f) * a.w_P + f * b.w_P,
          std::lerp(a.lumen_mm, b.lumen_mm, f),  std::lerp(a.stream_mm, b.stream_mm, f),
          std::lerp(a.swept_mm3, b.swept_mm3, f)};
}

VesselCourse find_vessel_course(const Vec3& tip_P, const std::function<bool(const Vec3&)>& is_vessel,
                                const std::function<Vec3(const Vec3&)>& flow, double slope) {
  const Tracer tracer(is_vessel, flow);
  Station tip;
  tip.p_P = tip_P;
  tip.along_P = tracer.first_direction(tip_P);
  VesselCourse course;
  const std::vector<Station> down = tracer.follow(tip, 1.0, kDown_mm);
  const std::vector<Station> up = tracer.follow(tip, -1.0, kUp_mm);
  course.stations.assign(up.rbegin(), up.rend());
  const std::size_t middle = course.stations.size();
  course.stations.push_back(tip);
  course.stations.insert(course.stations.end(), down.begin(), down.end());
  course.first_mm = -VesselCourse::kStep_mm * static_cast<double>(middle);
  smooth_axes(course.stations);
  for (Station& station : course.stations) {
    Vec3 to_middle = Vec3::Zero();
    station.lumen_mm = tracer.lumen(station.p_P, station.along_P, to_middle);
  }
  close_dips(course.stations);
  // From the tip in both directions.
  std::vector<Station>& stations = course.stations;
  const double growth_mm = slope * VesselCourse::kStep_mm;
  stations[middle].stream_mm = std::min(kNeedle_mm, stations[middle].lumen_mm);
  for (std::size_t n = middle + 1; n < stations.size(); ++n)
    stations[n].stream_mm = std::min(stations[n].lumen_mm, stations[n - 1].stream_mm + growth_mm);
  for (std::size_t n = middle; n-- > 0;)
    stations[n].stream_mm = std::min(stations[n].lumen_mm, stations[n + 1].stream_mm + growth_mm);
  for (std::size_t n = 1; n < stations.size(); ++n) {
    const double a = stations[n - 1].stream_mm, b = stations[n].stream_mm;
    stations[n].swept_mm3 = stations[n - 1].swept_mm3 + VesselCourse::kStep_mm * (a * a + a * b + b * b) / 3.0;
  }
  return course;
}

}  // namespace trocar::xray::detail
