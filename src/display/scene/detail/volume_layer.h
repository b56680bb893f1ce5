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
#include "scene/volume_preset.h"

namespace trocar::scene::detail {

/// The CT inside the skin as a cloud: by the graphics card, or without one by casting rays on the processor through a
/// coarser copy, which ends early when the window asks for it. The copy is made on a thread of its own.
class VolumeLayer {
 public:
  explicit VolumeLayer(vtkRenderer& renderer) : renderer_(renderer) {}
  ~VolumeLayer();
  VolumeLayer(const VolumeLayer&) = delete;
  VolumeLayer& operator=(const VolumeLayer&) = delete;

  void set_patient(std::shared_ptr<const anatomy::VirtualPatient> patient);
  bool set_preset(VolumePreset preset, bool has_gpu);
  VolumePreset preset() const noexcept { return preset_; }
  /// Whether the cloud can be drawn: a preset is chosen and its copy is ready.
  bool is_ready() const noexcept;
  /// True when a copy has just become ready.
  bool poll();
  /// Until the copy that the preset wants is there.
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
