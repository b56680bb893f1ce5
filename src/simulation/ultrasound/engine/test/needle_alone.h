#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "lab/ultrasound/test_scenes.h"
#include "ultrasound/engine/b_mode.h"
#include "ultrasound/engine/detail/needle_image.h"
#include "ultrasound/engine/detail/point_spread.h"

/// Needles in pictures, for tests.
namespace trocar::testing {

using namespace ultrasound::detail;  // NOLINT: tests only

inline constexpr double kPi = std::numbers::pi;

inline ultrasound::Transducer default_convex() {
  ultrasound::Transducer transducer;
  transducer.name = "convex";
  return transducer;
}

inline ultrasound::Acquisition shallow(int lines = 128, int samples = 640) {
  ultrasound::Acquisition acquisition;
  acquisition.depth_mm = 100.0;
  acquisition.focus_mm = 60.0;
  acquisition.lines = lines;
  acquisition.samples = samples;
  acquisition.steering_angles = 1;
  acquisition.artefacts.downshift = false;  // the beam's width as at the face
  return acquisition;
}

inline ultrasound::BMode engine_in(ultrasound::TestTissue tissue) {
  return {ultrasound::homogeneous_scene(ultrasound::box_for(default_convex(), 100.0, 2.0), tissue), default_convex(),
          shallow()};
}

/// Renders the echoes of needles only, like the engine in a medium without loss and scatterers.
class NeedleAlone {
 public:
  explicit NeedleAlone(const ultrasound::Acquisition& acquisition = shallow())
      : scene(ultrasound::homogeneous_scene(ultrasound::box_for(default_convex(), 100.0, 3.0),
                                            ultrasound::TestTissue::kWater)),
        plan(make_scan_plan(*scene, default_convex(), acquisition)),
        frame(make_frame_state(*scene)),
        image(make_needle_image(plan)),
        rows(plan) {
    fit_frame(frame, plan);
    out.geometry = plan.geometry;
    out.beam = plan.beam;
    out.re.resize(static_cast<std::size_t>(plan.lines * plan.samples));
    out.im = out.re;
  }

  const ultrasound::BasebandFrame& render(const ultrasound::BModeInput& input) {
    std::fill(frame.re.begin(), frame.re.end(), 0.0F);
    std::fill(frame.im.begin(), frame.im.end(), 0.0F);
    std::fill(frame.way_gain.begin(), frame.way_gain.end(), 1.0F);
    lay_out_needles(plan, frame, input.needles, image);
    for (int first = 0; first < plan.lines; first += kGroup)
      add_needles(plan, frame, image, first, std::min(first + kGroup, plan.lines));
    for (int line = 0; line < plan.lines; ++line) spread_echoes(plan, frame, line, rows, out);
    return out;
  }

  ultrasound::ScenePtr scene;
  ScanPlan plan;
  FrameState frame;
  NeedleImage image;
  SteeringRows rows;
  ultrasound::BasebandFrame out;
};

/// A straight shaft that ends at `tip`.
inline std::vector<Vec3> shaft_to(const Vec3& tip, const Vec3& direction, double length_mm = 120.0) {
  return {tip - length_mm * direction.normalized(), tip};
}
/// In the picture's plane, at that angle to the middle scanline.
inline Vec3 in_plane(double angle_rad) {
  return {std::sin(angle_rad), std::cos(angle_rad), 0.0};
}

inline ultrasound::NeedleEcho needle_of(const std::vector<Vec3>& shaft) {
  ultrasound::NeedleEcho needle;
  needle.shaft_P = shaft;
  return needle;
}

template <class Engine>
inline ultrasound::BasebandFrame seen(Engine& engine, const ultrasound::NeedleEcho& needle) {
  ultrasound::BModeInput input;
  input.needles = {&needle, 1};
  return engine.render(input);
}

inline double db(double amplitude) {
  return 20.0 * std::log10(std::max(amplitude, 1e-9));
}

inline double envelope(const ultrasound::BasebandFrame& frame, int line, int sample) {
  const auto at = static_cast<std::size_t>(line * frame.geometry.samples + sample);
  return std::hypot(static_cast<double>(frame.re[at]), static_cast<double>(frame.im[at]));
}

struct LinePeak {
  double depth_mm = 0.0, level_db = -1e9;
};
/// The brightest sample of a scanline between two depths, with its position refined by a parabola.
inline LinePeak peak_of(const ultrasound::BasebandFrame& frame, int line, double from_mm = 2.0, double to_mm = 99.0) {
  const double mm = frame.geometry.sample_mm();
  int best = static_cast<int>(from_mm / mm);
  for (int s = best; s < static_cast<int>(to_mm / mm); ++s)
    if (envelope(frame, line, s) > envelope(frame, line, best)) best = s;
  const double a = db(envelope(frame, line, best - 1)), b = db(envelope(frame, line, best)),
               c = db(envelope(frame, line, best + 1));
  const double bow = a - 2.0 * b + c;
  const double shift = bow < -1e-6 ? 0.5 * (a - c) / bow : 0.0;
  return {(best + 0.5 + shift) * mm, b - 0.25 * (a - c) * shift};
}

}  // namespace trocar::testing
