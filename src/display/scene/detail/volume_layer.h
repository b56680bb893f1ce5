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
#include "scene/detail/volume_copy.h"
#include "scene/scene_options.h"

namespace trocar::scene::detail {

/// Volume rendering of the CT inside the skin: by the graphics card, or by ray casting on the processor through a
/// coarser copy. Ray casting ends early at the window's request. A background thread makes the copy.
class VolumeLayer {
 public:
  explicit VolumeLayer(vtkRenderer& renderer) : renderer_(renderer) {}
  ~VolumeLayer();
  VolumeLayer(const VolumeLayer&) = delete;
  VolumeLayer& operator=(const VolumeLayer&) = delete;

  void set_patient(std::shared_ptr<const anatomy::VirtualPatient> patient);
  bool set_preset(VolumePreset preset, bool has_gpu);
  VolumePreset preset() const noexcept { return preset_; }
  /// True if the volume can be drawn: a preset is selected and its copy is ready.
  bool is_ready() const noexcept;
  /// True if a copy has just become ready.
  bool poll();
  /// Blocks until the copy for the preset is ready.
  void wait();
  void set_visible(bool is_visible);

  /// A copy of the CT that can be drawn.
  struct Cloud {
    vtkSmartPointer<vtkImageData> image;
    volume::GridGeometry geometry;
    CloudContent content = CloudContent::kWhole;
  };

 private:
  void start();
  void rebuild();

  vtkRenderer& renderer_;
  std::shared_ptr<const anatomy::VirtualPatient> patient_;
  VolumePreset preset_ = VolumePreset::kNone;
  bool has_gpu_ = false;
  bool is_visible_ = false;
  std::future<Cloud> loading_;
  std::optional<Cloud> cloud_;
  vtkSmartPointer<vtkVolume> volume_;
};

}  // namespace trocar::scene::detail
