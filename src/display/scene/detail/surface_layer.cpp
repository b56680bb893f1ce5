#include "scene/detail/surface_layer.h"

#include <vtkObjectFactory.h>
#include <vtkOpenGLActor.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>

#include <algorithm>
#include <utility>

#include "core/parallel.h"
#include "core/result.h"
#include "core/start_thread.h"
#include "scene/detail/simplify.h"

namespace trocar::scene::detail {
namespace {

/// Cell size of level 1 in mean edges, and the fraction of its triangles kept in level 2.
constexpr double kCoarseness = 2.0;
constexpr double kKeep = 0.25;
static_assert(kMeshLevels == 3);
/// Smaller meshes are not simplified: they are fast and would lose their shape.
constexpr std::size_t kFewTriangles = 800;

/// A surface that is skipped once the frame is cancelled. Depth peeling draws each surface many times, so that a slow
/// frame can end early here.
class BreakableActor : public vtkOpenGLActor {
 public:
  static BreakableActor* New();
  vtkTypeMacro(BreakableActor, vtkOpenGLActor);
  void Render(vtkRenderer* renderer, vtkMapper* mapper) override {
    if (frame_break == nullptr || !frame_break->is_wanted()) Superclass::Render(renderer, mapper);
  }
  FrameBreak* frame_break = nullptr;
};
vtkStandardNewMacro(BreakableActor)

}  // namespace

SurfaceLayer::SurfaceLayer(vtkRenderer& renderer, FrameBreak& frame_break)
    : renderer_(renderer), frame_break_(frame_break), coarse_(renderer) {}

SurfaceLayer::~SurfaceLayer() {
  if (loading_.valid()) loading_.wait();
}

std::vector<SurfaceLayer::Surface> SurfaceLayer::build(const std::vector<Order>& orders) {
  std::vector<Surface> surfaces(orders.size());
  parallel_for(orders.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      const anatomy::NamedMesh* mesh = orders[i].mesh;
      Surface& surface = surfaces[i];
      surface.name = mesh->name;
      surface.look = orders[i].look;
      const std::vector<Vec3f> normals = vertex_normals(mesh->mesh_P);
      surface.levels[0] = to_polydata(mesh->mesh_P, normals);
      const bool has_few = mesh->mesh_P.triangles.size() < kFewTriangles;
      if (has_few) {
        surface.levels[1] = surface.levels[2] = surface.levels[0];
      } else {
        // The first step is fast and robust; only its result is small enough for the slow one.
        const SimplifiedMesh coarse = simplify(mesh->mesh_P, normals, kCoarseness);
        const SimplifiedMesh coarser = decimate(coarse.mesh, kKeep);
        surface.levels[1] = to_polydata(coarse.mesh, coarse.normals);
        surface.levels[2] = to_polydata(coarser.mesh, coarser.normals);
      }
      surface.mapper = make_mapper(surface.levels[0]);
      for (std::size_t level = 0; level < kMeshLevels; ++level)
        if (level == 0 || !has_few) surface.points[level] = MovingPoints(surface.levels[level]);
    }
  });
  return surfaces;
}

void SurfaceLayer::clear() {
  all_.clear();
  begun_ = 0;
  if (loading_.valid()) loading_.get();
  for (Surface& surface : surfaces_) renderer_.RemoveActor(surface.actor);
  surfaces_.clear();
  structures_.clear();
  coarse_.set_parts({});
}

void SurfaceLayer::add(std::vector<StructureInfo> structures,
                       std::shared_ptr<const std::vector<anatomy::NamedMesh>> meshes,
                       const anatomy::LabelTable& table) {
  for (StructureInfo& info : structures) {
    const auto mesh =
        std::find_if(meshes->begin(), meshes->end(), [&](const anatomy::NamedMesh& m) { return m.name == info.name; });
    all_.push_back({meshes, &*mesh, find_appearance(table, info.name).value_or(Appearance{info.color})});
    structures_.push_back(std::move(info));
  }
  std::sort(structures_.begin(), structures_.end(), is_listed_before);
  note_withheld();
  if (!loading_.valid()) build_waiting();
}

void SurfaceLayer::build_waiting() {
  if (begun_ == all_.size()) return;
  std::vector<Order> orders(all_.begin() + static_cast<std::ptrdiff_t>(begun_), all_.end());
  begun_ = all_.size();
  loading_ = compute_beside([orders = std::move(orders)] { return build(orders); });
}

const TriangleMesh& SurfaceLayer::mesh_A(std::string_view name) const {
  const auto found =
      std::find_if(all_.begin(), all_.end(), [&](const Order& order) { return order.mesh->name == name; });
  TROCAR_CHECK(found != all_.end());
  return found->mesh->mesh_P;
}

void SurfaceLayer::wait() {
  if (loading_.valid()) loading_.wait();
}

