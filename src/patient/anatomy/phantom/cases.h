#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/phantom/body_parameters.h"
#include "anatomy/posture.h"
#include "core/result.h"

namespace trocar::anatomy::phantom {

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
  Posture posture = Posture::kSupine;
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

}  // namespace trocar::anatomy::phantom
