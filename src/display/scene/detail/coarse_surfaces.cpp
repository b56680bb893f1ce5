#include "scene/detail/coarse_surfaces.h"

#include <vtkAppendPolyData.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPolyDataMapper.h>
#include <vtkPropCollection.h>
#include <vtkProperty.h>
#include <vtkShaderProperty.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>

namespace trocar::scene::detail {
namespace {

/// A key light from the upper left and a sky light; denser outlines of translucent surfaces. Replaces three lights with
/// specular reflection, which take three times as long on a CPU.
constexpr const char* kSimpleLight =
    "  vec3 towards = normalVCVSOutput.z < 0.0 ? -normalVCVSOutput : normalVCVSOutput;\n"
    "  float key = max(0.0, dot(towards, vec3(-0.42, 0.57, 0.71)));\n"
    "  float sky = 0.5 + 0.3 * towards.x + 0.2 * towards.y;\n"
    "  gl_FragData[0] = vec4(diffuseColor * (0.2 + 0.66 * key + 0.22 * sky), opacity);\n"
    "  if (opacity < 1.0) {\n"
    "    float edge = 1.0 - abs(towards.z);\n"
    "    gl_FragData[0].a = min(0.95, opacity * (0.7 + 3.0 * edge * edge));\n"
    "  }\n";

vtkSmartPointer<vtkPolyData> colored(const CoarsePart& part) {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->ShallowCopy(part.data);
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetName("color");
  colors->SetNumberOfComponents(3);
  colors->SetNumberOfTuples(data->GetNumberOfPoints());
  for (int channel = 0; channel < 3; ++channel) {
    colors->FillComponent(channel, part.color[static_cast<std::size_t>(channel)]);
  }
  data->GetPointData()->SetScalars(colors);
  return data;
}

}  // namespace

void CoarseSurfaces::add(vtkPolyData* data, const image::Rgb& color, double opacity, bool has_colors) {
  auto mapper = make_mapper(data);
  if (has_colors) {
    mapper->ScalarVisibilityOn();
    mapper->SetColorModeToDirectScalars();
  }
  if (cut_ != nullptr) mapper->AddClippingPlane(cut_);
  auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  apply(Appearance{color, opacity, 0.0, 0.0}, *actor);
  if (cut_ != nullptr) actor->GetProperty()->BackfaceCullingOff();
  blend_at_once(*actor);
  actor->GetShaderProperty()->AddFragmentShaderReplacement("//VTK::Light::Impl", true, kSimpleLight, false);
  actor->SetVisibility(is_visible_);
  renderer_.AddActor(actor);
  actors_.push_back(actor);
}

void CoarseSurfaces::set_parts(const std::vector<CoarsePart>& parts) {
  for (const auto& actor : actors_) renderer_.RemoveActor(actor);
  actors_.clear();
  vtkNew<vtkAppendPolyData> together;
  std::vector<const CoarsePart*> translucent;
  for (const CoarsePart& part : parts) {
    if (part.opacity < 1.0) {
      translucent.push_back(&part);
    } else {
      together->AddInputData(colored(part));
    }
  }
  if (translucent.size() < parts.size()) {
    together->Update();
    add(together->GetOutput(), {255, 255, 255}, 1.0, true);
  }
  // Larger parts enclose smaller ones.
  std::sort(translucent.begin(), translucent.end(),
            [](const CoarsePart* a, const CoarsePart* b) { return a->data->GetLength() < b->data->GetLength(); });
  for (const CoarsePart* part : translucent) add(part->data, part->color, part->opacity, false);
}

void CoarseSurfaces::set_visible(bool is_visible) {
  is_visible_ = is_visible;
  for (const auto& actor : actors_) actor->SetVisibility(is_visible);
}

void CoarseSurfaces::set_cut(vtkPlane* cut) {
  cut_ = cut;
  for (const auto& actor : actors_) {
    actor->GetMapper()->RemoveAllClippingPlanes();
    if (cut != nullptr) actor->GetMapper()->AddClippingPlane(cut);
    actor->GetProperty()->SetBackfaceCulling(cut == nullptr && actor->GetProperty()->GetOpacity() < 1.0);
  }
}

void CoarseSurfaces::draw_last() {
  if (actors_.empty() || renderer_.GetViewProps()->GetLastProp() == actors_.back().Get()) return;
  for (const auto& actor : actors_) {
    if (actor->GetProperty()->GetOpacity() >= 1.0) continue;
    renderer_.RemoveActor(actor);
    renderer_.AddActor(actor);
  }
}

}  // namespace trocar::scene::detail
