#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"

namespace trocar::phantom {

enum class Sex : unsigned char { kFemale, kMale };

/// What a procedural patient is made from, besides the seed. Defaults: the reference body of data/phantoms.
struct BodyParameters {
  Sex sex = Sex::kMale;
  double height_cm = 172.0;  ///< Range 145..200. The whole body is scaled by it.
  double weight_kg = 72.0;   ///< Range 38..160. With the height it gives the thickness of the subcutaneous fat.
  double age_years =
      50.0;  ///< Range 18..95. Older: lower discs, less dense bone, more fat in muscles, calcified aorta.
  double scoliosis_deg = 0.0;           ///< Cobb angle, -45..45; positive: convex to the patient's left.
  double flexion = 0.0;                 ///< 0 lying flat .. 1 back bent as for a lumbar puncture.
  double interspace_share = 1.0;        ///< Height of the spaces between the spinous processes, 0.45..1.2 of the usual.
  double liver_size = 1.0;              ///< Factor on the liver's lengths, 0.8..1.15.
  double lesion_diameter_mm = 21.0;     ///< Of the first lesion, 6..45.
  double lesion_contrast_hu = -40.0;    ///< First lesion against liver, -80..40.
  double ascites_ml = 0.0;              ///< Free fluid, 0..8000.
  double duct_diameter_mm = 4.0;        ///< Of the common hepatic duct: 4 is normal, 8 and more dilated; 2..16.
  bool has_obstruction = false;         ///< A tumour closes the bile duct at `obstruction_share` of its length.
  double obstruction_share = 0.8;       ///< 0 at the hilum .. 1 at the papilla.
  std::string phase = "portal-venous";  ///< Contrast phase: native, arterial or portal-venous.
  double noise_hu = 14.0;               ///< Noise in the middle of the body, 3..40: the dose.

  double body_mass_index() const { return weight_kg / (height_cm * height_cm * 1e-4); }
};

/// A named procedural patient of data/phantoms/cases.toml: one body, made for one task.
struct CaseDescription {
  std::string name;         ///< "lumbar-1".
  std::string task;         ///< "lumbar-puncture".
  int difficulty = 1;       ///< 1 (easiest) to 5.
  std::string description;  ///< One line.
  std::string indication;   ///< Of the referral: history, question and request.
  std::string coagulation;  ///< "INR 1.4, platelets 95/nl"
  std::string allergies;    ///< "none known"
  std::uint64_t seed = 1;
  anatomy::Posture posture = anatomy::Posture::kSupine;
  BodyParameters body;
};

/// File in the data folder.
inline constexpr std::string_view kCasesFile = "phantoms/cases.toml";

/// Reads data/phantoms/cases.toml. Errors name file and key: a missing or unknown key, a number out of range, a name
/// that occurs twice.
Result<std::vector<CaseDescription>> load_cases(const std::filesystem::path& path);

/// Multiplies numbers of a body, within their ranges: "weight_kg=1.3,lesion_diameter_mm=0.7". Errors (exit status 2):
/// an unknown key, the message lists the keys; a factor that is no number from 0.2 to 5.
Status scale_body(BodyParameters& body, std::string_view factors);

/// A body drawn from the whole range of bodies, for one of the four tasks.
CaseDescription draw_case(std::uint64_t seed);

}  // namespace trocar::phantom
