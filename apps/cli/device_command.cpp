// trocar device list.
#include <fmt/format.h>

#include "cli/commands.h"
#include "cli/constants.h"
#include "cli/json_parts.h"
#include "config/json.h"
#include "stylus/device_preset.h"

namespace trocar::cli {
namespace {

/// Unknown or missing values are null.
config::Json optional_json(const std::optional<double>& value) {
  return value ? config::Json(*value) : config::Json(nullptr);
}

config::Json preset_json(const stylus::DevicePreset& preset) {
  const stylus::DeviceCapability& capability = preset.capability;
  return {{"name", preset.name},
          {"title", preset.title},
          {"sensed_dof", preset.sensed_dof},
          {"actuated_dof", preset.actuated_dof},
          {"workspace_radius_mm", preset.workspace_radius_mm},
          {"peak_force_n", capability.peak_force_n},
          {"continuous_force_n", optional_json(preset.continuous_force_n)},
          {"peak_torque_nmm", capability.peak_torque_nmm},
          {"continuous_torque_nmm", optional_json(preset.continuous_torque_nmm)},
          {"max_stiffness_n_per_mm", capability.max_stiffness_n_per_mm},
          {"position_count_mm", preset.encoder.count_mm},
          {"angle_count_deg",
           preset.sensed_dof == 6 ? config::Json(preset.encoder.count_rad * kDegPerRad) : config::Json(nullptr)},
          {"max_damping_ns_per_mm", preset.max_damping_ns_per_mm},
          {"apparent_mass_kg", preset.apparent_mass_kg},
          {"friction_n", preset.friction_n},
          {"viscosity_ns_per_mm", preset.viscosity_ns_per_mm},
          {"force_scale", preset.force_scale},
          {"motion_scale", preset.motion_scale},
          {"clutch_button", preset.clutch_button},
          {"base_mm", vector_json(preset.X_WD.p())},
          {"base_turn_deg", vector_json(rotation_vector(preset.X_WD.R()) * kDegPerRad)},
          {"stylus_weight_n", capability.stylus_weight_n},
          {"coupling_stiffness_n_per_mm", preset.coupling.stiffness_n_per_mm},
          {"coupling_damping_ns_per_mm", preset.coupling.damping_ns_per_mm}};
}

void print_preset(const stylus::DevicePreset& preset) {
  const stylus::DeviceCapability& capability = preset.capability;
  const std::string torque = preset.has_torque() ? fmt::format("{:.0f} N mm", capability.peak_torque_nmm) : "none";
  const std::string force = preset.has_force() ? fmt::format("{:.1f} N", capability.peak_force_n) : "shown";
  fmt::print("{:<10} {:>8} {:>9} {:>5.1f} N/mm {:>7.4f} mm {:>5.2f} N/mm  {}\n", preset.name, force, torque,
             capability.max_stiffness_n_per_mm, preset.encoder.count_mm, preset.coupling.stiffness_n_per_mm,
             preset.title);
}

Status list_devices(bool is_json) {
  TROCAR_TRY(const auto file, find_data("devices.toml"));
  TROCAR_TRY(const auto presets, stylus::load_device_presets(file));
  if (is_json) {
    config::Json list = config::Json::array();
    for (const stylus::DevicePreset& preset : presets) list.push_back(preset_json(preset));
    print_json({{"devices", list}});
    return {};
  }
  fmt::print("{:<10} {:>8} {:>9} {:>10} {:>10} {:>10}\n", "name", "force", "torque", "stiffness", "count", "coupling");
  for (const stylus::DevicePreset& preset : presets) print_preset(preset);
  return {};
}

}  // namespace

void add_device_commands(Command& program, Action& action) {
  Command device = program.add_command("device", "Haptic devices");
  device.require_command();
  device.footer("Example:\n  trocar device list\n");
  Command list = device.add_command("list",
                                    "List the devices of data/devices.toml: peak force and torque, stiffness, "
                                    "encoder resolution, coupling stiffness");
  list.footer("Example:\n  trocar device list --json\n");
  const auto is_json = std::make_shared<bool>(false);
  list.add_flag("--json", *is_json, "Print one JSON object");
  list.when_parsed([&action, is_json] { action = [is_json] { return list_devices(*is_json); }; });
}

}  // namespace trocar::cli
