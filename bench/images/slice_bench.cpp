#include <fmt/format.h>
#include <vtkImageData.h>
#include <vtkImageReslice.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkShortArray.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "bench/benchmarks.h"
#include "core/random.h"
#include "slices/paint_slice.h"
#include "volume/sampling.h"

namespace trocar::bench {
namespace {

constexpr int kSide = 256;            ///< Voxels along each axis of the volume.
constexpr int kPixels = 512;          ///< Pixels along each side of the slice.
constexpr int kSlicesPerRound = 100;  ///< Slices per round.
constexpr int kPeerThreads = 2;
constexpr float kOutside = -1024.0F;

volume::CtGrid make_volume() {
  volume::GridGeometry geometry;
  geometry.size = {kSide, kSide, kSide};
  volume::CtGrid ct(geometry);
  Random random(1);
  for (auto& voxel : ct.voxels) voxel = static_cast<std::int16_t>(static_cast<int>(random.next() % 3000) - 1000);
  return ct;
}

/// A slice through the centre of the volume and completely inside it, spanned by two perpendicular directions.
volume::SlicePlane plane_through_middle(const Vec3& u_P, const Vec3& v_P) {
  const double span_mm = 0.7 * kSide;  // a square of this side fits into the cube in every orientation
  const double step_mm = span_mm / (kPixels - 1);
  volume::SlicePlane plane;
  plane.step_u_P = step_mm * u_P;
  plane.step_v_P = step_mm * v_P;
  plane.origin_P = Vec3::Constant(0.5 * (kSide - 1)) - 0.5 * span_mm * (u_P + v_P);
  plane.columns = plane.rows = kPixels;
  return plane;
}

volume::SlicePlane oblique_plane() {
  const Vec3 normal = Vec3(1.0, 2.0, 3.0).normalized();
  const Vec3 u = normal.cross(Vec3(0.2, -1.0, 0.4)).normalized();
  return plane_through_middle(u, normal.cross(u));
}

/// VTK's linear reslice of the same volume and plane.
class Peer {
 public:
  Peer(const volume::CtGrid& ct, const volume::SlicePlane& plane) {
    vtkNew<vtkShortArray> voxels;
    voxels->SetArray(const_cast<short*>(ct.voxels.data()), static_cast<vtkIdType>(ct.voxels.size()), 1);
    image_->SetDimensions(kSide, kSide, kSide);
    image_->GetPointData()->SetScalars(voxels);
    const Vec3 u = plane.step_u_P.normalized();
    const Vec3 v = plane.step_v_P.normalized();
    const Vec3 w = u.cross(v);
    reslice_->SetInputData(image_);
    reslice_->SetResliceAxesDirectionCosines(u.data(), v.data(), w.data());
    reslice_->SetResliceAxesOrigin(plane.origin_P.data());
    reslice_->SetOutputDimensionality(2);
    reslice_->SetOutputSpacing(plane.step_u_P.norm(), plane.step_v_P.norm(), 1.0);
    reslice_->SetOutputOrigin(0.0, 0.0, 0.0);
    reslice_->SetOutputExtent(0, plane.columns - 1, 0, plane.rows - 1, 0, 0);
    reslice_->SetInterpolationModeToLinear();
    reslice_->SetBackgroundLevel(kOutside);
    reslice_->SetNumberOfThreads(kPeerThreads);
  }

  const short* run() {
    reslice_->Modified();
    reslice_->Update();
    return static_cast<const short*>(reslice_->GetOutput()->GetScalarPointer());
  }

