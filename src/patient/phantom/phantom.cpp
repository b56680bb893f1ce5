#include "phantom/phantom.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/files/folders.h"
#include "patient_builder/derive/derive_structures.h"
#include "phantom/biopsy.h"
#include "phantom/cases.h"
#include "phantom/layered/layer_scene.h"
#include "phantom/layered/layers.h"
#include "phantom/render.h"
#include "phantom/torso_patient.h"

namespace trocar::phantom {
namespace {

constexpr volume::Index3 kDefaultSize{380, 300, 240};
constexpr std::uint64_t kSeedStep = 7919;
/// The default seed 1 gives an abdomen whose shortest safe path comes from the right flank, between two ribs.
constexpr std::uint64_t kBeforeAbdomen = 9;
constexpr double kLeastVoxel_mm = 0.5, kLargestVoxel_mm = 10.0;
constexpr std::int64_t kLeastSize = 16;
constexpr std::int64_t kGreatestSize = 1024;

/// A box of the reference body, in a patient of another size, divided into voxels; the box is the same for every
/// resolution.
volume::GridGeometry box_geometry(const Box& box, double scale, const volume::Index3& default_size,
                                  const PhantomResolution& resolution) {
  volume::GridGeometry geometry;
  const Vec3 extent = scale * (box.high - box.low).cast<double>();
  for (std::size_t n = 0; n < 3; ++n) {
    const auto a = static_cast<Eigen::Index>(n);
    const std::int64_t usual =
        resolution.voxel_mm > 0.0 ? std::lround(extent[a] / resolution.voxel_mm) : default_size[n];
    geometry.size[n] = resolution.size[n] > 0 ? resolution.size[n] : usual;
    geometry.spacing_mm[a] = extent[a] / static_cast<double>(geometry.size[n]);
    geometry.origin_P[a] = scale * static_cast<double>(box.low[a]) + 0.5 * geometry.spacing_mm[a];
  }
  return geometry;
}

/// Voxels of about 1 mm.
volume::Index3 torso_size(const Box& box, double scale) {
  volume::Index3 size;
  for (std::size_t n = 0; n < 3; ++n) {
    const auto a = static_cast<Eigen::Index>(n);
    size[n] = std::lround(scale * static_cast<double>(box.high[a] - box.low[a]));
  }
  return size;
}

Status check_resolution(const PhantomResolution& resolution) {
  for (const std::int64_t size : resolution.size) {
    if (size != 0 && (size < kLeastSize || size > kGreatestSize))
      return fail_usage("a phantom of " + std::to_string(size) + " voxels along one axis cannot be made", "resolution",
                        "choose 16 to 1024 voxels, or 0 for the default");
  }
  if (resolution.voxel_mm != 0.0 && !(resolution.voxel_mm >= kLeastVoxel_mm && resolution.voxel_mm <= kLargestVoxel_mm))
    return fail_usage(fmt::format("a phantom with voxels of {} mm cannot be made", resolution.voxel_mm), "resolution",
                      fmt::format("choose {} to {} mm", kLeastVoxel_mm, kLargestVoxel_mm));
  return {};
}

struct Sources {
  anatomy::KnownStructures known;
  AbdomenData data;
};

Result<Sources> load_sources() {
  TROCAR_TRY(const std::filesystem::path data_folder, checked_data_dir());
  TROCAR_TRY(anatomy::KnownStructures known, anatomy::KnownStructures::load(data_folder));
  TROCAR_TRY(AbdomenData data, load_abdomen_data(data_folder / kAbdomenFile));
  return Sources{std::move(known), std::move(data)};
}

anatomy::VirtualPatient render_patient(const PhantomInfo& info, std::uint64_t seed, Anatomy& anatomy,
                                       const volume::GridGeometry& geometry, const Progress& progress) {
  Rendering rendering = render(anatomy, geometry, progress);
  anatomy::VirtualPatient patient;
  patient.name = info.name;
  patient.description = info.description;
  patient.provenance = {"generated: embedded patient \"" + info.name + "\", seed " + std::to_string(seed)};
  patient.ct = std::move(rendering.ct);
  patient.labels = std::move(rendering.labels);
  patient.skin_distance_mm = std::move(rendering.skin_distance_mm);
  patient.label_table = std::move(anatomy.label_table);
  return patient;
}

Result<anatomy::VirtualPatient> generate_abdomen(const PhantomInfo& info, std::uint64_t seed,
                                                 const PhantomResolution& resolution, const Progress& progress) {
  report(progress, "generating the anatomy", 0.0);
  TROCAR_TRY(Sources sources, load_sources());
  Anatomy anatomy(seed + kBeforeAbdomen, std::move(sources.data), std::move(sources.known));
  TROCAR_TRY(BiopsyPlan plan, build_abdomen(anatomy));
  const volume::GridGeometry geometry = box_geometry(anatomy.torso.box(), anatomy.scale(), kDefaultSize, resolution);
  anatomy::VirtualPatient patient = render_patient(info, seed, anatomy, geometry, progress);
  patient.landmarks = find_landmarks(anatomy);
  patient.paths = {std::move(plan.path)};
  patient.content_hash = anatomy::hash_patient(patient);
  return patient;
}

Result<anatomy::VirtualPatient> generate_case(const PhantomInfo& info, const CaseDescription& description,
                                              std::uint64_t seed, const PhantomResolution& resolution,
                                              const Progress& progress) {
  report(progress, "generating the anatomy", 0.0);
  TROCAR_TRY(Sources sources, load_sources());
  // Seed 1 is the named case; others vary it.
  const std::uint64_t own_seed = description.seed + (seed - 1) * kSeedStep;
  const Box box = torso_box(sources.data, description.body, own_seed);
  Anatomy anatomy(own_seed, std::move(sources.data), std::move(sources.known), description.body, box);
  anatomy.posture = description.posture;
  TROCAR_TRY(TorsoPlan plan, build_torso(anatomy, description));
  const volume::GridGeometry geometry =
      box_geometry(box, anatomy.scale(), torso_size(box, anatomy.scale()), resolution);
  anatomy::VirtualPatient patient = render_patient(info, seed, anatomy, geometry, progress);
  if (!plan.finding.empty()) patient.description += "; " + plan.finding;
  patient.posture = description.posture;
  patient_builder::derive_structures(patient, anatomy.known, {false, {"neurovascular_bundle"}});
  patient.landmarks = std::move(plan.landmarks);
  patient.paths = std::move(plan.paths);
  patient.content_hash = anatomy::hash_patient(patient);
  return patient;
}

PhantomInfo info_of(const CaseDescription& description) {
  PhantomInfo info{description.name, description.description, {description.task}, description.difficulty};
  if (description.indication.empty()) return info;
  const BodyParameters& body = description.body;
  info.referral =
      Referral{body.sex == Sex::kFemale, body.age_years,          body.height_cm,        body.weight_kg,
               description.indication,   description.coagulation, description.allergies, description.posture};
  info.briefing =
      fmt::format("{} Coagulation: {}. Allergies: {}. Posture: {}.", description.indication, description.coagulation,
                  description.allergies, anatomy::posture_words(description.posture));
  return info;
}

Result<std::vector<CaseDescription>> load_named_cases() {
  TROCAR_TRY(const std::filesystem::path data_folder, checked_data_dir());
  return load_cases(data_folder / kCasesFile);
}

std::string_view phantom_name(std::string_view name) {
  return name.substr(0, name.find(kBodySign));
}
std::string_view factors_of(std::string_view name) {
  return name.substr(std::min(name.size(), phantom_name(name).size() + 1));
}

std::optional<CaseDescription> find_case(const std::vector<CaseDescription>& named, std::string_view name,
                                         std::uint64_t seed) {
  if (name == kVariantPatient) return draw_case(seed);
  const auto found = std::ranges::find(named, name, &CaseDescription::name);
  return found != named.end() ? std::optional(*found) : std::nullopt;
}

}  // namespace

bool has_body(std::string_view name) {
  const auto named = load_named_cases();
  return named && find_case(*named, phantom_name(name), 1).has_value();
}

std::vector<PhantomInfo> embedded_patients() {
  std::vector<PhantomInfo> patients{
      {"abdomen", "upper abdomen in the portal-venous phase with three liver lesions, generated", {"liver-biopsy"}}};
  if (const auto named = load_named_cases())
    for (const CaseDescription& description : *named) patients.push_back(info_of(description));
  patients.insert(patients.end(), layered_scenes().begin(), layered_scenes().end());
  return patients;
}

std::optional<PhantomInfo> find_embedded_patient(std::string_view name) {
  for (PhantomInfo& info : embedded_patients())
    if (info.name == name) return std::move(info);
  return std::nullopt;
}

std::string variant_task(std::uint64_t seed) {
  return draw_case(seed).task;
}

std::vector<std::filesystem::path> phantom_data_files() {
  const std::filesystem::path folder = data_dir();
  return {folder / anatomy::kStructuresFile, folder / kAbdomenFile, folder / kCasesFile, folder / kLayersFile};
}

Result<anatomy::VirtualPatient> generate_phantom(std::string_view name, std::uint64_t seed,
                                                 const PhantomResolution& resolution, const Progress& progress) {
  TROCAR_TRY_STATUS(check_resolution(resolution));
  TROCAR_TRY(const std::vector<CaseDescription> named, load_named_cases());
  const std::string_view plain = phantom_name(name);
  if (auto description = find_case(named, plain, seed)) {
    TROCAR_TRY_STATUS(scale_body(description->body, factors_of(name)));
    PhantomInfo info = info_of(*description);
    info.name = name;
    // A variant's seed is in its description.
    return generate_case(info, *description, plain == kVariantPatient ? 1 : seed, resolution, progress);
  }
  const std::vector<PhantomInfo> patients = embedded_patients();
  if (plain != name && std::ranges::find(patients, plain, &PhantomInfo::name) != patients.end())
    return fail_usage(fmt::format("the embedded patient \"{}\" has no body whose numbers could change", plain), {},
                      fmt::format("omit {}, or name a case: biopsy-1", name.substr(plain.size())));
  const auto found =
      std::find_if(patients.begin(), patients.end(), [&](const PhantomInfo& i) { return i.name == name; });
  if (found == patients.end()) {
    std::string names;
    for (const PhantomInfo& patient : patients) names += (names.empty() ? "" : ", ") + patient.name;
    return fail_usage("unknown embedded patient \"" + std::string(name) + "\"", {}, "there are: " + names);
  }
  if (found != patients.begin()) return make_layered_scene(name, seed, resolution);
  return generate_abdomen(*found, seed, resolution, progress);
}

}  // namespace trocar::phantom