bool SurfaceLayer::poll() {
  if (!loading_.valid() || loading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return false;
  for (Surface& surface : loading_.get()) {
    auto actor = vtkSmartPointer<BreakableActor>::New();
    actor->frame_break = &frame_break_;
    surface.actor = actor;
    make_translucent(*actor);
    actor->SetMapper(surface.mapper);
    if (is_cut_) surface.mapper->AddClippingPlane(cut_);
    update(surface);
    renderer_.AddActor(actor);
    surfaces_.push_back(std::move(surface));
  }
  build_waiting();
  is_moving_stale_ = true;
  update_moving();
  return true;
}

StructureInfo* SurfaceLayer::find(std::string_view name) {
  const auto found =
      std::find_if(structures_.begin(), structures_.end(), [&](const StructureInfo& s) { return s.name == name; });
  return found == structures_.end() ? nullptr : &*found;
}

void SurfaceLayer::update(Surface& surface) {
  const double opacity = shown_opacity(surface);
  Appearance look = surface.look;
  look.opacity = opacity;
  apply(look, *surface.actor);
  // Clipped surfaces show their back faces.
  if (is_cut_) surface.actor->GetProperty()->BackfaceCullingOff();
  surface.actor->SetVisibility(is_visible_ && level_ == 0 && opacity > kLeastOpacity);
}

bool SurfaceLayer::set_motion(const motion::PatientMotion& motion) {
  if (motion.is_same_place(motion_)) return false;
  motion_ = motion;
  is_moving_stale_ = true;
  update_moving();
  return true;
}

/// Of the drawn level only: the others follow when they are drawn.
void SurfaceLayer::move_surfaces() {
  for (Surface& surface : surfaces_) {
    if (!is_shown(surface)) continue;
    if (surface.points[static_cast<std::size_t>(level_)].move(motion_) && level_ > 0) is_moving_stale_ = true;
    if (surface.levels[static_cast<std::size_t>(level_)] == surface.levels[0] && surface.points[0].move(motion_))
      is_moving_stale_ = true;
  }
}

void SurfaceLayer::update_moving() {
  move_surfaces();
  coarse_.set_visible(is_visible_ && level_ > 0);
  if (level_ == 0 || !is_moving_stale_) return;
  std::vector<CoarsePart> parts;
  for (const Surface& surface : surfaces_) {
    const double opacity = shown_opacity(surface);
    if (opacity <= kLeastOpacity) continue;
    parts.push_back({surface.levels[static_cast<std::size_t>(level_)], surface.look.color, opacity});
  }
  coarse_.set_parts(parts);
  is_moving_stale_ = false;
}

bool SurfaceLayer::set_opacity(std::string_view name, double opacity) {
  StructureInfo* info = find(name);
  const double bounded = std::clamp(opacity, 0.0, 1.0);
  if (info == nullptr || info->opacity == bounded) return false;
  info->opacity = bounded;
  for (Surface& surface : surfaces_) {
    if (surface.name == name) update(surface);
  }
  is_moving_stale_ = true;
  update_moving();
  return true;
}

void SurfaceLayer::note_withheld() {
  for (StructureInfo& info : structures_) info.is_withheld = info.is_lesion && are_lesions_withheld_;
}

bool SurfaceLayer::withhold_lesions(bool are_withheld) {
  if (std::exchange(are_lesions_withheld_, are_withheld) == are_withheld) return false;
  note_withheld();
  for (Surface& surface : surfaces_) update(surface);
  is_moving_stale_ = true;
  update_moving();
  return true;
}

void SurfaceLayer::set_level(int level) {
  if (level == level_) return;
  // The pieces for motion are reused after a rest if their level is unchanged.
  if (level > 0 && level != coarse_level_) is_moving_stale_ = true;
  if (level > 0) coarse_level_ = level;
  level_ = level;
  for (Surface& surface : surfaces_) update(surface);
  update_moving();
}

void SurfaceLayer::set_visible(bool is_visible) {
  if (is_visible == is_visible_) return;
  is_visible_ = is_visible;
  for (Surface& surface : surfaces_) update(surface);
  update_moving();
}

void SurfaceLayer::set_cut(const std::optional<std::pair<Vec3, Vec3>>& plane_P) {
  if (plane_P) {
    cut_->SetOrigin(plane_P->first.x(), plane_P->first.y(), plane_P->first.z());
    cut_->SetNormal(-plane_P->second.x(), -plane_P->second.y(), -plane_P->second.z());
  }
  if (plane_P.has_value() == is_cut_) return;
  is_cut_ = plane_P.has_value();
  for (Surface& surface : surfaces_) {
    surface.mapper->RemoveAllClippingPlanes();
    if (is_cut_) surface.mapper->AddClippingPlane(cut_);
    update(surface);
  }
  coarse_.set_cut(is_cut_ ? cut_.Get() : nullptr);
}

double SurfaceLayer::shown_opacity(const Surface& surface) const {
  const auto found = std::find_if(structures_.begin(), structures_.end(),
                                  [&](const StructureInfo& s) { return s.name == surface.name; });
  return found == structures_.end() || found->is_withheld ? 0.0 : found->opacity;
}

std::vector<Vec3> SurfaceLayer::outline_P() const {
  std::vector<Vec3> points_P;
  for (const bool only_shown : {true, false}) {
    for (const Surface& surface : surfaces_) {
      if (only_shown && !is_shown(surface)) continue;
      vtkPolyData& data = *surface.levels.back();
      for (vtkIdType i = 0; i < data.GetNumberOfPoints(); ++i) points_P.emplace_back(data.GetPoint(i));
    }
    if (!points_P.empty()) break;
  }
  return points_P;
}

std::size_t SurfaceLayer::triangle_count(int level) const {
  std::size_t count = 0;
  for (const Surface& surface : surfaces_) {
    if (is_shown(surface)) {
      count += static_cast<std::size_t>(surface.levels[static_cast<std::size_t>(level)]->GetNumberOfPolys());
    }
  }
  return count;
}

}  // namespace trocar::scene::detail
