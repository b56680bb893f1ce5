#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "lab/ultrasound/test_scenes.h"
#include "lab/volume/correlation.h"
#include "ultrasound/sweep/mechanical_sweep.h"

namespace trocar::testing {

/// A small array on a motor, and tissue whose skin follows the dome of the swing. X_PT is the identity.
inline ultrasound::Transducer motor_probe() {
  ultrasound::Transducer transducer;
  transducer.name = "motor";
  transducer.kind = ultrasound::TransducerKind::kMechanicalConvex;
  transducer.frequency_mhz = 4.0;
  transducer.bandwidth = 0.25;  // its speckle is longer than a voxel
  transducer.radius_mm = 40.0;
  transducer.field_of_view_rad = 0.9;
  transducer.elevation_focus_mm = 45.0;
  transducer.sweep_rad = 0.8;
  transducer.sweep_radius_mm = 27.0;
  return transducer;
}

inline constexpr double kLabDepth_mm = 70.0;
/// Half a step between frames at the points' depth, and half a voxel.
inline constexpr double kPlace_mm = 0.8;

/// Off-centre on all axes, so that a swapped sign or axis is detected.
inline std::vector<ultrasound::AcousticPoint> lab_points() {
  return {{{8.0, 40.0, 5.0}, 24.0}, {{-12.0, 52.0, -9.0}, 24.0}, {{3.0, 30.0, -7.0}, 24.0}};
}

inline std::shared_ptr<const ultrasound::AcousticScene> lab_scene() {
  static const std::shared_ptr<const ultrasound::AcousticScene> scene = [] {
    const ultrasound::Transducer transducer = motor_probe();
    ultrasound::SceneBox box = ultrasound::box_for(transducer, kLabDepth_mm);
    box.half_thickness_mm = 50.0;
    const auto dome = [transducer](const Vec3& p) {
      const double y = std::hypot(p.y() + transducer.sweep_radius_mm, p.z()) - transducer.sweep_radius_mm;
      return transducer.radius_mm - std::hypot(p.x(), y + transducer.radius_mm);
    };
    ultrasound::AcousticScene made = ultrasound::paint_scene(
        box, ultrasound::test_table(),
        [](const Vec3&) { return ultrasound::index_of(ultrasound::TestTissue::kMinus12); }, dome);
    made.points = lab_points();
    return std::make_shared<const ultrasound::AcousticScene>(std::move(made));
  }();
  return scene;
}

/// The scene moved so that a transducer at X_PT images it as one at the identity imaged the original.
inline std::shared_ptr<const ultrasound::AcousticScene> moved(const ultrasound::AcousticScene& scene,
                                                              const Pose& X_PT) {
  ultrasound::AcousticScene made = scene;
  for (volume::GridGeometry* grid : {&made.geometry, &made.skin_distance_mm.geometry}) {
    grid->origin_P = X_PT * grid->origin_P;
    grid->R_PV = X_PT.R() * grid->R_PV;
  }
  for (ultrasound::AcousticPoint& point : made.points) point.p_P = X_PT * point.p_P;
  return std::make_shared<const ultrasound::AcousticScene>(std::move(made));
}

inline ultrasound::MechanicalSweepOptions lab_options() {
  ultrasound::MechanicalSweepOptions options;
  options.acquisition = ultrasound::default_acquisition(motor_probe());
  options.acquisition.depth_mm = kLabDepth_mm;
  options.acquisition.focus_mm = 40.0;
  options.acquisition.lines = 128;
  options.acquisition.samples = 512;
  options.acquisition.planes = 3;
  options.acquisition.steering_angles = 1;
  options.acquisition.artefacts.noise = false;
  options.sweep_rad = 0.8;
  options.step_rad = 0.02;
  return options;
}

/// Centre of the bright samples within 5 mm of a position, above most of the speckle.
inline Vec3 brightest_near(const volume::LabelGrid& volume, const Vec3& p_P) {
  constexpr double kReach_mm = 5.0;
  const volume::GridGeometry& grid = volume.geometry;
  int most = 0;
  Vec3 sum = Vec3::Zero();
  double weight = 0.0;
  for (const bool is_search : {true, false}) {
    for (std::size_t n = 0; n < grid.voxel_count(); ++n) {
      const volume::Index3 ijk = grid.index_of(n);
      const Vec3 q_P = grid.centre_mm(ijk);
      if ((q_P - p_P).norm() > kReach_mm) continue;
      const int gray = volume.voxels[n];
      if (is_search) most = std::max(most, gray);
      const double above = gray - 0.8 * most;
      if (is_search || above <= 0.0) continue;
      sum += above * q_P;
      weight += above;
    }
  }
  return weight > 0.0 ? Vec3(sum / weight) : Vec3::Constant(1e9);
}

}  // namespace trocar::testing
