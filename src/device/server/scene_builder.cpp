#include "server/scene_builder.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <new>

#include "anatomy/tissue/tissue_settings.h"
#include "haptics/option_texts.h"
#include "stylus/device_preset.h"

namespace trocar::server {
namespace {

haptics::NeedleGeometry needle_of(const link::LoadScene& request) noexcept {
  haptics::NeedleGeometry needle;
  needle.length_mm = request.needle_length_mm;
  needle.radius_mm = request.needle_radius_mm;
  needle.inner_radius_mm = request.needle_inner_radius_mm;
  needle.stylet_radius_mm = request.needle_stylet_radius_mm;
  needle.young_gpa = request.needle_young_gpa;
  needle.bevel_rad = request.needle_bevel_rad;
  needle.bevel_share = request.needle_bevel_share;
  return needle;
}

/// The options that the request has; the others stay.
Status apply_options(const link::SetParameters& request, haptics::HapticOptions& options) {
  if (!request.force_model.empty()) {
    TROCAR_TRY(options.force_model, haptics::parse_force_model(request.force_model));
  }
  stylus::CouplingParams& coupling = options.coupling;
  coupling.stiffness_n_per_mm = request.coupling_stiffness_n_per_mm.value_or(coupling.stiffness_n_per_mm);
  coupling.damping_ns_per_mm = request.coupling_damping_ns_per_mm.value_or(coupling.damping_ns_per_mm);
  options.has_bending = request.has_bending.value_or(options.has_bending);
  options.motion = request.motion.value_or(options.motion);
  return {};
}

anatomy::TissueSetting setting_of(const link::TissueSetting& setting) {
  return {setting.row, setting.key, setting.value.value_or(std::numeric_limits<double>::infinity())};
}

/// Any step can run out of memory: then the scene is refused, and the loop continues with the last one.
template <class Step>
Result<ServoScene> with_memory_checked(const std::string& patient, const Step& step) {
  try {
    return step();
  } catch (const std::bad_alloc&) {
    return fail("not enough memory to load the scene", patient, "close other programs or load a smaller patient");
  }
}

}  // namespace

SceneBuilder::SceneBuilder(PatientOpener open_patient, std::filesystem::path tissues_file, stylus::DevicePreset device)
    : open_patient_(std::move(open_patient)), tissues_file_(std::move(tissues_file)), device_(std::move(device)) {}

Result<std::shared_ptr<const anatomy::VirtualPatient>> SceneBuilder::patient_for(const link::LoadScene& request,
                                                                                 const Progress& progress) {
  const bool is_known =
      patient_ != nullptr && request.patient == request_.patient && request.patient_seed == request_.patient_seed;
  std::shared_ptr<const anatomy::VirtualPatient> patient = patient_;
  if (!is_known) {
    TROCAR_TRY(patient, open_patient_(request.patient, request.patient_seed, progress));
  }
  if (!request.patient_hash.empty() && patient->content_hash != request.patient_hash) {
    if (is_known) {  // the folder may have been rebuilt
      TROCAR_TRY(patient, open_patient_(request.patient, request.patient_seed, progress));
    }
    if (patient->content_hash != request.patient_hash)
      return fail("the server's patient differs from the client's (different content hash)", request.patient,
                  "give both the same folder and version");
  }
  if (!request.motion_hash.empty() && anatomy::motion_hash(*patient) != request.motion_hash)
    return fail("the motion of the server's patient differs from that of the client's (different hash)",
                request.patient, "give both the same folder and version");
  return patient;
}

Result<SceneBuilder::Parts> SceneBuilder::parts_for(const link::LoadScene& request) const {
  Parts parts;
  if (request.tissues_toml.empty()) {
    TROCAR_TRY(parts.loaded, anatomy::load_tissue_table(tissues_file_));
  } else {
    TROCAR_TRY(parts.loaded, anatomy::parse_tissue_table(request.tissues_toml, "the client's tissue table"));
  }
  parts.tissues = parts.loaded;
  haptics::apply_device_preset(device_, parts.options);
  parts.options.coupling =
      stylus::within(parts.options.coupling, stylus::limits_of(device_));  // its scales may require a softer coupling
  TROCAR_TRY(parts.options.tool, haptics::parse_tool(request.tool));
  TROCAR_TRY(parts.options.force_model, haptics::parse_force_model(request.force_model));
  parts.options.seed = request.seed;
  parts.options.motion = request.motion;
  return parts;
}

Result<ServoScene> SceneBuilder::build(const link::LoadScene& request,
                                       std::shared_ptr<const anatomy::VirtualPatient> patient, Parts parts,
                                       bool continues) {
  haptics::HapticOptions options = parts.options;
  // The tick uses patient newtons and mm; the gate applies the device's own limits, after the scales.
  const stylus::DeviceCapability capability = stylus::scene_capability(device_);
  const double stiffest = capability.max_stiffness_n_per_mm;
  TROCAR_TRY_STATUS(check(options.coupling, stylus::limits_of(device_)));
  options.constraint.force_n = std::min(options.constraint.force_n, stiffest * options.constraint.linear_mm);
  TROCAR_TRY(auto built, haptics::make_haptic_scene(patient, parts.tissues, needle_of(request), capability, options));
  auto scene = std::make_shared<haptics::HapticScene>(*built);
  scene->X_PW = request.X_PW;
  scene->gravity_P = -request.X_PW.R().col(2);  // down in the room

  request_ = request;
  patient_ = std::move(patient);
  parts_ = std::move(parts);
  return ServoScene{std::move(scene), ++number_, continues};
}

Result<ServoScene> SceneBuilder::load(const link::LoadScene& request, const Progress& progress,
                                      const std::stop_token& stop) {
  return with_memory_checked(request.patient, [&] { return load_throwing(request, progress, stop); });
}

Result<ServoScene> SceneBuilder::load_throwing(const link::LoadScene& request, const Progress& progress,
                                               const std::stop_token& stop) {
  const auto check_stop = [&]() -> Status {
    if (!stop.stop_requested()) return {};
    return fail("loading was stopped: a newer scene was sent, or the server is shutting down", request.patient,
                "load it again");
  };
  TROCAR_TRY_STATUS(check_stop());
  report(progress, "checking the scene", 0.0);
  TROCAR_TRY(Parts parts, parts_for(request));
  TROCAR_TRY(auto patient, patient_for(request, progress));
  TROCAR_TRY_STATUS(check_stop());
  report(progress, "building the scene", 0.9);
  return build(request, std::move(patient), std::move(parts), false);
}

Result<ServoScene> SceneBuilder::change(const link::SetParameters& request) {
  return with_memory_checked(request_.patient, [&] { return change_throwing(request); });
}

Result<ServoScene> SceneBuilder::change_throwing(const link::SetParameters& request) {
  if (patient_ == nullptr) return fail("no scene loaded; cannot change parameters", "", "load one first");
  Parts parts = parts_;
  if (!request.tissues_toml.empty()) {
    TROCAR_TRY(parts.loaded, anatomy::parse_tissue_table(request.tissues_toml, "the client's tissue table"));
  }
  TROCAR_TRY_STATUS(apply_options(request, parts.options));
  if (request.tissues || !request.tissues_toml.empty()) parts.tissues = parts.loaded;
  if (request.tissues) {
    for (const link::TissueSetting& setting : *request.tissues)
      TROCAR_TRY_STATUS(anatomy::apply_setting(parts.tissues, setting_of(setting)));
  }
  const bool continues = parts.options.force_model == parts_.options.force_model;
  return build(request_, patient_, std::move(parts), continues);
}

}  // namespace trocar::server
