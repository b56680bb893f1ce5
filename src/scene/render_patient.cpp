#include "scene/render_patient.h"

#include <fmt/format.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPolyDataNormals.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkShaderProperty.h>
#include <vtkSmartPointer.h>
#include <vtkTubeFilter.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/detail/appearance.h"
#include "scene/detail/display.h"

namespace trocar {
namespace {

using detail::Appearance;

constexpr int kMinPixels = 16;
constexpr int kMaxPixels = 8192;
/// Drawn larger and rendered down: smooth edges also where depth peeling rules out multisampling.
constexpr int kSupersampling = 2;
constexpr int kPeels = 6;

vtkSmartPointer<vtkPolyData> to_polydata(const TriangleMesh& mesh) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices.size()));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    points->SetPoint(static_cast<vtkIdType>(i), mesh.vertices[i].x(), mesh.vertices[i].y(), mesh.vertices[i].z());
  }
  vtkNew<vtkCellArray> cells;
  cells->AllocateExact(static_cast<vtkIdType>(mesh.triangles.size()),
                       static_cast<vtkIdType>(3 * mesh.triangles.size()));
  for (const auto& triangle : mesh.triangles) {
    const vtkIdType corners[3] = {triangle[0], triangle[1], triangle[2]};
    cells->InsertNextCell(3, corners);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetPolys(cells);
  return data;
}

void apply(const Appearance& look, vtkProperty& property) {
  property.SetColor(look.color[0] / 255.0, look.color[1] / 255.0, look.color[2] / 255.0);
  property.SetOpacity(look.opacity);
  property.SetAmbient(look.ambient);
  property.SetDiffuse(1.0 - look.ambient);
  property.SetSpecular(look.specular);
  property.SetSpecularPower(30.0);
  property.SetInterpolationToPhong();
}

/// Clear where it is seen face on, denser towards its outline, like glass. Of a translucent surface the front alone is
/// drawn: its far side would veil what lies inside.
void make_glassy(vtkActor& actor) {
  actor.GetProperty()->BackfaceCullingOn();
  actor.GetShaderProperty()->AddFragmentShaderReplacement(
      "//VTK::Light::Impl", true,
      "//VTK::Light::Impl\n"
      "  float facing = abs(dot(normalize(normalVCVSOutput), normalize(vertexVC.xyz)));\n"
      "  gl_FragData[0].a = clamp(opacity * (0.7 + 3.5 * pow(1.0 - facing, 2.5)), 0.0, 0.95);\n",
      false);
}

void add_surface(vtkRenderer& renderer, const TriangleMesh& mesh_P, const Appearance& look) {
  vtkNew<vtkPolyDataNormals> normals;
  normals->SetInputData(to_polydata(mesh_P));
  normals->SplittingOff();
  normals->ConsistencyOff();
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(normals->GetOutputPort());
  mapper->ScalarVisibilityOff();
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  apply(look, *actor->GetProperty());
  if (look.opacity < 1.0) make_glassy(*actor);
  renderer.AddActor(actor);
}

void add_tube(vtkRenderer& renderer, const Segment& line_P, double radius_mm, const Appearance& look) {
  vtkNew<vtkPoints> points;
  points->InsertNextPoint(line_P.a.data());
  points->InsertNextPoint(line_P.b.data());
  vtkNew<vtkCellArray> cells;
  const vtkIdType ends[2] = {0, 1};
  cells->InsertNextCell(2, ends);
  vtkNew<vtkPolyData> line;
  line->SetPoints(points);
  line->SetLines(cells);
  vtkNew<vtkTubeFilter> tube;
  tube->SetInputData(line);
  tube->SetRadius(radius_mm);
  tube->SetNumberOfSides(24);
  tube->CappingOn();
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputConnection(tube->GetOutputPort());
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  apply(look, *actor->GetProperty());
  renderer.AddActor(actor);
}

