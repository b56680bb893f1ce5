#include "scene/detail/drawing.h"

#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkLight.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderWindow.h>
#include <vtkShaderProperty.h>
#include <vtkTexture.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <cstring>

#include "scene/detail/simplify.h"

namespace trocar::scene::detail {

vtkSmartPointer<vtkPolyData> to_polydata(const TriangleMesh& mesh) {
  return to_polydata(mesh, vertex_normals(mesh));
}

vtkSmartPointer<vtkPolyData> to_polydata(const TriangleMesh& mesh, const std::vector<Vec3f>& unit_normals) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToFloat();
  points->SetNumberOfPoints(static_cast<vtkIdType>(mesh.vertices.size()));
  vtkNew<vtkFloatArray> normals;
  normals->SetNumberOfComponents(3);
  normals->SetNumberOfTuples(static_cast<vtkIdType>(mesh.vertices.size()));
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    points->SetPoint(static_cast<vtkIdType>(i), mesh.vertices[i].x(), mesh.vertices[i].y(), mesh.vertices[i].z());
    normals->SetTypedTuple(static_cast<vtkIdType>(i), unit_normals[i].data());
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
  data->GetPointData()->SetNormals(normals);
  return data;
}

vtkSmartPointer<vtkPolyDataMapper> make_mapper(vtkPolyData* data) {
  auto mapper = vtkSmartPointer<vtkPolyDataMapper>::New();
  mapper->SetInputData(data);
  mapper->ScalarVisibilityOff();
  return mapper;
}

void apply(const Appearance& look, vtkActor& actor) {
  vtkProperty& property = *actor.GetProperty();
  property.SetColor(look.color[0] / 255.0, look.color[1] / 255.0, look.color[2] / 255.0);
  property.SetOpacity(look.opacity);
  property.SetBackfaceCulling(look.opacity < 1.0);
  property.SetAmbient(look.ambient);
  property.SetDiffuse(1.0 - look.ambient);
  property.SetSpecular(look.specular);
  property.SetSpecularPower(30.0);
  property.SetInterpolationToPhong();
}

void make_translucent(vtkActor& actor) {
  actor.GetShaderProperty()->AddFragmentShaderReplacement(
      "//VTK::Light::Impl", true,
      "//VTK::Light::Impl\n"
      "  if (opacity < 1.0) {\n"
      "    float facing = abs(dot(normalize(normalVCVSOutput), normalize(vertexVC.xyz)));\n"
      "    gl_FragData[0].a = clamp(opacity * (0.7 + 3.5 * pow(1.0 - facing, 2.5)), 0.0, 0.95);\n"
      "  }\n",
      false);
}

void make_unlit(vtkActor& actor) {
  actor.GetProperty()->LightingOff();
  actor.GetProperty()->SetAmbient(1.0);
  actor.GetProperty()->SetDiffuse(0.0);
}

void blend_at_once(vtkActor& actor) {
  actor.ForceOpaqueOn();
}

namespace {

void add_light(vtkRenderer& renderer, const Vec3& from_camera, double intensity, const Vec3& color) {
  vtkNew<vtkLight> light;
  light->SetLightTypeToCameraLight();
  light->SetPosition(from_camera.x(), from_camera.y(), from_camera.z());
  light->SetFocalPoint(0.0, 0.0, 0.0);
  light->SetIntensity(intensity);
  light->SetColor(color.x(), color.y(), color.z());
  renderer.AddLight(light);
}

}  // namespace

void add_lights(vtkRenderer& renderer) {
  renderer.SetBackground(0.055, 0.065, 0.085);
  renderer.SetBackground2(0.20, 0.235, 0.28);
  renderer.GradientBackgroundOn();
  renderer.AutomaticLightCreationOff();
  add_light(renderer, {-0.6, 0.8, 1.0}, 0.95, {1.0, 0.98, 0.94});
  add_light(renderer, {1.0, 0.1, 0.7}, 0.35, {0.92, 0.96, 1.0});
  add_light(renderer, {0.4, 0.9, -1.0}, 0.35, {0.85, 0.92, 1.0});
}

void apply(const CameraView& view, vtkRenderer& renderer) {
  vtkCamera* camera = renderer.GetActiveCamera();
  camera->SetFocalPoint(view.focus_P.data());
  camera->SetPosition(view.eye_P.data());
  camera->SetViewUp(view.up_P.data());
  camera->SetViewAngle(degrees(view.view_angle_rad));
  renderer.ResetCameraClippingRange();
}

