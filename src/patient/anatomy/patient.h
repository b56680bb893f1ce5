#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/label_table.h"
#include "anatomy/posture.h"
#include "geometry/segment.h"
#include "geometry/triangle_mesh.h"
#include "motion/motion_model.h"
#include "volume/grid.h"

namespace trocar::anatomy {

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
const Label* find_label(const VirtualPatient& patient, const Vec3& p_P) noexcept;

}  // namespace trocar::anatomy
