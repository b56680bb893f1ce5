#include "scene/detail/volume_layer.h"

#include <vtkColorTransferFunction.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkVolumeProperty.h>

#include <algorithm>
#include <cmath>

#include "core/parallel.h"

namespace trocar::detail {
namespace {

/// Voxels along the longest edge that a processor casts through in about a second.
constexpr std::int64_t kCoarseEdge = 220;
/// Steps of a ray, in voxels: longer ones leave rings on the skin.
constexpr double kStepShare = 0.6;
constexpr std::int16_t kAir_hu = -1000;

/// The CT on a grid of every `step`-th voxel (means of blocks), air outside of the skin.
vtkSmartPointer<vtkImageData> make_copy(const VirtualPatient& patient, bool has_gpu) {
  const GridGeometry& g = patient.ct.geometry;
  const std::int64_t longest = std::max({g.size[0], g.size[1], g.size[2]});
  const std::int64_t step = has_gpu ? 1 : (longest + kCoarseEdge - 1) / kCoarseEdge;
  Index3 size;
  for (std::size_t a = 0; a < 3; ++a) size[a] = std::max<std::int64_t>(1, g.size[a] / step);
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(static_cast<int>(size[0]), static_cast<int>(size[1]), static_cast<int>(size[2]));
  const Vec3 spacing_mm = static_cast<double>(step) * g.spacing_mm;
  image->SetSpacing(spacing_mm.data());
  const Vec3 first = 0.5 * static_cast<double>(step - 1) * g.spacing_mm;
  image->SetOrigin(first.data());
  image->AllocateScalars(VTK_SHORT, 1);
  auto* out = static_cast<std::int16_t*>(image->GetScalarPointer());
  const auto block_mean = [&](const Index3& low) {
    int sum = 0;
    int count = 0;
    for (std::int64_t k = low[2]; k < low[2] + step; ++k) {
      for (std::int64_t j = low[1]; j < low[1] + step; ++j) {
        for (std::int64_t i = low[0]; i < low[0] + step; ++i, ++count) {
          const std::size_t at = g.offset({i, j, k});
          const bool is_outside = !patient.skin_distance_mm.empty() && patient.skin_distance_mm.voxels[at] > 1.0F;
          sum += is_outside ? kAir_hu : patient.ct.voxels[at];
        }
      }
    }
    return static_cast<std::int16_t>(sum / std::max(1, count));
  };
  parallel_for(static_cast<std::size_t>(size[2]), 4, [&](std::size_t first_k, std::size_t last_k) {
    for (auto k = static_cast<std::int64_t>(first_k); k < static_cast<std::int64_t>(last_k); ++k) {
      std::int16_t* row = out + k * size[0] * size[1];
      for (std::int64_t j = 0; j < size[1]; ++j) {
        for (std::int64_t i = 0; i < size[0]; ++i) *row++ = block_mean({i * step, j * step, k * step});
      }
    }
  });
  return image;
}

vtkSmartPointer<vtkVolumeMapper> make_ray_caster(vtkImageData* image, bool has_gpu) {
  if (has_gpu) {
    auto mapper = vtkSmartPointer<vtkGPUVolumeRayCastMapper>::New();
    mapper->SetInputData(image);
    mapper->UseJitteringOn();
    return mapper;
  }
  auto mapper = vtkSmartPointer<vtkFixedPointVolumeRayCastMapper>::New();
  mapper->SetInputData(image);
  mapper->AutoAdjustSampleDistancesOff();
  mapper->SetImageSampleDistance(1.5F);
  mapper->SetSampleDistance(static_cast<float>(kStepShare * image->GetSpacing()[0]));
  mapper->IntermixIntersectingGeometryOn();
  return mapper;
}

}  // namespace

VolumeLayer::~VolumeLayer() {
  if (loading_.valid()) loading_.wait();
}

void VolumeLayer::set_patient(std::shared_ptr<const VirtualPatient> patient) {
  wait();
  poll();
  if (volume_ != nullptr) renderer_.RemoveViewProp(volume_);
  volume_ = nullptr;
  image_ = nullptr;
  patient_ = std::move(patient);
  if (preset_ != VolumePreset::kNone) start(has_gpu_);
}

void VolumeLayer::start(bool has_gpu) {
  if (patient_ == nullptr || patient_->ct.empty() || loading_.valid()) return;
  loading_ = std::async(std::launch::async, [patient = patient_, has_gpu] { return make_copy(*patient, has_gpu); });
}

bool VolumeLayer::set_preset(VolumePreset preset, bool has_gpu) {
  if (preset == preset_) return false;
  preset_ = preset;
  has_gpu_ = has_gpu;
  if (preset == VolumePreset::kNone) return true;
  if (image_ == nullptr) {
    start(has_gpu);
  } else {
    rebuild();
  }
  return true;
}

bool VolumeLayer::poll() {
  if (!loading_.valid() || loading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  image_ = loading_.get();
  if (preset_ != VolumePreset::kNone) rebuild();
  return true;
}

void VolumeLayer::wait() {
  if (loading_.valid()) loading_.wait();
}

void VolumeLayer::set_visible(bool is_visible) {
  is_visible_ = is_visible;
  if (volume_ != nullptr) volume_->SetVisibility(is_visible && preset_ != VolumePreset::kNone);
}

void VolumeLayer::rebuild() {
  vtkNew<vtkColorTransferFunction> colors;
  vtkNew<vtkPiecewiseFunction> opacities;
  for (const TransferPoint& point : transfer_function(preset_)) {
    colors->AddRGBPoint(point.hu, point.color[0] / 255.0, point.color[1] / 255.0, point.color[2] / 255.0);
    opacities->AddPoint(point.hu, point.opacity);
  }
  if (volume_ == nullptr) {
    volume_ = vtkSmartPointer<vtkVolume>::New();
    volume_->SetMapper(make_ray_caster(image_, has_gpu_));
    const GridGeometry& g = patient_->ct.geometry;
    vtkNew<vtkMatrix4x4> matrix;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) matrix->SetElement(row, column, g.R_PV(row, column));
      matrix->SetElement(row, 3, g.origin_P[row]);
    }
    volume_->SetUserMatrix(matrix);
    renderer_.AddVolume(volume_);
  }
  vtkVolumeProperty& look = *volume_->GetProperty();
  look.SetColor(colors);
  look.SetScalarOpacity(opacities);
  look.SetScalarOpacityUnitDistance(1.0);
  look.SetInterpolationTypeToLinear();
  look.ShadeOn();
  look.SetAmbient(0.25);
  look.SetDiffuse(0.8);
  look.SetSpecular(0.15);
  volume_->SetVisibility(is_visible_);
}

}  // namespace trocar::detail
