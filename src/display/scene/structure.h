#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"

namespace trocar::scene {

/// Category of a structure, used to show or hide groups.
enum class StructureKind { kSkin, kBone, kVessel, kLung, kHollowOrgan, kOrgan, kMuscle, kTarget };

/// A surface of the patient with its display properties.
struct StructureInfo {
  std::string name;  ///< Name of the label, or "skin".
  StructureKind kind = StructureKind::kOrgan;
  image::Rgb color{200, 200, 200};
  double opacity = 1.0;          ///< 0 (not drawn) .. 1.
  double default_opacity = 1.0;  ///< Initial opacity.
  bool is_lesion = false;        ///< Lesion of an organ (lesions_as_organs).
  bool is_derived = false;       ///< Made by the program, not in the segmentation.
  bool is_withheld = false;      ///< Not drawn at any opacity, and its name must not be displayed.
};

/// Preset of visible structures.
enum class StructurePreset {
  kAll,       ///< Each with its default opacity.
  kSkinOnly,  ///< The opaque skin.
  kBones,     ///< Bones and cartilage.
  kVessels,   ///< Vessels and the target, with faint bones.
  kTarget,    ///< The target, the organ around it translucent, and vessels.
};

/// All surfaces with kind, colour and default opacity, skin first, then by kind and name. `target_name` is the target
/// structure (find_aim), `around_name` the organ around it; both may be empty.
std::vector<StructureInfo> describe_structures(const anatomy::LabelTable& table,
                                               const std::vector<anatomy::NamedMesh>& meshes,
                                               std::string_view target_name, std::string_view around_name);
/// Order of a list of structures: by kind, then by name.
bool is_listed_before(const StructureInfo& a, const StructureInfo& b);
/// Opacity of a structure in a preset, 0..1.
double preset_opacity(const StructureInfo& structure, StructurePreset preset, std::string_view around_name) noexcept;

/// The target and the structure around it; "" if there is none.
struct Aim {
  std::string target_name;
  std::string around_name;
  bool operator==(const Aim&) const = default;
};

/// Aim for a point in P. The target is the structure at the point, except fat and muscle. Deep in an organ there is no
/// target structure, and the organ is the structure around. Otherwise the structure around is the most frequent one on
/// a sphere of 20 mm, except the target, fat and muscle.
Aim find_aim(const anatomy::VirtualPatient& patient, const Vec3& target_P);

}  // namespace trocar::scene

namespace trocar::scene::detail {

inline constexpr double kOrganAroundTargetOpacity = 0.42;

/// Appearance of a surface.
struct Appearance {
  image::Rgb color;
  double opacity = 1.0;   ///< 0..1
  double specular = 0.2;  ///< 0..1
  double ambient = 0.14;  ///< 0..1, ambient coefficient
  StructureKind kind = StructureKind::kOrgan;
};

/// Appearance of the surface `name`, a label of the table or "skin"; empty for an unknown name. Structures that would
/// hide the others (fat, muscle) have opacity 0.
std::optional<Appearance> find_appearance(const anatomy::LabelTable& table, std::string_view name);

}  // namespace trocar::scene::detail
