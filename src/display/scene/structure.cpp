#include "scene/structure.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <map>

#include "anatomy/structure_words.h"

namespace trocar::scene {
namespace {

constexpr double kFaint = 0.15;
constexpr double kAroundTarget = 0.35;
constexpr double kAroundRadius_mm = 20.0;
constexpr double kDeepRadius_mm = 12.0;
constexpr double kDeepShare = 0.6;

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

bool fills_space(const anatomy::Label& label) {
  return label.tissue == "adipose" || label.tissue == "muscle" || label.tissue == "soft_tissue";
}

/// Points in a ball, evenly distributed for a vote.
std::vector<Vec3> ball_about(const Vec3& middle_P, double radius_mm) {
  std::vector<Vec3> points_P;
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z) {
        if (x != 0 || y != 0 || z != 0) points_P.push_back(middle_P + radius_mm * Vec3(x, y, z).normalized());
      }
    }
  }
  return points_P;
}

/// True if an organ surrounds the point, not a small structure of the same name.
bool is_deep_in_organ(const anatomy::VirtualPatient& patient, const Vec3& p_P, const anatomy::Label& organ) {
  const auto look = detail::find_appearance(patient.label_table, organ.name);
  if (!look || look->kind != StructureKind::kOrgan) return false;
  const std::vector<Vec3> ball_P = ball_about(p_P, kDeepRadius_mm);
  const auto same = std::count_if(ball_P.begin(), ball_P.end(),
                                  [&](const Vec3& q_P) { return anatomy::find_label(patient, q_P) == &organ; });
  return static_cast<double>(same) > kDeepShare * static_cast<double>(ball_P.size());
}

}  // namespace

std::vector<StructureInfo> describe_structures(const anatomy::LabelTable& table,
                                               const std::vector<anatomy::NamedMesh>& meshes,
                                               std::string_view target_name, std::string_view around_name) {
  const std::array<std::uint8_t, 256> organ_of = anatomy::lesions_as_organs(table);
  std::vector<StructureInfo> structures;
  for (const anatomy::NamedMesh& mesh : meshes) {
    if (mesh.mesh_P.triangles.empty()) continue;
    const auto look = detail::find_appearance(table, mesh.name);
    if (!look) continue;
    StructureInfo info{mesh.name, look->kind, look->color, look->opacity, look->opacity};
    if (const anatomy::Label* label = table.find(mesh.name)) {
      info.is_lesion = organ_of[label->id] != label->id;
      info.is_derived = label->is_derived;
    }
    if (mesh.name == target_name) info.kind = StructureKind::kTarget;
    if (mesh.name == around_name && info.opacity > detail::kOrganAroundTargetOpacity) {
      info.opacity = info.default_opacity = detail::kOrganAroundTargetOpacity;
    }
    structures.push_back(std::move(info));
  }
  std::sort(structures.begin(), structures.end(), is_listed_before);
  return structures;
}

bool is_listed_before(const StructureInfo& a, const StructureInfo& b) {
  if (a.kind != b.kind) return order_of(a.kind) < order_of(b.kind);
  return anatomy::is_name_before(a.name, b.name);
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

Aim find_aim(const anatomy::VirtualPatient& patient, const Vec3& target_P) {
  const anatomy::Label* inside = anatomy::find_label(patient, target_P);
  if (inside != nullptr && fills_space(*inside)) inside = nullptr;
  if (inside != nullptr && is_deep_in_organ(patient, target_P, *inside)) return Aim{{}, inside->name};
  std::map<std::string_view, int> votes;
  for (const Vec3& p_P : ball_about(target_P, kAroundRadius_mm)) {
    const anatomy::Label* label = anatomy::find_label(patient, p_P);
    if (label != nullptr && label != inside && !fills_space(*label)) ++votes[label->name];
  }
  const auto best =
      std::max_element(votes.begin(), votes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  Aim aim;
  if (inside != nullptr) aim.target_name = inside->name;
  if (best != votes.end()) aim.around_name = best->first;
  return aim;
}

}  // namespace trocar::scene

namespace trocar::scene::detail {
namespace {

constexpr image::Rgb kSkinColor = {224, 178, 150};
constexpr image::Rgb kIvory = {236, 226, 202};
constexpr double kSkinOpacity = 0.15;
constexpr double kLungOpacity = 0.16;
constexpr double kFluidOpacity = 0.3;

bool is_one_of(std::string_view tissue, std::initializer_list<std::string_view> list) {
  for (const std::string_view entry : list) {
    if (entry == tissue) return true;
  }
  return false;
}

}  // namespace

std::optional<Appearance> find_appearance(const anatomy::LabelTable& table, std::string_view name) {
  if (name == "skin") return Appearance{kSkinColor, kSkinOpacity, 0.1, 0.5, StructureKind::kSkin};
  const anatomy::Label* label = table.find(name);
  if (label == nullptr) return std::nullopt;
  const std::string& tissue = label->tissue;
  if (is_one_of(tissue, {"adipose", "muscle", "soft_tissue"}))
    return Appearance{label->color, 0.0, 0.1, 0.2, StructureKind::kMuscle};
  if (tissue == "bone") return Appearance{kIvory, 1.0, 0.15, 0.14, StructureKind::kBone};
  if (tissue == "cartilage") return Appearance{label->color, 1.0, 0.25, 0.14, StructureKind::kBone};
  if (tissue == "lung") return Appearance{label->color, kLungOpacity, 0.0, 0.5, StructureKind::kLung};
  if (tissue == "liver") {
    return Appearance{label->color, kOrganAroundTargetOpacity, 0.35, 0.25, StructureKind::kOrgan};
  }
  if (is_one_of(tissue, {"ascites", "fluid", "peritoneum", "pleura"})) {
    return Appearance{label->color, kFluidOpacity, 0.3, 0.3, StructureKind::kOrgan};
  }
  if (is_one_of(tissue, {"vessel", "bile_duct"}))
    return Appearance{label->color, 1.0, 0.25, 0.14, StructureKind::kVessel};
  if (tissue == "liver_lesion") return Appearance{label->color, 1.0, 0.25, 0.2, StructureKind::kTarget};
  if (tissue == "bowel") return Appearance{label->color, 1.0, 0.25, 0.14, StructureKind::kHollowOrgan};
  return Appearance{label->color, 1.0, 0.25};
}

}  // namespace trocar::scene::detail