/// A steel shaft that ends at the target, with its hub outside the body. Returns the hub's end.
Vec3 add_needle(vtkRenderer& renderer, const Segment& path_P) {
  constexpr double kOutside_mm = 60.0;
  constexpr double kHub_mm = 22.0;
  constexpr double kShaftRadius_mm = 1.2;  // thicker than life, to be seen
  constexpr double kHubRadius_mm = 3.5;
  const Vec3 back_P = -path_P.direction();
  const Vec3 hub_P = path_P.a + kOutside_mm * back_P;
  const Vec3 end_P = hub_P + kHub_mm * back_P;
  add_tube(renderer, {hub_P, path_P.b}, kShaftRadius_mm, {{205, 212, 220}, 1.0, 0.8});
  add_tube(renderer, {end_P, hub_P}, kHubRadius_mm, {{46, 134, 171}, 1.0, 0.4});
  return end_P;
}

void add_light(vtkRenderer& renderer, const Vec3& from_camera, double intensity, const Vec3& color) {
  vtkNew<vtkLight> light;
  light->SetLightTypeToCameraLight();
  light->SetPosition(from_camera.x(), from_camera.y(), from_camera.z());
  light->SetFocalPoint(0.0, 0.0, 0.0);
  light->SetIntensity(intensity);
  light->SetColor(color.x(), color.y(), color.z());
  renderer.AddLight(light);
}

/// Key from the upper left, a weak fill from the right, a cool rim from behind.
void add_studio(vtkRenderer& renderer) {
  renderer.SetBackground(0.055, 0.065, 0.085);
  renderer.SetBackground2(0.20, 0.235, 0.28);
  renderer.GradientBackgroundOn();
  renderer.AutomaticLightCreationOff();
  add_light(renderer, {-0.6, 0.8, 1.0}, 0.95, {1.0, 0.98, 0.94});
  add_light(renderer, {1.0, 0.1, 0.7}, 0.35, {0.92, 0.96, 1.0});
  add_light(renderer, {0.4, 0.9, -1.0}, 0.35, {0.85, 0.92, 1.0});
}

/// Unit vector from the patient to the camera, in P (x left, y back, z head).
Vec3 camera_direction(CameraPreset preset) {
  switch (preset) {
    case CameraPreset::kAnterior:
      return {0.0, -1.0, 0.0};
    case CameraPreset::kRightAnteriorOblique:
      return Vec3(-0.72, -0.80, 0.30).normalized();
    case CameraPreset::kRight:
      return {-1.0, 0.0, 0.0};
    case CameraPreset::kPosterior:
      return {0.0, 1.0, 0.0};
  }
  return {0.0, -1.0, 0.0};
}

/// Looks at the middle from `direction_P`, as near as all points stay in the picture, with a margin.
void place_camera(vtkRenderer& renderer, const std::vector<Vec3>& points_P, const Vec3& direction_P, double aspect) {
  constexpr double kViewAngle_rad = 0.42;
  constexpr double kMargin = 1.05;
  const Vec3 right_P = Vec3::UnitZ().cross(direction_P).normalized();
  const Vec3 up_P = direction_P.cross(right_P);
  const auto to_camera = [&](const Vec3& p_P) -> Vec3 {
    return {p_P.dot(right_P), p_P.dot(up_P), p_P.dot(direction_P)};
  };
  Vec3 low = to_camera(points_P.front());
  Vec3 high = low;
  for (const Vec3& p_P : points_P) {
    low = low.cwiseMin(to_camera(p_P));
    high = high.cwiseMax(to_camera(p_P));
  }
  const Vec3 middle = 0.5 * (low + high);
  double distance = 1.0;
  for (const Vec3& p_P : points_P) {
    const Vec3 p = to_camera(p_P) - middle;
    const double half_height = kMargin * std::max(std::abs(p.y()), std::abs(p.x()) / aspect);
    distance = std::max(distance, p.z() + half_height / std::tan(0.5 * kViewAngle_rad));
  }

  const Vec3 focus_P = middle.x() * right_P + middle.y() * up_P + middle.z() * direction_P;
  const Vec3 eye_P = focus_P + distance * direction_P;
  vtkCamera* camera = renderer.GetActiveCamera();
  camera->SetFocalPoint(focus_P.x(), focus_P.y(), focus_P.z());
  camera->SetPosition(eye_P.x(), eye_P.y(), eye_P.z());
  camera->SetViewUp(0.0, 0.0, 1.0);
  camera->SetViewAngle(kViewAngle_rad * 180.0 / std::numbers::pi);
  renderer.ResetCameraClippingRange();
}

