#include "scene/render_patient.h"

#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkNew.h>
#include <vtkPolyDataMapper.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>

#include "core/result.h"
#include "scene/detail/drawing.h"
#include "scene/input_watch.h"
#include "scene/structure.h"
#include "scene/tool_shapes.h"

namespace trocar::scene {
namespace {

using detail::Appearance;

constexpr int kMinPixels = 16;
constexpr int kMaxPixels = 8192;
/// Rendered larger and scaled down: smooth edges also with depth peeling, which excludes multisampling.
constexpr int kSupersampling = 2;

void add_surface(vtkRenderer& renderer, const TriangleMesh& mesh_P, const Appearance& look) {
  vtkNew<vtkActor> actor;
  actor->SetMapper(detail::make_mapper(detail::to_polydata(mesh_P)));
  detail::apply(look, *actor);
  detail::make_translucent(*actor);
  renderer.AddActor(actor);
}

/// A needle that ends at the target, with its hub outside the body. Adds the points that must be in the picture.
void add_needle(vtkRenderer& renderer, const Segment& path_P, std::vector<Vec3>& points_P) {
  constexpr double kOutside_mm = 60.0;
  constexpr double kShaft_mm = 2.4;  // drawn thicker than in reality for visibility
  const Vec3 shaft_P[2] = {path_P.a - kOutside_mm * path_P.direction(), path_P.b};
  for (const ShapePart& part : make_needle_shape(shaft_P, kShaft_mm, NeedleModel::kChiba)) {
    add_surface(renderer, part.mesh, {part.color, 1.0, part.specular});
    for (const Vec3f& vertex_P : part.mesh.vertices) points_P.push_back(vertex_P.cast<double>());
  }
}

}  // namespace

bool can_render() noexcept {
  return detail::has_opengl_display();
}

Result<image::RgbImage> render_patient(const anatomy::VirtualPatient& patient,
                                       const std::vector<anatomy::NamedMesh>& meshes, const SceneOptions& options) {
  if (std::min(options.columns, options.rows) < kMinPixels || std::max(options.columns, options.rows) > kMaxPixels) {
    return fail_usage(fmt::format("a picture of {} x {} pixels cannot be drawn", options.columns, options.rows), {},
                      fmt::format("choose {}..{}", kMinPixels, kMaxPixels));
  }
  if (!can_render()) {
    return fail("3D images need an X server; none is available", "DISPLAY", "start the program under xvfb-run");
  }
  vtkObject::GlobalWarningDisplayOff();
  vtkNew<vtkRenderer> renderer;
  detail::add_lights(*renderer);
  std::vector<Vec3> points_P;
  for (const anatomy::NamedMesh& mesh : meshes) {
    auto look = detail::find_appearance(patient.label_table, mesh.name);
    if (look && look->kind == StructureKind::kSkin) look->opacity = options.skin_opacity;
    if (!look || look->opacity <= 0.0 || mesh.mesh_P.triangles.empty()) continue;
    add_surface(*renderer, mesh.mesh_P, *look);
    for (const Vec3f& vertex_P : mesh.mesh_P.vertices) points_P.push_back(vertex_P.cast<double>());
  }
  for (const anatomy::NeedlePath& path : options.paths) add_needle(*renderer, path.line_P, points_P);
  if (points_P.empty()) return fail("the patient has no surfaces", patient.name, "see trocar patient check");
  const double aspect = static_cast<double>(options.columns) / options.rows;
  detail::apply(options.view ? *options.view : fit_camera(points_P, options.camera, aspect), *renderer);
  renderer->SetUseDepthPeeling(1);
  renderer->SetMaximumNumberOfPeels(detail::kDepthPeels);
  renderer->SetOcclusionRatio(0.01);

  vtkNew<vtkRenderWindow> window;
  window->SetShowWindow(false);
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetAlphaBitPlanes(1);
  window->SetSize(options.columns * kSupersampling, options.rows * kSupersampling);
  window->AddRenderer(renderer);
  window->Render();
  return detail::read_picture(*window, options.columns, options.rows, kSupersampling);
}

}  // namespace trocar::scene

namespace trocar::scene::detail {

int to_vtk(StereoMode mode, Eye eye) {
  switch (mode) {
    case StereoMode::kQuadBuffer:
      return eye == Eye::kLeft ? VTK_STEREO_LEFT : VTK_STEREO_RIGHT;
    case StereoMode::kAnaglyph:
      return VTK_STEREO_ANAGLYPH;
    case StereoMode::kSideBySide:
      return VTK_STEREO_SPLITVIEWPORT_HORIZONTAL;
    case StereoMode::kInterlaced:
      return VTK_STEREO_INTERLACED;
    case StereoMode::kOff:
      break;
  }
  return VTK_STEREO_LEFT;
}

void copy_picture(vtkRenderWindow& window, std::span<std::uint32_t> pixels) {
  const int columns = window.GetSize()[0];
  const int rows = window.GetSize()[1];
  TROCAR_CHECK(pixels.size() == static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  vtkNew<vtkUnsignedCharArray> bytes;
  window.GetRGBACharPixelData(0, 0, columns - 1, rows - 1, 0, bytes);
  const std::uint8_t* rgba = bytes->GetPointer(0);
  for (int row = rows - 1; row >= 0; --row) {  // OpenGL starts at the bottom
    std::uint32_t* pixel = pixels.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(columns);
    for (int column = 0; column < columns; ++column, rgba += 4)
      pixel[column] = 0xff000000U | std::uint32_t{rgba[0]} << 16 | std::uint32_t{rgba[1]} << 8 | rgba[2];
  }
}

void mirror(std::span<std::uint32_t> pixels, int columns, bool left_right, bool up_down) {
  if (left_right) {
    for (std::size_t first = 0; first < pixels.size(); first += static_cast<std::size_t>(columns))
      std::reverse(pixels.begin() + static_cast<std::ptrdiff_t>(first),
                   pixels.begin() + static_cast<std::ptrdiff_t>(first) + columns);
  }
  if (!up_down) return;
  for (auto top = pixels.begin(), bottom = pixels.end() - columns; top < bottom; top += columns, bottom -= columns)
    std::swap_ranges(top, top + columns, bottom);
}

std::string renderer_of(vtkRenderWindow& window) {
  constexpr std::string_view kKey = "OpenGL renderer string:";
  const char* report = window.ReportCapabilities();
  const std::string text = report == nullptr ? "" : report;
  const auto at = text.find(kKey);
  if (at == std::string::npos) return {};
  const auto first = text.find_first_not_of(' ', at + kKey.size());
  return first == std::string::npos ? std::string() : text.substr(first, text.find('\n', first) - first);
}

bool is_software_renderer(std::string_view renderer_name) {
  constexpr std::array<std::string_view, 5> kPrograms = {"llvmpipe", "softpipe", "swrast", "SWR", "Software"};
  return std::any_of(kPrograms.begin(), kPrograms.end(),
                     [&](std::string_view program) { return renderer_name.find(program) != std::string_view::npos; });
}

}  // namespace trocar::scene::detail
