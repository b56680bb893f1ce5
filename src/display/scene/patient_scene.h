#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "geometry/pose.h"
#include "scene/camera.h"
#include "scene/detail_policy.h"
#include "scene/scene_options.h"
#include "scene/scene_view.h"
#include "scene/structure.h"
#include "scene/tool_shapes.h"

namespace trocar::scene {

/// A patient with tools and guidance, drawn off-screen. All coordinates are in P (mm), those of
/// path, entry zone, target and landmarks in A: they move with the patient. All calls must come from one
/// thread; background threads prepare surfaces and volume, which are drawn when they are ready.
class PatientScene {
 public:
  /// Error: no X server.
  static Result<std::unique_ptr<PatientScene>> make(int columns, int rows);
  ~PatientScene();
  PatientScene(const PatientScene&) = delete;
  PatientScene& operator=(const PatientScene&) = delete;

  /// `target_P` is the target; if it is empty, the target is the end of the patient's first path, if there is one. The
  /// camera shows the patient as soon as a surface is ready: let the skin be among the first.
  void show_patient(std::shared_ptr<const anatomy::VirtualPatient> patient,
                    std::shared_ptr<const std::vector<anatomy::NamedMesh>> meshes, std::optional<Vec3> target_P = {});
  /// More surfaces of the same patient, with new names. They get the opacity of the last preset.
  void add_surfaces(std::shared_ptr<const std::vector<anatomy::NamedMesh>> meshes);
  /// Shows tools and patient as they are now. Call it once a frame. The volume view stays at rest.
  void show(const SceneView& view);
  bool is_ready() const noexcept;  ///< The surfaces are loaded.
  void finish_loading();           ///< Waits for surfaces and volume.

  const std::vector<StructureInfo>& structures() const noexcept;
  void set_opacity(std::string_view name, double opacity);
  void apply_preset(StructurePreset preset);

  /// Sets the path with its target at the end, and an entry zone about its start.
  void set_path(const std::optional<Segment>& line_P, double entry_radius_mm);
  /// Further paths beside it, faint; none for an empty list.
  void set_other_paths(std::span<const Segment> lines_P);
  /// Sets the centre of the entry zone; empty: the path's start.
  void set_entry_centre(const std::optional<Vec3>& centre_P);
  /// Amount of guidance and its visibility. Guidance::kNone also withholds lesions.
  void set_guidance(Guidance guidance);
  Guidance guidance() const noexcept;
  void set_guidance_visible(bool is_visible);
  /// Replaces the patient's landmarks until another patient is shown.
  void set_landmarks(const std::vector<anatomy::Landmark>& landmarks);
  void set_landmarks_visible(bool are_visible);
  void set_mpr(const MprOptions& options);
  const MprOptions& mpr() const noexcept;
  void set_volume_preset(VolumePreset preset);
  VolumePreset volume_preset() const noexcept;

  void set_camera(CameraPreset preset);
  void set_view(const CameraView& view);
  const CameraView& view() const noexcept;
  void set_follow(FollowMode mode);
  FollowMode follow() const noexcept;

  void set_stereo(const StereoOptions& options);
  const StereoOptions& stereo() const noexcept;

  /// Size of the image from the next frame on.
  void set_size(int columns, int rows);
  /// Scale of text: pixels of the image per pixel of an ordinary window. Range 0.1..8.
  void set_text_scale(double scale);
  /// Screen row of the image's first row: in interlaced stereo the screen's even rows belong to the left eye, for any
  /// position and mirroring of the image.
  void set_first_row(int row);
  /// Applies surfaces and volume that have finished loading.
  void poll();
  /// True if something was set or has become ready since the last complete frame.
  bool has_changed() const noexcept;
  /// Renders a frame. `wants_break` (may be empty) is polled; if it returns true the frame is cancelled and false is
  /// returned. Quad-buffer stereo renders one frame per eye; the other modes render both into one and ignore `eye`.
  bool render(const Detail& detail, const std::function<bool()>& wants_break = {}, Eye eye = Eye::kLeft);
  /// Copies the image after `render`, mirrored if the stereo options request it: 0xffRRGGBB, top row first. `pixels`
  /// has one element per pixel.
  void copy_picture(std::span<std::uint32_t> pixels) const;

  /// Point in P on the first surface, tool or plane at an image position (shares of width and height from the top
  /// left).
  std::optional<Vec3> pick(double right, double down);

  /// Name of the OpenGL renderer ("llvmpipe (LLVM 15.0.6, 256 bits)"); known after the first frame.
  std::string renderer_name() const;
  /// True with hardware rendering. Known after the first frame; false before.
  bool has_gpu() const;
  std::size_t triangle_count(int mesh_level) const;

 private:
  PatientScene(int columns, int rows);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::scene