/// The window's pixels, averaged over blocks of kSupersampling^2 and turned to run from the top.
RgbImage read_picture(vtkRenderWindow& window, int columns, int rows) {
  const int wide = columns * kSupersampling;
  const int high = rows * kSupersampling;
  vtkNew<vtkUnsignedCharArray> bytes;
  window.GetPixelData(0, 0, wide - 1, high - 1, 0, bytes);
  RgbImage image(columns, rows);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      for (int channel = 0; channel < 3; ++channel) {
        int sum = 0;
        for (int y = 0; y < kSupersampling; ++y) {
          for (int x = 0; x < kSupersampling; ++x) {
            const vtkIdType pixel =
                static_cast<vtkIdType>((rows - 1 - row) * kSupersampling + y) * wide + column * kSupersampling + x;
            sum += bytes->GetValue(3 * pixel + channel);
          }
        }
        constexpr int kSamples = kSupersampling * kSupersampling;
        image.at(column, row)[static_cast<std::size_t>(channel)] =
            static_cast<std::uint8_t>((sum + kSamples / 2) / kSamples);
      }
    }
  }
  return image;
}

}  // namespace

bool can_render() noexcept {
  return detail::has_opengl_display();
}

Result<RgbImage> render_patient(const VirtualPatient& patient, const std::vector<NamedMesh>& meshes,
                                const SceneOptions& options) {
  if (std::min(options.columns, options.rows) < kMinPixels || std::max(options.columns, options.rows) > kMaxPixels) {
    return fail_usage(fmt::format("a picture of {} x {} pixels cannot be drawn", options.columns, options.rows), {},
                      fmt::format("choose {}..{}", kMinPixels, kMaxPixels));
  }
  if (!can_render()) {
    return fail("3D pictures need an X server, and there is none", "DISPLAY", "start the program under xvfb-run");
  }
  vtkObject::GlobalWarningDisplayOff();
  vtkNew<vtkRenderer> renderer;
  add_studio(*renderer);
  std::vector<Vec3> points_P;
  for (const NamedMesh& mesh : meshes) {
    const auto look = detail::find_appearance(patient.label_table, mesh.name, options.skin_opacity);
    if (!look || mesh.mesh_P.triangles.empty()) continue;
    add_surface(*renderer, mesh.mesh_P, *look);
    for (const Vec3f& vertex_P : mesh.mesh_P.vertices) points_P.push_back(vertex_P.cast<double>());
  }
  for (const NeedlePath& path : options.paths) points_P.push_back(add_needle(*renderer, path.line_P));
  if (points_P.empty()) return fail("the patient has no surface to draw", patient.name, "see trocar patient check");
  place_camera(*renderer, points_P, camera_direction(options.camera),
               static_cast<double>(options.columns) / options.rows);
  renderer->SetUseDepthPeeling(1);
  renderer->SetMaximumNumberOfPeels(kPeels);
  renderer->SetOcclusionRatio(0.01);

  vtkNew<vtkRenderWindow> window;
  window->SetShowWindow(false);
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetAlphaBitPlanes(1);
  window->SetSize(options.columns * kSupersampling, options.rows * kSupersampling);
  window->AddRenderer(renderer);
  window->Render();
  return read_picture(*window, options.columns, options.rows);
}

}  // namespace trocar