 private:
  vtkNew<vtkImageData> image_;
  vtkNew<vtkImageReslice> reslice_;
};

void keep_best(Figures& best, const Figures& round) {
  if (!best.median || *round.median < *best.median) best = round;
}

/// Figures are comparable only if both results agree: the peer rounds to whole units.
Status check_agreement(const std::vector<float>& ours, const short* peers, std::string_view name) {
  constexpr double kRoundingHu = 0.6;
  double worst = 0.0;
  for (std::size_t n = 0; n < ours.size(); ++n)
    worst = std::max(worst, std::abs(static_cast<double>(ours[n]) - static_cast<double>(peers[n])));
  if (worst <= kRoundingHu) return {};
  return fail(fmt::format("our slice and VTK's differ by {:.2f} HU", worst), std::string(name),
              "report this: the kernel is wrong");
}

Result<CaseResult> race(const volume::CtGrid& ct, std::string name, const volume::SlicePlane& plane) {
  std::vector<float> ours(static_cast<std::size_t>(kPixels) * kPixels);
  Peer peer(ct, plane);
  Figures best;
  Figures best_peer;
  for (int round = 0; round < kRounds; ++round) {
    keep_best(best, time_ms(3, kSlicesPerRound, [&] { volume::sample_slice(ct, plane, kOutside, ours); }));
    keep_best(best_peer, time_ms(3, kSlicesPerRound / 4, [&] { peer.run(); }));
  }
  TROCAR_TRY_STATUS(check_agreement(ours, peer.run(), name));
  CaseResult result{std::move(name), "ms", best, std::nullopt, {}};
  result.peer = {fmt::format("vtkImageReslice, linear, {} threads", kPeerThreads), *best_peer.median,
                 *best_peer.median / *best.median};
  result.note = fmt::format("512x512 of 256^3 int16, one core; best median of {} rounds", kRounds);
  return result;
}

/// The points of the oblique slice one by one, as required by a beam or an ultrasound image.
CaseResult time_points(const volume::CtGrid& ct) {
  const volume::SlicePlane plane = oblique_plane();
  std::vector<Vec3f> points_P;
  for (int v = 0; v < plane.rows; ++v)
    for (int u = 0; u < plane.columns; ++u)
      points_P.push_back((plane.origin_P + u * plane.step_u_P + v * plane.step_v_P).cast<float>());
  std::vector<float> values(points_P.size());
  Figures best;
  for (int round = 0; round < kRounds; ++round)
    keep_best(best, time_ms(3, kSlicesPerRound, [&] { volume::sample_points(ct, points_P, kOutside, values); }));
  return {"slice/points-262144", "ms", best, std::nullopt, "the oblique slice as single points, one core"};
}

/// Work of a slice viewer for a new frame: CT, window, labels with outlines.
CaseResult time_painting(const volume::CtGrid& ct) {
  constexpr int kView = 400;  // pixels along each side of a viewer
  anatomy::VirtualPatient patient;
  patient.ct = ct;
  patient.labels = volume::LabelGrid(ct.geometry);
  for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n) {  // cubes of 16 voxels of eight structures
    const auto [i, j, k] = ct.geometry.index_of(n);
    patient.labels.voxels[n] = static_cast<std::uint8_t>(1 + ((i / 16) + 3 * (j / 16) + 5 * (k / 16)) % 8);
  }
  for (std::uint8_t id = 1; id <= 8; ++id)
    patient.label_table.labels.push_back({id, fmt::format("liver_{}", id), "liver", {200, 20, id}});
  volume::SlicePlane plane = oblique_plane();
  plane.step_u_P *= static_cast<double>(kPixels) / kView;
  plane.step_v_P *= static_cast<double>(kPixels) / kView;
  plane.columns = plane.rows = kView;
  slices::SliceBuffers buffers;
  image::RgbImage picture;
  Figures best;
  for (int round = 0; round < kRounds; ++round)
    keep_best(best, time_ms(3, kSlicesPerRound, [&] { slices::paint_slice(patient, plane, {}, buffers, picture); }));
  return {"slice/paint-400", "ms", best, std::nullopt, "400x400 oblique with labels everywhere, one core"};
}

}  // namespace

Result<std::vector<CaseResult>> run_slice_benchmark() {
  const volume::CtGrid ct = make_volume();
  const std::pair<const char*, volume::SlicePlane> planes[] = {
      {"slice/512-oblique", oblique_plane()},
      {"slice/512-axial", plane_through_middle(Vec3::UnitX(), Vec3::UnitY())},
      {"slice/512-coronal", plane_through_middle(Vec3::UnitX(), Vec3::UnitZ())},
      {"slice/512-sagittal", plane_through_middle(Vec3::UnitY(), Vec3::UnitZ())},
  };
  std::vector<CaseResult> results;
  for (const auto& [name, plane] : planes) {
    TROCAR_TRY(CaseResult result, race(ct, name, plane));
    results.push_back(std::move(result));
  }
  results.push_back(time_points(ct));
  results.push_back(time_painting(ct));
  return results;
}

}  // namespace trocar::bench
