#include "scene/structure.h"

#include <algorithm>
#include <map>
#include <tuple>

#include "scene/detail/appearance.h"

namespace trocar {
namespace {

constexpr double kFaint = 0.15;
constexpr double kAroundTarget = 0.35;

int order_of(StructureKind kind) {
  switch (kind) {
    case StructureKind::kSkin:
      return 0;
    case StructureKind::kTarget:
      return 1;
    case StructureKind::kOrgan:
      return 2;
    case StructureKind::kHollowOrgan:
      return 3;
    case StructureKind::kVessel:
      return 4;
    case StructureKind::kBone:
      return 5;
    case StructureKind::kLung:
      return 6;
    case StructureKind::kMuscle:
      return 7;
  }
  return 8;
}

bool fills_space(const Label& label) {
  return label.tissue == "adipose" || label.tissue == "muscle" || label.tissue == "soft_tissue";
}

}  // namespace

std::vector<StructureInfo> describe_structures(const LabelTable& table, const std::vector<NamedMesh>& meshes,
                                               std::string_view target_name, std::string_view around_name) {
  std::vector<StructureInfo> structures;
  for (const NamedMesh& mesh : meshes) {
    if (mesh.mesh_P.triangles.empty()) continue;
    const auto look = detail::find_appearance(table, mesh.name);
    if (!look) continue;
    StructureInfo info{mesh.name, look->kind, look->color, look->opacity, look->opacity};
    if (mesh.name == target_name) info.kind = StructureKind::kTarget;
    if (mesh.name == around_name && info.opacity > detail::kOrganAroundTargetOpacity) {
      info.opacity = info.default_opacity = detail::kOrganAroundTargetOpacity;
    }
    structures.push_back(std::move(info));
  }
  std::sort(structures.begin(), structures.end(), [](const StructureInfo& a, const StructureInfo& b) {
    return std::tuple(order_of(a.kind), std::string_view(a.name)) <
           std::tuple(order_of(b.kind), std::string_view(b.name));
  });
  return structures;
}

double preset_opacity(const StructureInfo& structure, StructurePreset preset, std::string_view around_name) noexcept {
  const StructureKind kind = structure.kind;
  switch (preset) {
    case StructurePreset::kAll:
      return structure.default_opacity;
    case StructurePreset::kSkinOnly:
      return kind == StructureKind::kSkin ? 1.0 : 0.0;
    case StructurePreset::kBones:
      return kind == StructureKind::kBone ? 1.0 : 0.0;
    case StructurePreset::kVessels:
      if (kind == StructureKind::kVessel || kind == StructureKind::kTarget) return 1.0;
      return kind == StructureKind::kBone ? kFaint : 0.0;
    case StructurePreset::kTarget:
      if (kind == StructureKind::kVessel || kind == StructureKind::kTarget) return 1.0;
      return structure.name == around_name ? kAroundTarget : 0.0;
  }
  return structure.default_opacity;
}

std::string find_target_name(const VirtualPatient& patient, const Vec3& target_P) {
  const Label* label = find_label(patient, target_P);
  return label == nullptr || fills_space(*label) ? std::string() : label->name;
}

std::string find_name_around(const VirtualPatient& patient, const Vec3& target_P, double radius_mm) {
  const Label* inside = find_label(patient, target_P);
  std::map<std::string_view, int> votes;
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        if (x == 0 && y == 0 && z == 0) continue;
        const Label* label = find_label(patient, target_P + radius_mm * Vec3(x, y, z).normalized());
        if (label != nullptr && label != inside && !fills_space(*label)) ++votes[label->name];
      }
    }
  }
  const auto best =
      std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return best == votes.end() ? std::string() : std::string(best->first);
}

}  // namespace trocar
