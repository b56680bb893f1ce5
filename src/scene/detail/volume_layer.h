#pragma once

#include <vtkImageData.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkVolume.h>
#include <vtkVolumeMapper.h>

#include <future>
#include <memory>
#include <optional>

#include "anatomy/patient.h"
#include "scene/volume_preset.h"

namespace trocar::detail {

/// The CT inside the skin as a cloud: by the graphics card, or without one by casting rays on the processor through a
/// coarser copy, which ends early when the window asks for it. The copy is made on a thread of its own.
class VolumeLayer {
 public:
  explicit VolumeLayer(vtkRenderer& renderer) : renderer_(renderer) {}
  ~VolumeLayer();
  VolumeLayer(const VolumeLayer&) = delete;
  VolumeLayer& operator=(const VolumeLayer&) = delete;

  void set_patient(std::shared_ptr<const VirtualPatient> patient);
  bool set_preset(VolumePreset preset, bool has_gpu);
  VolumePreset preset() const noexcept { return preset_; }
  /// Whether the cloud can be drawn: a preset is chosen and the copy is ready.
  bool is_ready() const noexcept { return preset_ != VolumePreset::kNone && image_ != nullptr; }
  /// True when the copy has just become ready.
  bool poll();
  void wait();
  void set_visible(bool is_visible);

 private:
  void start(bool has_gpu);
  void rebuild();

  vtkRenderer& renderer_;
  std::shared_ptr<const VirtualPatient> patient_;
  VolumePreset preset_ = VolumePreset::kNone;
  bool has_gpu_ = false;
  bool is_visible_ = false;
  std::future<vtkSmartPointer<vtkImageData>> loading_;
  vtkSmartPointer<vtkImageData> image_;
  vtkSmartPointer<vtkVolume> volume_;
};

}  // namespace trocar::detail
