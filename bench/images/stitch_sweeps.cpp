#include "bench/images/stitch_sweeps.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/files/folders.h"
#include "phantom/phantom.h"
#include "ultrasound/probe/probe_placement.h"
#include "ultrasound/sweep/mechanical_sweep.h"
#include "ultrasound/sweep/tracked_sequence.h"
#include "ultrasound/tissue/acoustic_scene.h"

namespace trocar::bench {
namespace {

constexpr int kSweeps = 6;
constexpr double kDepth_mm = 120.0;

Mat3 turn(double deg, const Vec3& axis) {
  return Eigen::AngleAxisd(radians(deg), axis).toRotationMatrix();
}

/// Poses beside each other on the skin, rocked, twisted and tilted in turn.
Pose sweep_pose(const Pose& X_PT, int n, double turn_deg) {
  const double side = n - 0.5 * (kSweeps - 1);
  const Mat3 R = turn(0.55 * turn_deg * side, Vec3::UnitZ()) * turn(n % 2 == 1 ? 0.6 * turn_deg : 0.0, Vec3::UnitY()) *
                 turn(0.3 * turn_deg * (n % 3 - 1), Vec3::UnitX());
  return X_PT * Pose(R, Vec3(9.0 * side, 0.0, n % 2 == 1 ? 3.0 : -3.0));
}

/// The header of `trocar ultrasound sweep`.
registration::HeaderFields header_of(const ultrasound::SweepGeometry& sweep, const ultrasound::Transducer& transducer) {
  return {{"trocar_apex_mm", fmt::format("0 {:.9g} 0", -sweep.scan.radius_mm)},
          {"trocar_radius_mm", fmt::format("{:.9g}", sweep.scan.radius_mm)},
          {"trocar_depth_mm", fmt::format("{:.9g}", sweep.scan.depth_mm)},
          {"trocar_fov_rad", fmt::format("{:.9g}", transducer.field_of_view_rad)},
          {"trocar_beam_axis", "+y"},
          {"trocar_sweep_rad", fmt::format("{:.9g}", sweep.sweep_rad)},
          {"trocar_sweep_radius_mm", fmt::format("{:.9g}", sweep.radius_mm)}};
}

}  // namespace

Result<SweepScene> open_sweep_scene() {
  SweepScene result;
  const std::filesystem::path data = data_dir();
  TROCAR_TRY(const auto views, ultrasound::load_probe_views(data / "views.toml"));
  TROCAR_TRY(result.transducer, ultrasound::load_transducer(data / "transducers.toml", "4DC7-3"));
  TROCAR_TRY(ultrasound::AcousticTable table, ultrasound::load_acoustic_table(data / "acoustics.toml"));
  TROCAR_TRY(const anatomy::VirtualPatient patient, phantom::generate_phantom("abdomen", 1));
  TROCAR_TRY(const ultrasound::ProbeView view, ultrasound::choose_view(patient, views, "diaphragm"));
  TROCAR_TRY(const ultrasound::ProbePlacement placed, ultrasound::place_probe(patient, view, result.transducer));
  result.X_PT = placed.X_PT;
  TROCAR_TRY(result.scene, ultrasound::make_acoustic_scene(patient, std::move(table)));
  return result;
}

Result<std::vector<KnownVolume>> make_sweeps(const SweepScene& scene, double turn_deg, bool is_straight) {
  std::vector<KnownVolume> sweeps;
  for (int n = 0; n < kSweeps; ++n) {
    ultrasound::MechanicalSweepOptions options;
    options.acquisition = ultrasound::default_acquisition(scene.transducer);
    options.acquisition.depth_mm = kDepth_mm;
    options.spacing_mm = 1.0;
    options.seed = static_cast<std::uint64_t>(n + 1);
    if (is_straight) {
      TROCAR_TRY_STATUS(ultrasound::switch_off(options.acquisition.artefacts, "refraction"));
      TROCAR_TRY_STATUS(ultrasound::switch_off(options.acquisition.artefacts, "range-distortion"));
    }
    const Pose X_PT = sweep_pose(scene.X_PT, n, turn_deg);
    TROCAR_TRY(ultrasound::SweepVolume sweep,
               ultrasound::make_mechanical_sweep(scene.scene, scene.transducer, X_PT, options));
    TROCAR_TRY(const registration::Beams beams,
               registration::Beams::from_header(header_of(sweep.geometry, scene.transducer), sweep.gray.geometry));
    sweeps.push_back({std::move(sweep.gray), beams, X_PT});
  }
  return sweeps;
}

Result<MainDirections> main_directions(const ultrasound::TrackedSequence& sequence,
                                       const volume::GridGeometry& geometry) {
  const auto pose_of = [&](const ultrasound::TrackedSequence::Frame& frame) {
    ultrasound::TransformGraph graph;
    graph.add(frame.transforms);
    return graph.find("Image", "Reference");
  };
  const auto first = pose_of(sequence.frames.front()), last = pose_of(sequence.frames.back());
  if (!first || !last) return fail("the sweep has no poses", {}, "give a tracked sweep");
  MainDirections directions;
  const Vec3 motion_V = geometry.R_PV.transpose() * (last->topRightCorner<3, 1>() - first->topRightCorner<3, 1>());
  motion_V.cwiseAbs().maxCoeff(&directions.motion);
  const Vec3 beam_V = geometry.R_PV.transpose() * first->block<3, 1>(0, 1);
  int axis = 0;
  beam_V.cwiseAbs().maxCoeff(&axis);
  directions.beam = fmt::format("{}{}", beam_V[axis] > 0.0 ? '+' : '-', static_cast<char>('x' + axis));
  return directions;
}

}  // namespace trocar::bench
