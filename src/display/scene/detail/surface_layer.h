#pragma once

#include <vtkNew.h>
#include <vtkPlane.h>

#include <array>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/detail/coarse_surfaces.h"
#include "scene/detail/drawing.h"
#include "scene/detail/moving_points.h"
#include "scene/detail_policy.h"

namespace trocar::scene::detail {

/// Cancels the frame being drawn; polled before every surface.
class FrameBreak {
 public:
  virtual ~FrameBreak() = default;
  virtual bool is_wanted() = 0;
};

/// The patient's surfaces. A background thread prepares their meshes at all levels; they are drawn when they are ready.
/// All calls must come from the drawing thread.
class SurfaceLayer {
 public:
  SurfaceLayer(vtkRenderer& renderer, FrameBreak& frame_break);
  ~SurfaceLayer();
  SurfaceLayer(const SurfaceLayer&) = delete;
  SurfaceLayer& operator=(const SurfaceLayer&) = delete;

  /// Removes all surfaces.
  void clear();
  /// Adds surfaces; `structures` describes them (in any order) and has new names only.
  void add(std::vector<StructureInfo> structures, std::shared_ptr<const std::vector<anatomy::NamedMesh>> meshes,
           const anatomy::LabelTable& table);
  /// Shows surfaces that have become ready; true if some are new.
  bool poll();
  /// Waits for the surfaces in preparation; others may follow after poll().
  void wait();
  bool is_ready() const noexcept { return !loading_.valid() && begun_ == all_.size(); }

  const std::vector<StructureInfo>& structures() const noexcept { return structures_; }
  /// Where the patient is; true if surfaces have to be drawn again.
  bool set_motion(const motion::PatientMotion& motion);
  /// Mesh of one of the structures at rest.
  const TriangleMesh& mesh_A(std::string_view name) const;
  /// True if it changed something; an unknown name changes nothing.
  bool set_opacity(std::string_view name, double opacity);
  /// True if it changed something. Also applies to later patients.
  bool withhold_lesions(bool are_withheld);
  /// Level 0 has separate surfaces; coarser levels are for motion (CoarseSurfaces).
  void set_level(int level);
  void set_visible(bool is_visible);
  /// Clips the half-space on the side of `normal_P` of the plane through p_P; empty: no clipping.
  void set_cut(const std::optional<std::pair<Vec3, Vec3>>& plane_P);

  /// Vertices of the visible surfaces at a coarse level; of all surfaces if none is visible.
  std::vector<Vec3> outline_P() const;
  std::size_t triangle_count(int level) const;
  void draw_coarse_last() { coarse_.draw_last(); }

 private:
  static constexpr double kLeastOpacity = 0.004;

  struct Surface {
    std::string name;
    Appearance look;
    std::array<vtkSmartPointer<vtkPolyData>, kMeshLevels> levels;
    std::array<MovingPoints, kMeshLevels> points;  ///< Of `levels`; one of several that share a mesh.
    vtkSmartPointer<vtkPolyDataMapper> mapper;     ///< Mapper of level 0.
    vtkSmartPointer<vtkActor> actor;
  };

  /// A surface to prepare.
  struct Order {
    std::shared_ptr<const std::vector<anatomy::NamedMesh>> owner;  ///< Of `mesh`.
    const anatomy::NamedMesh* mesh = nullptr;
    Appearance look;
  };

  static std::vector<Surface> build(const std::vector<Order>& orders);
  void build_waiting();
  void update(Surface& surface);
  void update_moving();
  void move_surfaces();
  StructureInfo* find(std::string_view name);
  void note_withheld();
  /// Opacity for drawing: 0 for withheld surfaces.
  double shown_opacity(const Surface& surface) const;
  bool is_shown(const Surface& surface) const { return shown_opacity(surface) > kLeastOpacity; }

  vtkRenderer& renderer_;
  FrameBreak& frame_break_;
  std::vector<StructureInfo> structures_;
  std::vector<Surface> surfaces_;
  std::future<std::vector<Surface>> loading_;
  std::vector<Order> all_;
  std::size_t begun_ = 0;  ///< Surfaces of all_ that are prepared or in preparation.
  motion::PatientMotion motion_;
  CoarseSurfaces coarse_;
  bool is_moving_stale_ = true;
  int coarse_level_ = 0;  ///< Level of the meshes in coarse_.
  vtkNew<vtkPlane> cut_;
  bool is_cut_ = false;
  bool is_visible_ = true;
  bool are_lesions_withheld_ = false;
  int level_ = 0;
};

/// Polls the caller of `render`; once it returns true, this stays true until the end of the frame.
class CallersBreak : public FrameBreak {
 public:
  bool is_wanted() override {
    if (!has_broken_ && wants_break_ && *wants_break_ && (*wants_break_)()) has_broken_ = true;
    return has_broken_;
  }
  void begin(const std::function<bool()>& wants_break) {
    wants_break_ = &wants_break;
    has_broken_ = false;
  }
  void end() noexcept { wants_break_ = nullptr; }
  bool has_broken() const noexcept { return has_broken_; }

 private:
  const std::function<bool()>* wants_break_ = nullptr;
  bool has_broken_ = false;
};

}  // namespace trocar::scene::detail
