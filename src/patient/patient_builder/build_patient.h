#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"
#include "patient_builder/derive/derive_structures.h"
#include "patient_builder/plausibility/anatomy_finding.h"

namespace trocar::patient_builder {

/// What the numbers of a segmentation would mean by another label map.
struct OtherReading {
  std::string label_map;  ///< Option that selects it: "totalsegmentator:total_v1".
  std::string words;      ///< "TotalSegmentator 1".
  std::vector<std::pair<int, std::string>> names;
  std::string advice{};  ///< How to select it, if not by the option.
};

/// A structure as it was read from a segmentation, on its own grid.
struct LabelSource {
  std::string file;                                ///< For messages.
  volume::LabelGrid labels;                        ///< Values as in the file.
  std::vector<std::pair<int, std::string>> names;  ///< Value in the file -> structure name, or kIgnoredStructure.
  /// It names its structures itself (DICOM SEG, RT structure set, .seg.nrrd): beyond its grid there are none, and the
  /// values mean nothing to a user.
  bool is_described = false;
  std::vector<OtherReading> other_readings{};  ///< Likely mistakes; for numbers that a label map names.
  std::string numbers_of{};                    ///< The scheme that names the numbers: "TotalSegmentator 2".
};

/// Name in a label map of label values that are left out. Background names are left out, too.
inline constexpr std::string_view kIgnoredStructure = "ignore";

/// What was mirrored left to right before the build, on request.
enum class Mirroring { kNone, kLabels, kBoth };

struct BuildOptions {
  std::string name;
  std::vector<std::string> provenance;
  DeriveChoice derive{};                                 ///< Thin structures to add (derive/derive_structures.h).
  anatomy::Posture posture = anatomy::Posture::kSupine;  ///< For the puncture.
  Mirroring mirroring = Mirroring::kNone;                ///< For the advice of findings.
  std::vector<std::string> confirmed{};                  ///< Names of findings that a person has confirmed.
  bool has_checked_hu = false;                           ///< The caller has called check_hounsfield.
  std::vector<AnatomyFinding>* findings = nullptr;       ///< Receives all findings, also if one of them is the error.
};

/// A patient from a CT and segmentations: the body without table and clothing, labels resampled onto the CT's grid with
/// priorities where they overlap, fat and muscle from HU inside the body, signed distance to the skin. The patient's
/// volumes have their axes in the order of P (volume/resample.h), whatever the order in the files. The structures
/// are those of data_dir(), loaded once (KnownStructures). Errors: no such data, impossible HU (check_hounsfield), a
/// segmentation that does not overlap the CT, unknown structure names and values without a name (all of them in one
/// line), no body in the CT, all masks empty, a grave finding that is not confirmed (mirrored, turned or shifted
/// labels, numbers of another label map). Warnings (an empty mask, a structure cut by the volume's border, a
/// segmentation of a part of the CT, labels of one name, which become one structure, regions) are appended to
/// `warnings`.
Result<anatomy::VirtualPatient> build_patient(volume::CtGrid ct, std::vector<LabelSource> sources,
                                              const BuildOptions& options, std::vector<std::string>& warnings,
                                              const Progress& progress = {});

/// The body in a CT: skin contour filled, CT table, clothes and air removed. Cavities that leave the scan at the head
/// or the feet are closed in axial slices: k must run along the body (volume/resample.h, checked).
volume::MaskGrid find_body(const volume::CtGrid& ct);

}  // namespace trocar::patient_builder