PictureQuad::PictureQuad()
    : image_(vtkSmartPointer<vtkImageData>::New()),
      rectangle_(vtkSmartPointer<vtkPolyData>::New()),
      actor_(vtkSmartPointer<vtkActor>::New()) {
  vtkNew<vtkPoints> points;
  points->SetNumberOfPoints(4);
  for (vtkIdType i = 0; i < 4; ++i) points->SetPoint(i, 0.0, 0.0, 0.0);
  vtkNew<vtkCellArray> cells;
  const vtkIdType corners[4] = {0, 1, 2, 3};
  cells->InsertNextCell(4, corners);
  // Textures start at the bottom: the picture's first row is the texture's t = 0, at the top corners.
  vtkNew<vtkFloatArray> places;
  places->SetNumberOfComponents(2);
  for (const auto& [s, t] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}}) places->InsertNextTuple2(s, t);
  rectangle_->SetPoints(points);
  rectangle_->SetPolys(cells);
  rectangle_->GetPointData()->SetTCoords(places);
  vtkNew<vtkTexture> texture;
  texture->SetInputData(image_);
  texture->InterpolateOn();
  texture->EdgeClampOn();
  texture->SetColorModeToDirectScalars();
  actor_->SetMapper(make_mapper(rectangle_));
  actor_->SetTexture(texture);
  actor_->ForceOpaqueOn();
  actor_->GetShaderProperty()->AddFragmentShaderReplacement(
      "//VTK::TCoord::Impl", false,
      "//VTK::TCoord::Impl\n  if (gl_FragData[0].a < 0.5) discard;\n  gl_FragData[0].a = 1.0;\n", false);
  make_unlit(*actor_);
  hide();
}

std::span<std::uint8_t> PictureQuad::resize(int columns, int rows) {
  const int* size = image_->GetDimensions();
  if (size[0] != columns || size[1] != rows || image_->GetPointData()->GetScalars() == nullptr) {
    image_->SetDimensions(columns, rows, 1);
    image_->AllocateScalars(VTK_UNSIGNED_CHAR, 4);
  }
  return {static_cast<std::uint8_t*>(image_->GetScalarPointer()),
          static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows) * 4};
}

void PictureQuad::show(const std::array<Vec3, 3>& corners_P) {
  corners_P_ = corners_P;
  const Vec3 last_P = corners_P[1] + corners_P[2] - corners_P[0];
  const Vec3* order[4] = {&corners_P[0], &corners_P[1], &last_P, &corners_P[2]};
  for (vtkIdType i = 0; i < 4; ++i) rectangle_->GetPoints()->SetPoint(i, order[i]->data());
  rectangle_->GetPoints()->Modified();
  rectangle_->Modified();
  image_->Modified();
  actor_->VisibilityOn();
}

bool PictureQuad::show_picture(const PictureView& picture, std::span<const std::uint8_t> alpha,
                               const std::array<Vec3, 3>& corners_P) {
  const std::span<std::uint8_t> rgba = resize(picture.columns, picture.rows);
  bool is_new = actor_->GetVisibility() == 0;
  for (std::size_t i = 0; i < 3; ++i) is_new |= (corners_P[i] - corners_P_[i]).norm() > kUnseen_mm;
  // Collected without a branch, so that the compiler vectorises it: this runs for every ultrasound image.
  unsigned changes = 0;
  const std::size_t count = picture.bytes.size() / picture.channels;
  const std::size_t green = picture.channels == 3 ? 1 : 0, blue = 2 * green;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint8_t* const pixel = picture.bytes.data() + i * picture.channels;
    const std::array<std::uint8_t, 4> bytes{pixel[0], pixel[green], pixel[blue],
                                            alpha.empty() ? std::uint8_t{255} : alpha[i]};
    for (std::size_t b = 0; b < bytes.size(); ++b) changes |= static_cast<unsigned>(rgba[4 * i + b] ^ bytes[b]);
    std::copy(bytes.begin(), bytes.end(), rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
  }
  is_new |= changes != 0;
  if (is_new) show(corners_P);
  return is_new;
}

bool PictureQuad::hide() {
  const bool was_shown = actor_->GetVisibility() != 0;
  actor_->VisibilityOff();
  return was_shown;
}

image::RgbImage read_picture(vtkRenderWindow& window, int columns, int rows, int supersampling) {
  const int wide = columns * supersampling;
  const int high = rows * supersampling;
  const int samples = supersampling * supersampling;
  vtkNew<vtkUnsignedCharArray> bytes;
  window.GetPixelData(0, 0, wide - 1, high - 1, 0, bytes);
  image::RgbImage image(columns, rows);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      for (int channel = 0; channel < 3; ++channel) {
        int sum = 0;
        for (int y = 0; y < supersampling; ++y) {
          for (int x = 0; x < supersampling; ++x) {
            const vtkIdType pixel =
                static_cast<vtkIdType>((rows - 1 - row) * supersampling + y) * wide + column * supersampling + x;
            sum += bytes->GetValue(3 * pixel + channel);
          }
        }
        image.at(column, row)[static_cast<std::size_t>(channel)] =
            static_cast<std::uint8_t>((sum + samples / 2) / samples);
      }
    }
  }
  return image;
}

}  // namespace trocar::scene::detail
