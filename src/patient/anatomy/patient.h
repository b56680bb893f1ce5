#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/shapes.h"
#include "geometry/vec.h"
#include "image/image.h"
#include "motion/motion_model.h"
#include "volume/grid.h"

namespace trocar::anatomy {

/// One structure of the label volume.
struct Label {
  std::uint8_t id = 0;  ///< Value in the label volume; 0 is never a label.
  std::string name;  ///< As in the segmentation, else one of those found from HU: "rib_right_9", "livertumor1", "fat".
  std::string tissue;  ///< Tissue class (TissueTable): "bone", "liver".
  image::Rgb color{200, 200, 200};
  bool is_derived = false;  ///< Made by the program from HU or from other labels; not in the segmentation.
};

/// All structures of a patient, ordered by id; ids and names are unique.
struct LabelTable {
  std::vector<Label> labels;

  const Label* find(std::uint8_t id) const noexcept;
  const Label* find(std::string_view name) const noexcept;
};

/// For each label id: for a lesion (tissue "X_lesion"), the id of its organ, the first label of tissue "X", or 0 if the
/// table has none; for all other labels, the id itself.
std::array<std::uint8_t, 256> lesions_as_organs(const LabelTable& table) noexcept;

/// How the patient lies or sits.
enum class Posture : std::uint8_t { kSupine, kProne, kLeftLateral, kRightLateral, kSitting };

/// "supine", "prone", "left-lateral" (lying on the left side), "right-lateral", "sitting".
std::string_view posture_name(Posture posture);
std::optional<Posture> find_posture(std::string_view name);
/// "lying on the back".
std::string_view posture_words(Posture posture);
/// Direction of gravity in P (unit vector).
Vec3 gravity_P(Posture posture);

/// A named point of the patient.
struct Landmark {
  std::string name;
  Vec3 p_P;
};

/// A straight needle path from the skin to a target: an expert path or a planned one. Paths that a patient brings for a
/// task are named "TASK: place".
struct NeedlePath {
  std::string name;
  Segment line_P;  ///< a: entry on the skin, b: target.
};

struct NamedMesh {
  std::string name;  ///< The label's name, or "skin".
  TriangleMesh mesh_P;
};

/// Something about a segmentation that a person should look at, or a fault in it that was repaired.
struct Finding {
  std::string text;             ///< One line without the place.
  std::string label;            ///< The structure; may be empty.
  std::optional<Vec3> place_P;  ///< Where to look; empty: it has no place.
};

/// The virtual patient: immutable once built. All volumes share one geometry; LPS, mm, at rest: frame A, which is P
/// unless the patient moves (motion/patient_motion.h).
struct VirtualPatient {
  std::string name;
  std::string description;
  std::vector<std::string> provenance;  ///< Provenance, one line per step; contains no path of this machine.
  volume::CtGrid ct;                    ///< HU.
  volume::LabelGrid labels;             ///< Structures, and inside the body fat and muscle found from HU.
  LabelTable label_table;
  volume::FloatGrid skin_distance_mm;  ///< Signed distance to the skin, negative inside the body.
  Posture posture = Posture::kSupine;  ///< How the patient lay in the scanner, and lies for the puncture.
  std::vector<Landmark> landmarks;
  std::vector<NeedlePath> paths;  ///< Expert paths.
  std::vector<Finding> repairs;   ///< What the build repaired in the segmentation.
  /// How the anatomy moves; nullptr: it does not. Not a part of content_hash; it has a hash of its own.
  std::shared_ptr<const motion::MotionModel> motion;
  std::string content_hash;  ///< Hash of CT, labels and label table (hash_patient).
};

/// Content hash of CT, labels, geometry and label table.
std::string hash_patient(const VirtualPatient& patient);

/// Hash of the patient's motion model; empty without one.
inline std::string motion_hash(const VirtualPatient& patient) {
  return patient.motion == nullptr ? std::string() : patient.motion->hash();
}

/// Label at a point of A; nullptr where nothing is labelled or outside the volume.
const Label* find_label(const VirtualPatient& patient, const Vec3& p_A) noexcept;

}  // namespace trocar::anatomy
