#pragma once

#include <string>

namespace trocar::patient_builder {

/// Names of the findings.
inline constexpr const char* kMirrored = "mirrored";  ///< Left and right are exchanged.
inline constexpr const char* kTurned = "turned";      ///< Two or three directions are exchanged.
inline constexpr const char* kShifted = "shifted";    ///< The labels lie beside what the CT shows.
inline constexpr const char* kNumbers = "numbers";    ///< The label numbers have another meaning.
inline constexpr const char* kOtherCt = "other-ct";   ///< Many structures have HU that they cannot have.
inline constexpr const char* kCropped = "cropped";    ///< The sides of the CT lie inside the body.
inline constexpr const char* kMissing = "missing";    ///< A large organ has no label in a whole segmentation.
inline constexpr const char* kSizes = "sizes";        ///< An organ has a size or shape that no person's has.
inline constexpr const char* kPlaces = "places";      ///< Single structures lie where they do not belong.
inline constexpr const char* kHu = "hu";              ///< Single structures have HU that they cannot have.
inline constexpr const char* kPosture = "posture";    ///< The CT table lies elsewhere than for the patient's posture.

/// Something about a segmentation as a whole: what no single structure shows, and what makes another patient of it.
struct AnatomyFinding {
  std::string name;      ///< One of the above; a person confirms by it that the patient is really like that.
  std::string text;      ///< What was found, with numbers: one line.
  std::string advice;    ///< What helps, with options of `patient build`.
  bool is_grave = true;  ///< No patient is built unless it is confirmed; else it is told.
  std::string repair{};  ///< The option that repairs it, if there is one: "--mirror labels".
};

inline constexpr const char* kMirrorLabels = "--mirror labels";
inline constexpr const char* kMirrorBoth = "--mirror both";
inline constexpr const char* kUsePosture = "--posture ";     ///< Followed by its name.
inline constexpr const char* kUseLabelMap = "--label-map ";  ///< Followed by its name.

}  // namespace trocar::patient_builder
