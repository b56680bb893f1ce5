// Frames of the panorama engine with a moving transducer: fully and half covered, and with a needle.
#include <vtkImageData.h>
#include <vtkImageReslice.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>
#include <numbers>

#include "bench/benchmarks.h"
#include "bench/images/scan_rounds.h"
#include "core/files/folders.h"
#include "phantom/phantom.h"
#include "ultrasound/panorama/panorama_engine.h"
#include "ultrasound/probe/probe_placement.h"
#include "ultrasound/sweep/mechanical_sweep.h"

namespace trocar::bench {
namespace {

constexpr double kSpacing_mm = 0.7;

struct PanoramaSubject {
  std::shared_ptr<const ultrasound::AcousticScene> scene;
  ultrasound::Transducer transducer;
  Pose X_PT;
  volume::LabelGrid gray_U;  ///< In T of the middle of the swing: X_PU is X_PT.
};

/// A panorama that covers the scans of a transducer: the same array with a wider fan, swung by a motor.
Result<volume::LabelGrid> sweep_widely(const PanoramaSubject& subject) {
  constexpr double kDeeper_mm = 40.0, kWider = 1.5;
  ultrasound::Transducer wide = subject.transducer;
  wide.kind = ultrasound::TransducerKind::kMechanicalConvex;
  wide.field_of_view_rad *= kWider;
  wide.greatest_depth_mm = wide.depth_mm + kDeeper_mm;
  wide.sweep_rad = std::numbers::pi / 3.0;
  wide.sweep_radius_mm = 40.0;
  ultrasound::MechanicalSweepOptions options;
  options.acquisition = ultrasound::default_acquisition(wide);
  options.acquisition.depth_mm += kDeeper_mm;
  options.spacing_mm = kSpacing_mm;
  TROCAR_TRY(ultrasound::SweepVolume volume,
             ultrasound::make_mechanical_sweep(subject.scene, wide, subject.X_PT, options));
  return std::move(volume.gray);
}

Result<PanoramaSubject> make_subject() {
  TROCAR_TRY(const anatomy::VirtualPatient patient, phantom::generate_phantom("abdomen", 1, {{512, 512, 119}}));
  TROCAR_TRY(ultrasound::AcousticTable table, ultrasound::load_acoustic_table(data_dir() / "acoustics.toml"));
  TROCAR_TRY(const auto views, ultrasound::load_probe_views(data_dir() / "views.toml"));
  TROCAR_TRY(const ultrasound::ProbeView view, ultrasound::choose_view(patient, views, "liver-right-kidney"));
  PanoramaSubject subject;
  TROCAR_TRY(subject.transducer, ultrasound::load_transducer(data_dir() / "transducers.toml", "C5-2"));
  TROCAR_TRY(const ultrasound::ProbePlacement placed, ultrasound::place_probe(patient, view, subject.transducer));
  subject.X_PT = placed.X_PT;
  TROCAR_TRY(subject.scene, ultrasound::make_acoustic_scene(patient, std::move(table)));
  TROCAR_TRY(subject.gray_U, sweep_widely(subject));
  return subject;
}

/// The panorama without the half at positive x of T.
volume::LabelGrid half_of(const volume::LabelGrid& gray) {
  volume::LabelGrid half = gray;
  for (std::size_t n = 0; n < half.voxels.size(); ++n)
    if (half.geometry.centre_mm(half.geometry.index_of(n)).x() > 0.0) half.voxels[n] = 0;
  return half;
}

/// VTK's mean of five linear slices of the same volume, without shadows, contact, needles and scanner; ms.
double time_peer(const PanoramaSubject& subject) {
  constexpr int kColumns = 640, kRows = 480, kSlices = 5, kThreads = 2, kRepeats = 60;
  constexpr double kPixel_mm = 0.35;
  const volume::GridGeometry& grid = subject.gray_U.geometry;
  vtkNew<vtkUnsignedCharArray> voxels;
  voxels->SetArray(const_cast<unsigned char*>(subject.gray_U.voxels.data()),
                   static_cast<vtkIdType>(subject.gray_U.voxels.size()), 1);
  vtkNew<vtkImageData> image;
  image->SetDimensions(static_cast<int>(grid.size[0]), static_cast<int>(grid.size[1]), static_cast<int>(grid.size[2]));
  image->SetSpacing(grid.spacing_mm.data());
  image->SetOrigin(grid.origin_P.data());
  image->GetPointData()->SetScalars(voxels);
  vtkNew<vtkImageReslice> reslice;
  reslice->SetInputData(image);
  reslice->SetOutputDimensionality(2);
  reslice->SetOutputExtent(0, kColumns - 1, 0, kRows - 1, 0, 0);
  reslice->SetOutputSpacing(kPixel_mm, kPixel_mm, 1.0);
  reslice->SetOutputOrigin(-0.5 * kPixel_mm * kColumns, 0.0, 0.0);
  reslice->SetInterpolationModeToLinear();
  reslice->SetSlabModeToMean();
  reslice->SetSlabNumberOfSlices(kSlices);
  reslice->SetNumberOfThreads(kThreads);
  const Vec3 u = Vec3(1.0, 0.02, 0.1).normalized(), w = u.cross(Vec3::UnitY()).normalized(), v = w.cross(u);
  reslice->SetResliceAxesDirectionCosines(u.data(), v.data(), w.data());
  const Figures figures = time_ms(3, kRepeats, [&] {
    reslice->Modified();
    reslice->Update();
  });
  return *figures.median;
}

void add_share(const std::string& name, const ultrasound::PanoramaEngine& engine, std::vector<CaseResult>& results) {
  Figures share, lines;
  share.median = engine.panorama_share();
  lines.median = engine.ray_cast_lines();
  results.push_back({name + "/share", "ratio", share, {}, "part of the picture that comes from the panorama"});
  results.push_back({name + "/ray-cast-lines", "n", lines, {}, "scanlines of the last frame that are ray cast"});
}

}  // namespace

Result<std::vector<CaseResult>> run_panorama_benchmark(const Options& options) {
  core::report(options.progress, "patient and panorama", 0.0);
  TROCAR_TRY(const PanoramaSubject subject, make_subject());
  const std::array<Vec3, 2> shaft = {subject.X_PT * Vec3(-60.0, 5.0, 0.0), subject.X_PT * Vec3(0.0, 60.0, 0.0)};
  ultrasound::NeedleEcho needle;
  needle.shaft_P = shaft;
  struct Setting {
    const char* name;
    bool is_half, has_needle;
  };
  std::vector<CaseResult> results;
  double fraction = 0.4;
  for (const Setting& setting : {Setting{"panorama/640x480", false, false},
                                 {"panorama/640x480-needle", false, true},
                                 {"panorama/640x480-half", true, false}}) {
    core::report(options.progress, setting.name, fraction);
    fraction += 0.2;
    TROCAR_TRY(auto panorama,
               ultrasound::make_panorama(setting.is_half ? half_of(subject.gray_U) : subject.gray_U, subject.X_PT));
    ultrasound::PanoramaEngine engine(subject.scene, std::move(panorama), subject.transducer,
                                      ultrasound::default_acquisition(subject.transducer));
    const ScanBest best = measure_scan(engine, subject.X_PT, {&needle, setting.has_needle ? 1U : 0U}, 1.0);
    if (results.empty())
      results.push_back({"calibration/arithmetic", "us", best.calibration, {}, "a fixed loop, after each frame"});
    append_scan(setting.name, best, results);
    add_share(setting.name, engine, results);
    if (setting.is_half || setting.has_needle) continue;
    const double peer_ms = time_peer(subject);
    const auto slice = std::find_if(results.begin(), results.end(), [&](const CaseResult& r) {
      return r.name == std::string(setting.name) + "/engine";
    });
    slice->peer = {"vtkImageReslice, linear, mean of 5 slices, 2 threads; the slice alone", peer_ms,
                   peer_ms / *best.engine.median};
  }
  return results;
}

}  // namespace trocar::bench
