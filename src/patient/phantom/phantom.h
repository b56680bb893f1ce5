#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"

namespace trocar::phantom {

/// Name of the procedural patient whose body is drawn from the whole range of bodies by its seed. Its task is the
/// seed's: seed modulo 4 gives liver-biopsy, lumbar-puncture, ascites-puncture, ptcd.
inline constexpr std::string_view kVariantPatient = "variant";
/// Task of that patient.
std::string variant_task(std::uint64_t seed);

/// What is known of an embedded patient before it is generated, for a referral.
struct Referral {
  bool is_female = false;
  double age_years = 0.0;
  double height_cm = 0.0;
  double weight_kg = 0.0;
  std::string indication;   ///< History, question and request.
  std::string coagulation;  ///< "INR 1.4, platelets 95/nl"
  std::string allergies;    ///< "none known"
  anatomy::Posture posture = anatomy::Posture::kSupine;
};

/// An embedded patient that the program generates itself.
struct PhantomInfo {
  std::string name;  ///< "abdomen".
  std::string description;
  std::vector<std::string> tasks;  ///< Names of the tasks that it supports.
  int difficulty = 0;              ///< 1 (easiest) to 5; 0: a test scene.
  std::string briefing = {};       ///< The referral as one text; empty: the description says it all.
  std::optional<Referral> referral = {};
};
/// All of them, in the order of lists. Reads the named cases; without their file, which generate_phantom reports, only
/// the others.
std::vector<PhantomInfo> embedded_patients();
/// One of them; empty: there is none of this name.
std::optional<PhantomInfo> find_embedded_patient(std::string_view name);

/// Files of data_dir() from which the embedded patients are made. Other bytes in one of them give other patients.
std::vector<std::filesystem::path> phantom_data_files();

/// Sampling resolution of the phantom. The anatomy does not depend on it.
struct PhantomResolution {
  std::array<std::int64_t, 3> size{0, 0, 0};  ///< 0: by voxel_mm.
  double voxel_mm = 0.0;  ///< Edge of the voxels, about, 0.5..10; 0: the default grid (1 mm or finer).
};

/// Between the name of an embedded patient and factors on the numbers of its body: "biopsy-1@weight_kg=1.3".
inline constexpr char kBodySign = '@';
/// True if an embedded patient has a body with such numbers: a named case, or the patient drawn by its seed.
bool has_body(std::string_view name);

/// Generates an embedded patient; bit-identical for the same name, seed and resolution, for any number of threads.
/// Reads phantom_data_files(). Errors: an unknown name (exit status 2, the message lists the names); data that are
/// missing or broken; see build_abdomen. Factors after the name change the body (scale_body), for patients
/// that have one.
Result<anatomy::VirtualPatient> generate_phantom(std::string_view name, std::uint64_t seed = 1,
                                                 const PhantomResolution& resolution = {},
                                                 const Progress& progress = {});

}  // namespace trocar::phantom
