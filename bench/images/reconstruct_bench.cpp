// Freehand reconstruction: a synthetic sweep, and recorded ones if the test data are next to the checkout, with the
// similarity of the spine phantom to PLUS' volume.

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "bench/benchmarks.h"
#include "bench/real_data.h"
#include "core/files/folders.h"
#include "core/random.h"
#include "io/image/image_file.h"
#include "io/sequence/plus_config.h"
#include "io/sequence/sequence_file.h"
#include "lab/volume/correlation.h"
#include "ultrasound/sweep/freehand.h"

namespace trocar::bench {
namespace {
namespace fs = std::filesystem;

/// 100 images of 640 by 480 pixels of 0.3 mm in a tilting sweep, filled with speckle.
ultrasound::TrackedSequence made_sweep() {
  ultrasound::TrackedSequence sequence;
  sequence.columns = 640;
  sequence.rows = 480;
  sequence.frames.resize(100);
  sequence.pixels.resize(sequence.frame_pixels() * sequence.frames.size());
  Random random(1);
  for (auto& pixel : sequence.pixels) pixel = static_cast<std::uint8_t>(1 + random.next() % 255);
  for (std::size_t n = 0; n < sequence.frames.size(); ++n) {
    const double angle_rad = 0.006 * static_cast<double>(n);
    const Eigen::Affine3d T_PI = Eigen::Translation3d(0.0, 0.0, 0.2 * static_cast<double>(n)) *
                                 Eigen::AngleAxisd(angle_rad, Vec3::UnitX()) * Eigen::Scaling(0.3);
    sequence.frames[n].transforms.emplace("ImageToReference", T_PI.matrix());
  }
  return sequence;
}

std::string note_of(const ultrasound::FreehandVolume& volume) {
  const auto& size = volume.gray.geometry.size;
  return fmt::format("{} frames, {}x{}x{} voxels, {} holes filled", volume.frames_used, size[0], size[1], size[2],
                     volume.holes_filled);
}

/// Times one reconstruction and returns its volume.
Result<ultrasound::FreehandVolume> measure(const std::string& name, const ultrasound::TrackedSequence& sequence,
                                           const io::PlusConfig& config, std::vector<CaseResult>& results) {
  TROCAR_TRY(ultrasound::FreehandVolume volume,
             ultrasound::reconstruct_freehand(sequence, config.transforms, config.reconstruction));
  const Figures figures = time_ms(
      0, kRounds, [&] { (void)ultrasound::reconstruct_freehand(sequence, config.transforms, config.reconstruction); });
  results.push_back({name, "ms", figures, {}, note_of(volume)});
  return volume;
}

Status measure_spine_phantom(const fs::path& folder, std::vector<CaseResult>& results) {
  TROCAR_TRY(const ultrasound::TrackedSequence sequence, io::read_sequence(folder / "SpinePhantomFreehand.igs.mha"));
  TROCAR_TRY(io::PlusConfig config,
             io::read_plus_config(folder / "PlusDeviceSet_VolumeReconstructionOnly_SpinePhantom_NN_MEAN.xml"));
  TROCAR_TRY(const volume::LabelGrid reference,
             io::read_labels(folder / "vtkVolumeReconstructorTestNNMEANvolumeRef.mha"));
  TROCAR_TRY(const ultrasound::FreehandVolume volume, measure("reconstruct/spine-phantom", sequence, config, results));
  if (!volume.gray.geometry.matches(reference.geometry))
    return fail("the grid is not that of PLUS", folder.string(), "see docs/physics.md U12");
  const auto add = [&](const char* name, volume::ComparedVoxels voxels, const char* note) {
    Figures figures;
    figures.median = volume::correlation(volume.gray.voxels, reference.voxels, voxels);
    results.push_back({name, "ratio", figures, {}, note});
  };
  add("reconstruct/spine-phantom-ncc", volume::ComparedVoxels::kAll, "with PLUS' volume, all voxels");
  add("reconstruct/spine-phantom-ncc-both", volume::ComparedVoxels::kBothAboveZero,
      "with PLUS' volume, where both have echoes");
  config.reconstruction.interpolation = ultrasound::FreehandInterpolation::kLinear;
  TROCAR_TRY(const ultrasound::FreehandVolume linear,
             measure("reconstruct/spine-phantom-linear", sequence, config, results));
  return {};
}

}  // namespace

Result<std::vector<CaseResult>> run_reconstruct_benchmark() {
  std::vector<CaseResult> results;
  io::PlusConfig made;
  made.reconstruction.spacing_mm = Vec3::Constant(0.7);
  made.reconstruction.is_black_left_out = true;
  made.reconstruction.holes = {ultrasound::HoleFilling{}};
  TROCAR_TRY(const ultrasound::FreehandVolume volume, measure("reconstruct/made-sweep", made_sweep(), made, results));
  const fs::path spine = real_data() / "us-spine-phantom";
  if (fs::exists(spine)) TROCAR_TRY_STATUS(measure_spine_phantom(spine, results));
  const fs::path liver = real_data() / "us-liver-sweep" / "liver_sweep_decoded.igs.mha";
  if (fs::exists(liver)) {
    TROCAR_TRY(const ultrasound::TrackedSequence sequence, io::read_sequence(liver));
    TROCAR_TRY(const ultrasound::FreehandVolume sweep, measure("reconstruct/liver-sweep", sequence, made, results));
  }
  return results;
}

}  // namespace trocar::bench
