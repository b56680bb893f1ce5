#include "haptics/option_texts.h"

#include <fmt/format.h>

#include <string_view>
#include <type_traits>

#include "core/text.h"

namespace trocar::haptics {
namespace {

constexpr std::string_view kForceModel = "force_model";
constexpr std::string_view kOfConstraint = "constraint.";

static_assert(motion::kMostDrivers == 2, "the list of options names each driver");

/// The single list of options and device numbers: calls visit(name, field) for each; a field is a double or a bool.
template <class Options, class Device, class Visitor>
void visit_numbers(Options& options, Device& device, Visitor&& visit) {
  visit("coupling.stiffness", options.coupling.stiffness_n_per_mm);
  visit("coupling.damping", options.coupling.damping_ns_per_mm);
  visit("constraint.force", options.constraint.force_n);
  visit("constraint.distance", options.constraint.linear_mm);
  visit("constraint.torque", options.constraint.torque_nmm);
  visit("constraint.angle", options.constraint.linear_rad);
  visit("constraint.fade", options.constraint.fade_mm);
  visit("stick", options.has_stick);
  visit("weight_compensation", options.has_weight_compensation);
  visit("bending", options.has_bending);
  visit("motion.period", options.motion.period_s);
  visit("motion.begins", options.motion.begins_s);
  visit("motion.held", options.motion.is_held);
  visit("motion.held_phase", options.motion.held_phase);
  visit("motion.depth_1", options.motion.depth[0]);
  visit("motion.depth_2", options.motion.depth[1]);
  visit("motion.pause", options.motion.pause_share);
  visit("motion.irregularity", options.motion.irregularity);
  visit("motion.cough_every", options.motion.cough_every_s);
  visit("motion.seed", options.motion.seed);
  visit("motion.hold", options.motion.hold_s);
  visit("motion.release", options.motion.release_s);
  visit("motion.hold_limit", options.motion.hold_limit_s);
  visit("motion.drift", options.motion.drift_per_s);
  visit("motion.first_depth", options.motion.first_depth);
  visit("motion.drifted", options.motion.drifted);
  visit("device.peak_force", device.peak_force_n);
  visit("device.peak_torque", device.peak_torque_nmm);
  visit("device.peak_roll", device.peak_roll_nmm);
  visit("device.stiffness", device.max_stiffness_n_per_mm);
  visit("device.weight", device.stylus_weight_n);
  visit("device.lever", device.stylus_lever_mm);
}

Result<double> number_of(std::string_view name, std::string_view text) {
  if (const auto number = parse_number<double>(text)) return *number;
  return fail_usage(fmt::format("\"{}\" is not a finite number", text), std::string(name), "give a decimal number");
}

Status restore_option(std::string_view name, std::string_view value, HapticOptions& options,
                      stylus::DeviceCapability& device) {
  if (name == kForceModel) {
    TROCAR_TRY(options.force_model, parse_force_model(value));
    return {};
  }
  TROCAR_TRY(const double number, number_of(name, value));
  bool is_known = false;
  visit_numbers(options, device, [&](std::string_view known, auto& field) {
    if (known != name) return;
    is_known = true;
    if (name.starts_with(kOfConstraint)) return;
    using Field = std::remove_reference_t<decltype(field)>;
    if constexpr (std::is_same_v<Field, bool>)
      field = number != 0.0;
    else if constexpr (std::is_same_v<Field, std::uint32_t>)
      field = static_cast<std::uint32_t>(std::clamp(number, 0.0, 4294967295.0));
    else
      field = number;
  });
  if (is_known) return {};
  return fail_usage("unknown option of a scene", std::string(name), "use a version of the program that knows it");
}

}  // namespace

std::vector<std::string> option_texts(const HapticScene& scene) {
  std::vector<std::string> texts{fmt::format("{}={}", kForceModel, to_string(scene.options.force_model))};
  visit_numbers(scene.options, scene.device, [&](const char* name, const auto& field) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(field)>, bool>)
      texts.push_back(fmt::format("{}={:d}", name, field));
    else
      texts.push_back(fmt::format("{}={}", name, field));
  });
  return texts;
}

Status restore_options(std::span<const std::string> texts, HapticOptions& options, stylus::DeviceCapability& device) {
  for (const std::string& text : texts) {
    const std::string_view view = text;
    const std::size_t at = view.find('=');
    if (at == std::string_view::npos)
      return fail_usage("an option of a scene is NAME=VALUE", text, "write it with one '='");
    TROCAR_TRY_STATUS(restore_option(view.substr(0, at), view.substr(at + 1), options, device));
  }
  return {};
}

void apply_device_preset(const stylus::DevicePreset& preset, HapticOptions& options) noexcept {
  options.coupling = preset.coupling;
  PathConstraintParams& constraint = options.constraint;
  constraint.force_n = std::min(constraint.force_n, preset.coupling.stiffness_n_per_mm * constraint.linear_mm);
}

}  // namespace trocar::haptics
