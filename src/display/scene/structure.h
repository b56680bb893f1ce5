#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"

namespace trocar::scene {

/// Category of a structure, used to show or hide groups.
enum class StructureKind { kSkin, kBone, kVessel, kLung, kHollowOrgan, kOrgan, kMuscle, kTarget };

/// A surface of the patient and how it is shown.
struct StructureInfo {
  std::string name;  ///< The label's, or "skin".
  StructureKind kind = StructureKind::kOrgan;
  volume::Rgb color{200, 200, 200};
  double opacity = 1.0;          ///< 0 (not drawn) .. 1.
  double default_opacity = 1.0;  ///< That it begins with.
  bool is_lesion = false;        ///< Of an organ (lesions_as_organs).
  bool is_withheld = false;      ///< Not drawn, whatever its opacity, and not to be named either.
};

/// Which structures are seen.
enum class StructurePreset {
  kAll,       ///< Each with its default opacity.
  kSkinOnly,  ///< The opaque skin.
  kBones,     ///< Bones and cartilage.
  kVessels,   ///< Vessels and the target, in faint bones.
  kTarget,    ///< The target, the organ around it translucent, and vessels.
};

/// All surfaces with kind, colour and default opacity, skin first, then by kind and name. `target_name` is the
/// structure that is aimed at (find_aim), `around_name` the organ around it; both may be empty.
std::vector<StructureInfo> describe_structures(const anatomy::LabelTable& table,
                                               const std::vector<anatomy::NamedMesh>& meshes,
                                               std::string_view target_name, std::string_view around_name);
/// Opacity of a structure in a preset, 0..1.
double preset_opacity(const StructureInfo& structure, StructurePreset preset, std::string_view around_name) noexcept;

/// The target and the structure around it; "" if there is none.
struct Aim {
  std::string target_name;
  std::string around_name;
  bool operator==(const Aim&) const = default;
};

/// Of a point of P. The target is the structure there, but fat and muscle never are. A place deep in an organ is no
/// structure of its own: the organ is around it. Else what is around is met most often on a ball of 20 mm that is not
/// the target, fat or muscle.
Aim find_aim(const anatomy::VirtualPatient& patient, const Vec3& target_P);

}  // namespace trocar::scene
