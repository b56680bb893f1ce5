// Stitching of volumes with known poses: generated ones, sweeps of the embedded patient, parts of recorded sweeps.

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "bench/benchmarks.h"
#include "bench/images/stitch_sweeps.h"
#include "bench/real_data.h"
#include "core/random.h"
#include "io/image/image_file.h"
#include "io/sequence/sequence_file.h"
#include "lab/registration/volume_series.h"
#include "registration/panorama/stitch.h"
#include "ultrasound/sweep/freehand.h"
#include "volume/sampling.h"

namespace trocar::bench {
namespace {
namespace fs = std::filesystem;

/// Errors between neighbours, and the volumes that were placed.
struct Outcome {
  std::vector<double> mean_mm, max_mm;
  std::size_t placed = 0, volumes = 0;
};

Result<Outcome> stitch_known(std::vector<KnownVolume> known, Outcome outcome) {
  std::vector<registration::PreparedVolume> volumes;
  std::vector<Pose> X_WU;
  for (KnownVolume& volume : known) {
    X_WU.push_back(volume.X_WU);
    TROCAR_TRY(registration::PreparedVolume prepared,
               registration::prepare(fmt::format("volume {}", volumes.size()), std::move(volume.gray), volume.beams));
    volumes.push_back(std::move(prepared));
  }
  TROCAR_TRY(const registration::Stitching stitching, registration::stitch(volumes));
  outcome.volumes += volumes.size() - 1;
  for (std::size_t n = 1; n < volumes.size(); ++n) {
    if (!stitching.X_0N[n]) continue;
    ++outcome.placed;
    if (!stitching.X_0N[n - 1]) continue;
    const registration::TargetError error = registration::target_error(
        volumes[n - 1].region.usable, volumes[n].region.usable, X_WU[n - 1].inverse() * X_WU[n],
        stitching.X_0N[n - 1]->inverse() * *stitching.X_0N[n]);
    outcome.mean_mm.push_back(error.mean_mm);
    outcome.max_mm.push_back(error.max_mm);
  }
  return outcome;
}

void add_outcome(std::vector<CaseResult>& results, const std::string& name, const Outcome& outcome,
                 const std::string& what) {
  Figures figures = figures_of(outcome.mean_mm);
  const double worst = outcome.max_mm.empty() ? 0.0 : *std::max_element(outcome.max_mm.begin(), outcome.max_mm.end());
  results.push_back({"stitch/" + name,
                     "mm",
                     figures,
                     {},
                     fmt::format("{}; {} of {} placed; mean error of neighbours over their overlap, largest error of "
                                 "all targets {:.2f} mm",
                                 what, outcome.placed, outcome.volumes, worst),
                     {{"placed", static_cast<double>(outcome.placed)},
                      {"volumes", static_cast<double>(outcome.volumes)},
                      {"largest_mm", worst}}});
}

Result<Outcome> stitch_series(const registration::SeriesOptions& options, std::uint64_t first_seed, int seeds) {
  Outcome outcome;
  for (std::uint64_t seed = first_seed; seed < first_seed + static_cast<std::uint64_t>(seeds); ++seed) {
    std::vector<KnownVolume> known;
    for (registration::GeneratedVolume& v : registration::make_volume_series(options, seed)) {
      TROCAR_TRY(const registration::Beams beams, registration::Beams::along_axis("+z", v.gray.geometry));
      known.push_back({std::move(v.gray), beams, v.X_WU});
    }
    TROCAR_TRY(outcome, stitch_known(std::move(known), std::move(outcome)));
  }
  return outcome;
}

Status measure_generated(const Progress& progress, std::vector<CaseResult>& results) {
  constexpr int kSeeds = 3;
  registration::SeriesOptions options;
  const auto measure = [&](const std::string& name, const std::string& what) -> Status {
    core::report(progress, name, 0.0);
    TROCAR_TRY(const Outcome outcome, stitch_series(options, 100, kSeeds));
    add_outcome(results, name, outcome,
                fmt::format("{}, {} seeds of six half-overlapping volumes of 96^3 at 1 mm", what, kSeeds));
    return {};
  };
  TROCAR_TRY_STATUS(measure("half-overlap", "speckle and shadows of their own, 15 degrees between neighbours"));
  options.has_varied_controls = true;
  TROCAR_TRY_STATUS(measure("half-overlap-controls", "the same with other gain, TGC and gray map each"));
  options.has_varied_controls = false;
  options.turn_deg = 30.0;
  TROCAR_TRY_STATUS(measure("half-overlap-30deg", "30 degrees between neighbours"));
  options.turn_deg = 15.0;
  options.density = 0.5;
  TROCAR_TRY_STATUS(measure("half-overlap-sparse", "half as many vessels and ellipsoids"));
  return {};
}

/// Differences that a rigid motion cannot explain: the largest of the steps that is still stitched is reported.
Status measure_affine(const Progress& progress, std::vector<CaseResult>& results) {
  for (const double part : {0.01, 0.03, 0.06, 0.10}) {
    for (const bool is_shear : {false, true}) {
      registration::SeriesOptions options;
      options.volumes = 3;
      (is_shear ? options.shear : options.scale) = is_shear ? part : 1.0 + part;
      const std::string name = fmt::format("{}-{:.0f}percent", is_shear ? "shear" : "scale", 100.0 * part);
      core::report(progress, name, 0.0);
      TROCAR_TRY(const Outcome outcome, stitch_series(options, 200, 2));
      add_outcome(results, name, outcome,
                  "every second volume distorted about its middle; the error contains the distortion's own mean");
    }
  }
  return {};
}

Status measure_sweeps(const Progress& progress, std::vector<CaseResult>& results) {
  TROCAR_TRY(const SweepScene scene, open_sweep_scene());
  for (const double turn_deg : {25.0, 40.0}) {
    for (const bool is_straight : {true, false}) {
      const std::string name = fmt::format("sweeps-{:.0f}deg{}", turn_deg, is_straight ? "" : "-distorted");
      core::report(progress, name, 0.0);
      TROCAR_TRY(std::vector<KnownVolume> sweeps, make_sweeps(scene, turn_deg, is_straight));
      TROCAR_TRY(const Outcome outcome, stitch_known(std::move(sweeps), Outcome()));
      add_outcome(results, name, outcome,
                  is_straight
                      ? "six sweeps of the embedded patient, 1 mm, refraction and range distortion off"
                      : "the same with refraction and range distortion: positions in the pictures are not rigid");
    }
  }
  return {};
}

/// Parts of a recorded volume, each moved by a known pose: resampled along its axis of motion.
Result<std::vector<KnownVolume>> cut_parts(const volume::LabelGrid& whole, int axis, std::string_view beam_axis) {
  Random random(9);
  std::vector<KnownVolume> parts;
  const auto a = static_cast<std::size_t>(axis);
  const std::int64_t length = whole.geometry.size[a];
  for (int n = 0; n < 3; ++n) {
    volume::GridGeometry part = whole.geometry;
    part.size[a] = length / 2;
    Vec3 first = Vec3::Zero();
    first[axis] = static_cast<double>(n) * 0.25 * static_cast<double>(length);
    const Vec3 turn_axis = Vec3(random.normal(), random.normal(), random.normal()).normalized();
    const Mat3 turn = n == 0 ? Mat3(Mat3::Identity()) : Eigen::AngleAxisd(radians(10.0), turn_axis).toRotationMatrix();
    const Vec3 half = 0.5 * Vec3(static_cast<double>(part.size[0] - 1), static_cast<double>(part.size[1] - 1),
                                 static_cast<double>(part.size[2] - 1));
    // The part in its own frame: an upright grid at the origin. X_WU turns it about its middle.
    const Vec3 middle_W = whole.geometry.to_mm(first + half);
    part.origin_P = Vec3::Zero();
    part.R_PV = Mat3::Identity();
    const Mat3 R_WU = turn * whole.geometry.R_PV;
    const Pose X_WU(R_WU, middle_W - R_WU * half.cwiseProduct(part.spacing_mm));
    volume::LabelGrid gray(part);
    for (std::size_t v = 0; v < gray.voxels.size(); ++v) {
      const Vec3 p_W = X_WU * part.centre_mm(part.index_of(v));
      const bool is_known = volume::sample_nearest(whole, p_W, std::uint8_t{0}) != 0;
      gray.voxels[v] = is_known ? static_cast<std::uint8_t>(std::lround(volume::sample_linear(whole, p_W))) : 0;
    }
    TROCAR_TRY(const registration::Beams beams, registration::Beams::along_axis(beam_axis, part));
    parts.push_back({std::move(gray), beams, X_WU});
  }
  return parts;
}

Status measure_recorded(const Progress& progress, std::vector<CaseResult>& results) {
  const fs::path liver = real_data() / "us-liver-sweep" / "liver_sweep_decoded.igs.mha";
  if (fs::exists(liver)) {
    core::report(progress, "recorded liver sweep", 0.0);
    TROCAR_TRY(const ultrasound::TrackedSequence sequence, io::read_sequence(liver));
    ultrasound::FreehandOptions options;
    options.spacing_mm = Vec3::Constant(1.0);
    options.is_black_left_out = true;
    options.holes = {ultrasound::HoleFilling{}};
    TROCAR_TRY(const ultrasound::FreehandVolume volume, ultrasound::reconstruct_freehand(sequence, {}, options));
    TROCAR_TRY(const MainDirections axes, main_directions(sequence, volume.gray.geometry));
    TROCAR_TRY(std::vector<KnownVolume> parts, cut_parts(volume.gray, axes.motion, axes.beam));
    TROCAR_TRY(const Outcome outcome, stitch_known(std::move(parts), Outcome()));
    add_outcome(results, "recorded-liver", outcome,
                "three half-overlapping parts of the recorded sweep, turned by 10 degrees");
  }
  const fs::path spine = real_data() / "us-spine-phantom" / "vtkVolumeReconstructorTestNNMEANvolumeRef.mha";
  if (fs::exists(spine)) {
    core::report(progress, "spine phantom", 0.0);
    std::vector<std::string> warnings;  // a file of one byte a voxel has none
    TROCAR_TRY(const volume::LabelGrid volume, io::read_gray_levels(spine, warnings));
    TROCAR_TRY(std::vector<KnownVolume> parts, cut_parts(volume, 0, "+y"));
    TROCAR_TRY(const Outcome outcome, stitch_known(std::move(parts), Outcome()));
    add_outcome(results, "recorded-spine-phantom", outcome,
                "three half-overlapping parts at 0.5 mm, turned by 10 degrees");
  }
  return {};
}

}  // namespace

Result<std::vector<CaseResult>> run_stitch_benchmark(const Options& options) {
  std::vector<CaseResult> results;
  TROCAR_TRY_STATUS(measure_generated(options.progress, results));
  TROCAR_TRY_STATUS(measure_sweeps(options.progress, results));
  TROCAR_TRY_STATUS(measure_recorded(options.progress, results));
  TROCAR_TRY_STATUS(measure_affine(options.progress, results));
  return results;
}

}  // namespace trocar::bench
