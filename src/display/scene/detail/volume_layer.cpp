#include "scene/detail/volume_layer.h"

#include <vtkColorTransferFunction.h>
#include <vtkFixedPointVolumeRayCastMapper.h>
#include <vtkGPUVolumeRayCastMapper.h>
#include <vtkMatrix4x4.h>
#include <vtkNew.h>
#include <vtkPiecewiseFunction.h>
#include <vtkVolumeProperty.h>

#include <algorithm>

#include "core/start_thread.h"

namespace trocar::scene::detail {
namespace {

/// Voxels along the longest edge that a CPU can ray cast in about a second.
constexpr std::int64_t kCoarseEdge = 190;
/// Step length of a ray, in voxels with a limit in mm: longer steps produce rings on the skin.
constexpr double kStepShare = 0.5;
constexpr double kLongestStep_mm = 0.9;

/// Values of the grid without its pose, which the volume gets as a matrix.
vtkSmartPointer<vtkImageData> to_image(const volume::CtGrid& grid) {
  const volume::GridGeometry& g = grid.geometry;
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(static_cast<int>(g.size[0]), static_cast<int>(g.size[1]), static_cast<int>(g.size[2]));
  image->SetSpacing(g.spacing_mm.data());
  image->AllocateScalars(VTK_SHORT, 1);
  std::copy(grid.voxels.begin(), grid.voxels.end(), static_cast<std::int16_t*>(image->GetScalarPointer()));
  return image;
}

VolumeLayer::Cloud make_drawable(const anatomy::VirtualPatient& patient, CloudContent content, bool has_gpu) {
  const std::array<std::int64_t, 3> all{1, 1, 1};
  const volume::CtGrid grid =
      make_cloud(patient, content, has_gpu ? all : cloud_steps(patient.ct.geometry, kCoarseEdge));
  return {to_image(grid), grid.geometry, content};
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
  const double edge_mm = *std::min_element(image->GetSpacing(), image->GetSpacing() + 3);
  mapper->SetSampleDistance(static_cast<float>(std::min(kStepShare * edge_mm, kLongestStep_mm)));
  mapper->IntermixIntersectingGeometryOn();
  return mapper;
}

}  // namespace

VolumeLayer::~VolumeLayer() {
  if (loading_.valid()) loading_.wait();
}

void VolumeLayer::set_patient(std::shared_ptr<const anatomy::VirtualPatient> patient) {
  if (loading_.valid()) loading_.get();
  if (volume_ != nullptr) renderer_.RemoveViewProp(volume_);
  volume_ = nullptr;
  cloud_.reset();
  patient_ = std::move(patient);
  start();
}

void VolumeLayer::start() {
  if (preset_ == VolumePreset::kNone || patient_ == nullptr || patient_->ct.empty() || loading_.valid()) return;
  loading_ = compute_beside([patient = patient_, content = content_of(preset_), gpu = has_gpu_] {
    return make_drawable(*patient, content, gpu);
  });
}

bool VolumeLayer::is_ready() const noexcept {
  return preset_ != VolumePreset::kNone && cloud_ && cloud_->content == content_of(preset_);
}

bool VolumeLayer::set_preset(VolumePreset preset, bool has_gpu) {
  if (preset == preset_) return false;
  preset_ = preset;
  has_gpu_ = has_gpu;
  if (preset == VolumePreset::kNone) return true;
  if (is_ready()) {
    rebuild();
  } else {
    start();
  }
  return true;
}

bool VolumeLayer::poll() {
  if (!loading_.valid() || loading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  cloud_ = loading_.get();
  if (volume_ != nullptr) renderer_.RemoveViewProp(volume_);
  volume_ = nullptr;
  if (is_ready()) {
    rebuild();
  } else {
    start();  // another preset has been selected since
  }
  return true;
}

void VolumeLayer::wait() {
  while (loading_.valid()) {
    loading_.wait();
    poll();
  }
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
    volume_->SetMapper(make_ray_caster(cloud_->image, has_gpu_));
    const volume::GridGeometry& g = cloud_->geometry;
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
  look.SetAmbient(0.35);
  look.SetDiffuse(0.9);
  look.SetSpecular(0.2);
  look.SetSpecularPower(10.0);
  volume_->SetVisibility(is_visible_);
}

}  // namespace trocar::scene::detail
