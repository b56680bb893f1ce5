// A simulated sweep by hand over the embedded patient, reconstructed, against the anatomy that it was made of.
#include <gtest/gtest.h>

#include <cmath>

#include "core/files/folders.h"
#include "phantom/phantom.h"
#include "ultrasound/probe/probe_placement.h"
#include "ultrasound/probe/probe_view.h"
#include "ultrasound/sweep/freehand.h"
#include "ultrasound/sweep/freehand_sweep.h"
#include "volume/sampling.h"

namespace trocar::testing {
namespace {

struct MeanGray {
  double sum = 0.0;
  std::size_t voxels = 0;
  double mean() const { return voxels == 0 ? 0.0 : sum / static_cast<double>(voxels); }
};

struct SweptPatient {
  anatomy::VirtualPatient patient;
  ultrasound::FreehandVolume volume;
  Pose X_PT;

  /// Of a structure's voxels that the sweep has met, were the structure moved by `shift_P`.
  MeanGray gray_of(std::uint8_t label, const Vec3& shift_P) const {
    MeanGray mean;
    const volume::GridGeometry& grid = volume.gray.geometry;
    for (std::size_t n = 0; n < grid.voxel_count(); ++n) {
      if (volume.gray.voxels[n] == 0) continue;
      const volume::Index3 ijk = grid.index_of(n);
      const Vec3 p_P = grid.centre_mm(ijk);
      if (volume::sample_nearest(patient.labels, Vec3(p_P - shift_P), std::uint8_t{0}) != label) continue;
      mean.sum += volume.gray.voxels[n];
      ++mean.voxels;
    }
    return mean;
  }
};

Result<SweptPatient> sweep_gallbladder() {
  SweptPatient swept;
  TROCAR_TRY(swept.patient, phantom::generate_phantom("abdomen"));
  TROCAR_TRY(const auto views, ultrasound::load_probe_views(data_dir() / "views.toml"));
  TROCAR_TRY(const ultrasound::ProbeView view, ultrasound::choose_view(swept.patient, views, "gallbladder"));
  TROCAR_TRY(const ultrasound::Transducer transducer,
             ultrasound::load_transducer(data_dir() / "transducers.toml", view.transducer));
  TROCAR_TRY(const ultrasound::ProbePlacement placed, ultrasound::place_probe(swept.patient, view, transducer));
  swept.X_PT = placed.X_PT;
  TROCAR_TRY(ultrasound::AcousticTable table, ultrasound::load_acoustic_table(data_dir() / "acoustics.toml"));
  TROCAR_TRY(const auto scene, ultrasound::make_acoustic_scene(swept.patient, std::move(table)));
  ultrasound::FreehandSweepOptions options;
  options.acquisition = ultrasound::default_acquisition(transducer);
  options.acquisition.depth_mm = 110.0;
  options.acquisition.lines = 128;
  options.acquisition.samples = 512;
  options.acquisition.planes = 3;
  options.acquisition.steering_angles = 1;
  options.display.gain_db = 12.0;
  options.columns = 320;
  options.rows = 240;
  const auto poses = ultrasound::slide_over_skin(swept.patient.skin_distance_mm, swept.X_PT, 20.0, 21);
  ultrasound::FreehandOptions how;
  how.is_black_left_out = true;
  how.holes = {ultrasound::HoleFilling{}};
  const ultrasound::TrackedSequence sequence =
      ultrasound::make_freehand_sweep(scene, transducer, poses, options).sequence;
  TROCAR_TRY(swept.volume, ultrasound::reconstruct_freehand(sequence, {}, how));
  return swept;
}

TEST(SimulatedFreehand, ShowsTheGallbladderAtItsPosition) {
  const auto swept = sweep_gallbladder();
  ASSERT_TRUE(swept) << swept.error().text();
  const std::string pattern = "gallbladder";
  const anatomy::Label* label = ultrasound::find_target(swept->patient, std::span(&pattern, 1));
  ASSERT_NE(label, nullptr);
  const MeanGray here = swept->gray_of(label->id, Vec3::Zero());
  ASSERT_GT(here.voxels, 5000U);
  // Bile is dark and what surrounds it is not: moved by a few mm to any side, the shape would hold tissue.
  constexpr double kShift_mm = 8.0;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      const Vec3 shift_P = swept->X_PT.R() * (sign * kShift_mm * Vec3::Unit(axis));
      const MeanGray beside = swept->gray_of(label->id, shift_P);
      EXPECT_GT(beside.mean(), 1.1 * here.mean()) << "axis " << axis << ", " << sign;
    }
}

}  // namespace
}  // namespace trocar::testing
