#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/files/folders.h"
#include "lab/ultrasound/image_statistics.h"
#include "lab/ultrasound/speckle_statistics.h"
#include "lab/ultrasound/test_scenes.h"
#include "ultrasound/engine/b_mode.h"

/// Common parts of the tests of the engine's physics: shipped transducers in front of scenes with a single object.
namespace trocar::testing {

inline ultrasound::Transducer shipped(std::string_view name) {
  const auto transducer = ultrasound::load_transducer(data_dir() / "transducers.toml", name);
  EXPECT_TRUE(transducer) << name;
  return transducer ? *transducer : ultrasound::Transducer{};
}
inline ultrasound::Transducer convex() {
  return shipped("C5-2");
}
inline ultrasound::Transducer linear() {
  return shipped("L14-5");
}

inline ultrasound::Artefacts no_artefacts() {
  ultrasound::Artefacts none;
  none.attenuation = none.downshift = none.reverberation = none.mirror = none.refraction = none.range_distortion =
      none.side_lobes = none.contact_loss = none.clutter = none.noise = false;
  return none;
}

/// Attenuation alone.
inline ultrasound::Artefacts losses() {
  ultrasound::Artefacts artefacts = no_artefacts();
  artefacts.attenuation = true;
  return artefacts;
}

/// The transducer's own settings without artefacts.
inline ultrasound::Acquisition plain(const ultrasound::Transducer& transducer,
                                     ultrasound::Artefacts artefacts = no_artefacts()) {
  ultrasound::Acquisition acquisition = ultrasound::default_acquisition(transducer);
  acquisition.artefacts = artefacts;
  return acquisition;
}

/// The scene with its table changed.
template <class Change>
ultrasound::ScenePtr with_table(const ultrasound::ScenePtr& scene, const Change& change) {
  auto copy = std::make_shared<ultrasound::AcousticScene>(*scene);
  change(copy->table);
  return copy;
}

/// Position in the frame of a point (x, y) at the identity pose.
inline ultrasound::Polar polar_of(const ultrasound::BasebandFrame& frame, double x_mm, double y_mm) {
  return frame.geometry.to_polar(ultrasound::Vec2(x_mm, y_mm));
}

/// Samples of a rectangle |x - x0| < half_width, y0..y1 of the picture's plane, at the identity pose.
inline ultrasound::EchoPatch patch_at(const ultrasound::BasebandFrame& frame, double x0_mm, double half_width_mm,
                                      double y0_mm, double y1_mm) {
  const double middle_mm = 0.5 * (y0_mm + y1_mm);
  ultrasound::PatchBounds bounds;
  bounds.first_line = static_cast<int>(std::ceil(polar_of(frame, x0_mm - half_width_mm, middle_mm).line));
  bounds.last_line = static_cast<int>(std::floor(polar_of(frame, x0_mm + half_width_mm, middle_mm).line)) + 1;
  const double back_mm = polar_of(frame, x0_mm, middle_mm).depth_mm - middle_mm;
  bounds.near_mm = y0_mm + back_mm;
  bounds.far_mm = y1_mm + back_mm;
  return ultrasound::envelope_patch(frame, bounds);
}

inline double root_mean_square(const ultrasound::EchoPatch& patch) {
  double sum = 0.0;
  for (const float value : patch.values) sum += static_cast<double>(value) * value;
  return patch.values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(patch.values.size()));
}

inline double level_db(const ultrasound::EchoPatch& patch) {
  return 20.0 * std::log10(root_mean_square(patch) + 1e-12);
}

/// The brightest sample of a patch.
struct Peak {
  int line = 0, sample = 0;  ///< Indices in the patch.
  double amplitude = 0.0;
};
inline Peak peak_of(const ultrasound::EchoPatch& patch) {
  Peak peak;
  for (int line = 0; line < patch.lines; ++line)
    for (int sample = 0; sample < patch.samples; ++sample)
      if (patch.at(line, sample) > peak.amplitude) peak = {line, sample, patch.at(line, sample)};
  return peak;
}

/// Full width at half of the peak, in steps, of a curve with one peak; linear between values. NaN: the curve does not
/// fall to half.
inline double full_width(const std::vector<double>& curve) {
  const auto top = static_cast<std::size_t>(std::max_element(curve.begin(), curve.end()) - curve.begin());
  const double half = 0.5 * curve[top];
  double left = std::nan(""), right = std::nan("");
  for (std::size_t i = top; i > 0; --i)
    if (curve[i - 1] < half) {
      left = static_cast<double>(i) - (curve[i] - half) / (curve[i] - curve[i - 1]);
      break;
    }
  for (std::size_t i = top; i + 1 < curve.size(); ++i)
    if (curve[i + 1] < half) {
      right = static_cast<double>(i) + (curve[i] - half) / (curve[i] - curve[i + 1]);
      break;
    }
  return right - left;
}

/// Frames at this distance in elevation contain other scatterers.
inline constexpr double kFrameStep_mm = 12.0;
inline Pose at_elevation(double z_mm) {
  return Pose::translation(Vec3(0.0, 0.0, z_mm));
}

}  // namespace trocar::testing
