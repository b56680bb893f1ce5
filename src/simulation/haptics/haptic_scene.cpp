#include "haptics/haptic_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/log.h"
#include "volume/sampling.h"

namespace trocar::haptics {
namespace {

Status check_range(double value, double low, double high, const char* name) {
  if (std::isfinite(value) && value >= low && value <= high) return {};
  return fail_usage(fmt::format("{} is {}, allowed is {} to {}", name, value, low, high), "haptic scene",
                    "choose a value in the allowed range");
}

Status check_numbers(const NeedleGeometry& needle, const stylus::DeviceCapability& device,
                     const HapticOptions& options) {
  TROCAR_TRY_STATUS(check_range(needle.radius_mm, 0.1, 2.5, "needle radius (mm)"));
  TROCAR_TRY_STATUS(check_range(needle.length_mm, 20.0, 300.0, "needle length (mm)"));
  TROCAR_TRY_STATUS(check_range(needle.inner_radius_mm, 0.0, 0.95 * needle.radius_mm, "radius of the bore (mm)"));
  TROCAR_TRY_STATUS(check_range(needle.stylet_radius_mm, 0.0, needle.inner_radius_mm, "radius of the stylet (mm)"));
  TROCAR_TRY_STATUS(check_range(needle.young_gpa, 50.0, 250.0, "Young's modulus of the needle (GPa)"));
  TROCAR_TRY_STATUS(check_range(needle.bevel_rad, 0.05, 1.571, "bevel (rad)"));
  TROCAR_TRY_STATUS(check_range(needle.bevel_share, 0.0, 1.0, "bevel's sideways share"));
  TROCAR_TRY_STATUS(check_range(needle.body_proxies, 1.0, kMaxBodyProxies, "number of body proxies"));
  TROCAR_TRY_STATUS(check_range(device.max_stiffness_n_per_mm, 0.1, 20.0, "device stiffness (N/mm)"));
  TROCAR_TRY_STATUS(check_range(device.peak_force_n, 0.1, 200.0, "device peak force (N)"));
  TROCAR_TRY_STATUS(check_range(device.peak_torque_nmm, 0.0, 5000.0, "device peak torque (N mm)"));
  TROCAR_TRY_STATUS(check_range(device.peak_roll_nmm, 0.0, 5000.0, "device peak roll torque (N mm)"));
  TROCAR_TRY_STATUS(check_range(device.stylus_weight_n, 0.0, 5.0, "stylus weight (N)"));
  const auto& constraint = options.constraint;
  TROCAR_TRY_STATUS(check_range(constraint.linear_mm, 0.5, 20.0, "path constraint d0 (mm)"));
  TROCAR_TRY_STATUS(check_range(constraint.linear_rad, 0.01, 1.0, "path constraint theta0 (rad)"));
  TROCAR_TRY_STATUS(check_range(constraint.torque_nmm, 0.0, 500.0, "path constraint n0 (N mm)"));
  TROCAR_TRY_STATUS(check_range(constraint.fade_mm, 5.0, 100.0, "path constraint s0 (mm)"));
  TROCAR_TRY_STATUS(check_range(options.coupling.damping_ns_per_mm, 0.0, 1.0, "coupling damping (N s/mm)"));
  TROCAR_TRY_STATUS(check_range(options.coupling.stiffness_n_per_mm, 0.01, device.max_stiffness_n_per_mm,
                                "coupling stiffness (N/mm, at most the device's)"));
  return check_range(constraint.force_n / constraint.linear_mm, 0.0, device.max_stiffness_n_per_mm,
                     "path constraint m0/d0 (N/mm, at most the device's)");
}

/// The constraint with the numbers of a table that was fitted to a patient, as far as the device can render them.
PathConstraintParams fitted(PathConstraintParams constraint, const anatomy::PathConstraintLaw& law,
                            const stylus::DeviceCapability& device) noexcept {
  if (!law.is_given) return constraint;
  constraint.force_n = std::min(law.force_n, device.max_stiffness_n_per_mm * constraint.linear_mm);
  constraint.torque_nmm = law.torque_nmm;
  return constraint;
}

/// A spring with the puncture force at the same indentation as the loading law.
double indentation_stiffness(const LoadingLaw& law, double puncture_force_n) noexcept {
  if (!std::isfinite(puncture_force_n)) return law.stiffness_n_per_mm;
  return puncture_force_n / static_displacement_mm(puncture_force_n, law);
}

Status fill_laws(HapticScene& scene, const anatomy::TissueTable& table) {
  if (table.tissues.size() > kMaxTissues || table.layers.size() > kMaxLayers)
    return fail(fmt::format("more than {} tissues or {} layers", kMaxTissues, kMaxLayers), "tissue table",
                "remove rows that the patient does not use");
  scene.tissue_count = static_cast<int>(table.tissues.size());
  scene.layer_count = static_cast<int>(table.layers.size());
  for (std::size_t i = 0; i < table.layers.size(); ++i) {
    const anatomy::LayerParams& layer = table.layers[i];
    const LoadingLaw loading{layer.stiffness_n_per_mm, layer.viscosity_ns_per_mm, layer.delta_x_mm};
    const double puncture_force_n =
        layer.puncture_force_n * needle_size_factor(table.needle_size, layer.for_diameter_mm, scene.needle);
    scene.layers[i] = {loading,       puncture_force_n,     indentation_stiffness(loading, puncture_force_n),
                       layer.is_wall, layer.load_spread_mm, layer.pressed_young_kpa};
    if (!(layer.delta_x_mm > 0.0) || !(layer.puncture_force_n > 0.0))
      return fail_usage(fmt::format("layer {} needs positive dx and puncture force", layer.name), "tissue table",
                        "set delta_x_mm and fp above 0");
  }
  const double size = needle_size_factor(table.needle_size, 0.0, scene.needle);
  const double girth =
      table.needle_size.diameter_mm > 0.0 ? 2.0 * scene.needle.radius_mm / table.needle_size.diameter_mm : 1.0;
  for (std::size_t i = 0; i < table.tissues.size(); ++i) {
    const anatomy::TissueParams& tissue = table.tissues[i];
    scene.tissues[i] = {tissue.viscosity_ns_per_mm,
                        tissue.roughness_n * tissue.friction_mu * girth,
                        tissue.stick_n_per_mm * girth,
                        tissue.cutting_n * size,
                        tissue.young_kpa,
                        tissue.friction_mu,
                        tissue.layer.value_or(kNoLayer)};
  }
  scene.skin = table.skin;
  scene.transfer = table.transfer;
  for (std::size_t i = 0; i < scene.transfer.knot_count; ++i) {
    anatomy::HuLaw& law = scene.transfer.laws[i];
    law.stiffness_n_per_mm *= size;  // a thicker needle indents no further before the border gives way
    law.normal_n *= size;
    law.tangential_n *= size;
    law.resistance_n *= size;
    law.shaft_n_per_mm *= girth;
  }
  scene.skin_thickness_mm = table.skin_thickness_mm;
  scene.friction = table.friction;
  scene.has_path_constraint = table.path_constraint.is_given && scene.options.force_model == ForceModel::kInsertion;
  return {};
}

/// The proxy models read labelled tissue without a wall from the CT.
void mark_read_from_ct(HapticScene& scene) {
  if (scene.options.force_model == ForceModel::kInsertion) return;
  for (std::size_t i = 1; i < static_cast<std::size_t>(scene.tissue_count); ++i) {
    const std::uint8_t layer = scene.tissues[i].layer;
    scene.tissues[i].is_read_from_ct = i != scene.skin && (layer == kNoLayer || !scene.layers[layer].is_wall);
  }
}

Status fill_label_tissues(HapticScene& scene, const anatomy::TissueTable& table) {
  const auto unlabelled = table.find_tissue("soft_tissue");
  if (!unlabelled) return fail("has no tissue named soft_tissue", "tissue table", "add it");
  scene.tissue_of_label.fill(*unlabelled);
  std::vector<std::string> unknown;
  for (const anatomy::Label& label : scene.patient->label_table.labels) {
    const auto tissue = table.find_tissue(label.tissue);
    scene.tissue_of_label[label.id] = tissue.value_or(*unlabelled);
    if (!tissue) unknown.push_back(fmt::format("{} ({})", label.name, label.tissue));
  }
  if (!unknown.empty())
    log_warning("{}: not in the tissue table; soft_tissue is used instead: {}", scene.patient->name,
                fmt::join(unknown, ", "));
  return {};
}

/// The columns of tissue under a face use labels, or HU without labels.
Status check_palpable(const anatomy::VirtualPatient& patient, const anatomy::TissueTable& tissues) {
  if (!patient.labels.empty()) return {};
  if (!patient.ct.empty() && tissues.transfer.knot_count > 0) return {};
  return fail("the patient has neither labels nor a CT for the tissue table, which the skin stiffness needs",
              patient.name, "build it with labels or with a CT");
}

Status check_patient(const anatomy::VirtualPatient* patient, const anatomy::TissueTable& tissues,
                     const HapticOptions& options) {
  const ForceModel model = options.force_model;
  if (!patient) return fail("no patient loaded", "haptic scene", "load a patient first");
  if (patient->skin_distance_mm.empty()) return fail("the patient has no skin", patient->name, "build it again");
  if (options.tool != Tool::kNeedle) return check_palpable(*patient, tissues);
  if (model == ForceModel::kInsertion && patient->labels.empty())
    return fail("the patient has no labels, which the insertion model needs", patient->name,
                "build it with labels, or use --force-model proxy");
  if (model != ForceModel::kInsertion && patient->ct.empty())
    return fail("the patient has no CT, which the proxy reads", patient->name,
                "build it with a CT, or use --force-model insertion");
  return {};
}

}  // namespace

const char* to_string(ForceModel model) noexcept {
  switch (model) {
    case ForceModel::kInsertion:
      return "insertion";
    case ForceModel::kProxy:
      return "proxy";
    case ForceModel::kCombined:
      return "combined";
  }
  return "insertion";
}

Result<ForceModel> parse_force_model(std::string_view name) {
  for (const ForceModel model : {ForceModel::kInsertion, ForceModel::kProxy, ForceModel::kCombined}) {
    if (name == to_string(model)) return model;
  }
  return fail_usage(fmt::format("there is no force model {}", name), "--force-model",
                    "use insertion, proxy or combined");
}

Result<std::shared_ptr<const HapticScene>> make_haptic_scene(std::shared_ptr<const anatomy::VirtualPatient> patient,
                                                             const anatomy::TissueTable& tissues,
                                                             const NeedleGeometry& needle,
                                                             const stylus::DeviceCapability& device,
                                                             const HapticOptions& options) {
  TROCAR_TRY_STATUS(check_patient(patient.get(), tissues, options));
  TROCAR_TRY_STATUS(check_numbers(needle, device, options));
  if (options.tool == Tool::kNeedle && options.force_model != ForceModel::kInsertion &&
      tissues.transfer.knot_count == 0)
    return fail("has no transfer functions, which the proxy needs", "tissue table", "add [transfer] to it");
  TROCAR_TRY_STATUS(motion::check(options.motion));
  auto scene = std::make_shared<HapticScene>();
  scene->patient = std::move(patient);
  scene->needle = needle;
  scene->device = device;
  scene->options = options;
  const PathConstraintParams constraint = fitted(options.constraint, tissues.path_constraint, device);
  scene->options.constraint = renderable(constraint);
  if (!device.has_torque()) {
    scene->options.constraint = constraint;
    scene->options.constraint.torque_nmm = 0.0;
  }
  scene->beam_with_stylet = make_needle_beam(needle, true);
  scene->beam_without_stylet = make_needle_beam(needle, false);
  scene->face = make_face(options.tool);
  scene->X_SN =
      options.tool == Tool::kNeedle ? Pose::translation({0.0, 0.0, needle.length_mm}) : tool_in_stylus(scene->face);
  TROCAR_TRY_STATUS(fill_laws(*scene, tissues));
  mark_read_from_ct(*scene);
  TROCAR_TRY_STATUS(fill_label_tissues(*scene, tissues));
  return scene;
}

TissueAt tissue_at(const HapticScene& scene, const Vec3& p_A) noexcept {
  const double distance_mm = volume::sample_linear(scene.patient->skin_distance_mm, p_A);
  if (!(distance_mm <= 0.0)) return {};
  const volume::LabelGrid& labels = scene.patient->labels;
  const std::uint8_t label = labels.empty() ? std::uint8_t{0} : volume::sample_nearest(labels, p_A, std::uint8_t{0});
  if (distance_mm > -scene.skin_thickness_mm) return {scene.skin, label};
  return {scene.tissue_of_label[label], label};
}

}  // namespace trocar::haptics
