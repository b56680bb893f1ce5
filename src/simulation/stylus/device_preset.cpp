#include "stylus/device_preset.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "config/toml.h"

namespace trocar::stylus {
namespace {

Status read_value(const config::TomlTable& row, std::string_view key, config::Range range, double& value) {
  TROCAR_TRY(const config::SourcedNumber number, config::read_sourced_number(row, key, range));
  value = number.value;
  return {};
}

Status read_optional(const config::TomlTable& row, std::string_view key, config::Range range,
                     std::optional<double>& value) {
  if (!row.has(key)) return {};
  double number = 0.0;
  TROCAR_TRY_STATUS(read_value(row, key, range, number));
  value = number;
  return {};
}

/// Reads a sourced number if the key is present; otherwise `value` is unchanged.
Status read_given(const config::TomlTable& row, std::string_view key, config::Range range, double& value) {
  return row.has(key) ? read_value(row, key, range, value) : Status{};
}

/// Three plain numbers if the key is present (a calibration is measured on site and has no source), else zero.
Result<Vec3> read_vec3(const config::TomlTable& row, std::string_view key, config::Range range) {
  if (!row.has(key)) return Vec3(Vec3::Zero());
  TROCAR_TRY(const std::vector<double> numbers, row.numbers(key, range));
  if (numbers.size() != 3)
    return fail(fmt::format("{} has {} numbers, must be 3", key, numbers.size()), row.where(),
                "give three numbers: x, y, z");
  return Vec3(numbers[0], numbers[1], numbers[2]);
}

Result<int> read_dof(const config::TomlTable& row, std::string_view key, bool may_be_none) {
  TROCAR_TRY(const std::int64_t dof, row.integer(key, {0, 6}));
  const bool is_known = dof == 3 || dof == 6 || (dof == 0 && may_be_none);
  if (is_known) return static_cast<int>(dof);
  return fail(fmt::format("{} is {}, must be {}3 or 6", key, dof, may_be_none ? "0, " : ""), row.where(),
              "correct it in the device table");
}

Status read_motion(const config::TomlTable& row, DevicePreset& preset) {
  TROCAR_TRY(preset.sensed_dof, read_dof(row, "sensed_dof", false));
  TROCAR_TRY(preset.actuated_dof, read_dof(row, "actuated_dof", true));
  TROCAR_TRY_STATUS(read_value(row, "workspace_radius_mm", {10.0, 1000.0}, preset.workspace_radius_mm));
  TROCAR_TRY_STATUS(read_value(row, "position_count_mm", {1e-4, 1.0}, preset.encoder.count_mm));
  TROCAR_TRY_STATUS(read_value(row, "apparent_mass_kg", {0.01, 2.0}, preset.apparent_mass_kg));
  TROCAR_TRY_STATUS(read_given(row, "friction_n", {0.0, 2.0}, preset.friction_n));
  TROCAR_TRY_STATUS(read_given(row, "viscosity_ns_per_mm", {0.0, 0.05}, preset.viscosity_ns_per_mm));
  preset.encoder.count_rad = 0.0;
  if (preset.sensed_dof == 3) return {};
  double count_deg = 0.0;
  TROCAR_TRY_STATUS(read_value(row, "angle_count_deg", {1e-4, 5.0}, count_deg));
  preset.encoder.count_rad = count_deg * kRadPerDeg;
  return {};
}

Status read_forces(const config::TomlTable& row, DevicePreset& preset) {
  DeviceCapability& capability = preset.capability;
  TROCAR_TRY_STATUS(read_value(row, "peak_force_n", {0.1, 200.0}, capability.peak_force_n));
  TROCAR_TRY_STATUS(
      read_optional(row, "continuous_force_n", {0.1, capability.peak_force_n}, preset.continuous_force_n));
  TROCAR_TRY_STATUS(read_value(row, "max_stiffness_n_per_mm", {0.1, 20.0}, capability.max_stiffness_n_per_mm));
  TROCAR_TRY_STATUS(read_value(row, "stylus_weight_n", {0.0, 5.0}, capability.stylus_weight_n));
  TROCAR_TRY_STATUS(read_value(row, "stylus_lever_mm", {0.0, 200.0}, capability.stylus_lever_mm));
  TROCAR_TRY_STATUS(read_value(row, "coupling_stiffness_n_per_mm", {0.01, capability.max_stiffness_n_per_mm},
                               preset.coupling.stiffness_n_per_mm));
  TROCAR_TRY_STATUS(read_value(row, "coupling_damping_ns_per_mm", {0.0, 1.0}, preset.coupling.damping_ns_per_mm));
  TROCAR_TRY_STATUS(read_given(row, "max_damping_ns_per_mm", {0.0, 0.1}, preset.max_damping_ns_per_mm));
  if (const Status fits = check(preset.coupling, limits_of(preset)); !fits)
    return fail(fits.error().what, row.where(), fits.error().advice);
  capability.peak_torque_nmm = capability.peak_roll_nmm = 0.0;
  if (preset.actuated_dof != 6) return {};
  TROCAR_TRY_STATUS(read_value(row, "peak_torque_nmm", {1.0, 5000.0}, capability.peak_torque_nmm));
  TROCAR_TRY_STATUS(read_given(row, "peak_roll_nmm", {1.0, capability.peak_torque_nmm}, capability.peak_roll_nmm));
  const double most_roll_nmm = capability.peak_roll_nmm > 0.0 ? capability.peak_roll_nmm : capability.peak_torque_nmm;
  TROCAR_TRY_STATUS(read_optional(row, "continuous_roll_nmm", {0.1, most_roll_nmm}, preset.continuous_roll_nmm));
  return read_optional(row, "continuous_torque_nmm", {0.1, capability.peak_torque_nmm}, preset.continuous_torque_nmm);
}

/// Mapping of its motion and force to the patient.
Status read_mapping(const config::TomlTable& row, DevicePreset& preset) {
  constexpr config::Range kRoom_mm{-5000.0, 5000.0};
  constexpr config::Range kTurn_deg{-360.0, 360.0};
  TROCAR_TRY_STATUS(read_given(row, "force_scale", {0.01, 1.0}, preset.force_scale));
  TROCAR_TRY_STATUS(read_given(row, "motion_scale", {0.1, 10.0}, preset.motion_scale));
  if (row.has("clutch_button")) {
    TROCAR_TRY(const std::int64_t button, row.integer("clutch_button", {0, 2}));
    preset.clutch_button = static_cast<int>(button);
  }
  TROCAR_TRY(const Vec3 base_mm, read_vec3(row, "base_mm", kRoom_mm));
  TROCAR_TRY(const Vec3 base_deg, read_vec3(row, "base_deg", kTurn_deg));
  const Vec3 turn = base_deg * kRadPerDeg;
  const Mat3 R_WD = (Eigen::AngleAxisd(turn.z(), Vec3::UnitZ()) * Eigen::AngleAxisd(turn.y(), Vec3::UnitY()) *
                     Eigen::AngleAxisd(turn.x(), Vec3::UnitX()))
                        .toRotationMatrix();
  preset.X_WD = Pose(R_WD, base_mm);
  return {};
}

Result<DevicePreset> read_preset(const config::TomlTable& row, const std::string& name) {
  DevicePreset preset;
  preset.name = name;
  TROCAR_TRY(preset.title, row.string("title"));
  TROCAR_TRY_STATUS(read_motion(row, preset));
  TROCAR_TRY_STATUS(read_forces(row, preset));
  TROCAR_TRY_STATUS(read_mapping(row, preset));
  std::vector<std::string_view> known = {"title",
                                         "sensed_dof",
                                         "actuated_dof",
                                         "workspace_radius_mm",
                                         "position_count_mm",
                                         "apparent_mass_kg",
                                         "peak_force_n",
                                         "continuous_force_n",
                                         "max_stiffness_n_per_mm",
                                         "stylus_weight_n",
                                         "stylus_lever_mm",
                                         "coupling_stiffness_n_per_mm",
                                         "coupling_damping_ns_per_mm",
                                         "max_damping_ns_per_mm",
                                         "friction_n",
                                         "viscosity_ns_per_mm",
                                         "force_scale",
                                         "motion_scale",
                                         "clutch_button",
                                         "base_mm",
                                         "base_deg"};
  if (preset.sensed_dof == 6) known.push_back("angle_count_deg");
  if (preset.actuated_dof == 6)
    known.insert(known.end(), {"peak_torque_nmm", "continuous_torque_nmm", "peak_roll_nmm", "continuous_roll_nmm"});
  TROCAR_TRY_STATUS(row.check_keys(known));
  return preset;
}

}  // namespace

Result<std::vector<DevicePreset>> load_device_presets(const std::filesystem::path& path) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(path));
  TROCAR_TRY_STATUS(document.check_keys({"devices"}));
  TROCAR_TRY(const config::TomlTable rows, document.table("devices"));
  std::vector<DevicePreset> presets;
  for (const std::string& name : rows.keys()) {
    TROCAR_TRY(const config::TomlTable row, rows.table(name));
    TROCAR_TRY(DevicePreset preset, read_preset(row, name));
    presets.push_back(std::move(preset));
  }
  return presets;
}

Result<DevicePreset> load_device_preset(const std::filesystem::path& path, std::string_view name) {
  TROCAR_TRY(std::vector<DevicePreset> presets, load_device_presets(path));
  const auto it = std::find_if(presets.begin(), presets.end(), [&](const DevicePreset& p) { return p.name == name; });
  if (it != presets.end()) return std::move(*it);
  std::vector<std::string_view> names;
  for (const DevicePreset& preset : presets) names.push_back(preset.name);
  return fail_usage(fmt::format("there is no device \"{}\"", name), path.string(),
                    fmt::format("known are: {}", fmt::join(names, ", ")));
}

DeviceCapability scene_capability(const DevicePreset& preset) noexcept {
  DeviceCapability capability = preset.capability;
  capability.peak_force_n /= preset.force_scale;
  capability.peak_torque_nmm /= preset.force_scale;
  capability.peak_roll_nmm /= preset.force_scale;
  capability.stylus_weight_n /= preset.force_scale;
  capability.max_stiffness_n_per_mm /= preset.motion_scale * preset.force_scale;
  return capability;
}

namespace {

// Known ratios: 6.2/37.5 N and 0.88/3.3 N, 188/515 N mm (data/devices.toml, premium and omni).
constexpr double kContinuousForceShare = 0.2;   // [assumed, 0.15..0.5]
constexpr double kContinuousTorqueShare = 0.3;  // [assumed, 0.15..0.5]

}  // namespace

double continuous_force_n(const DevicePreset& preset) noexcept {
  const double peak_n = preset.capability.peak_force_n;
  return std::min(peak_n, preset.continuous_force_n.value_or(kContinuousForceShare * peak_n));
}

double continuous_torque_nmm(const DevicePreset& preset) noexcept {
  const double peak_nmm = preset.capability.peak_torque_nmm;
  return std::min(peak_nmm, preset.continuous_torque_nmm.value_or(kContinuousTorqueShare * peak_nmm));
}

double continuous_roll_nmm(const DevicePreset& preset) noexcept {
  const double peak_nmm = preset.capability.peak_roll_nmm;
  return std::min(peak_nmm, preset.continuous_roll_nmm.value_or(kContinuousTorqueShare * peak_nmm));
}

namespace {

Status check_coupling_value(double value, double low, double high, const char* name, const char* unit) {
  constexpr double kRounding = 1e-9;  // a scale and its inverse
  if (std::isfinite(value) && value >= low * (1.0 - kRounding) && value <= high * (1.0 + kRounding)) return {};
  return fail_usage(fmt::format("{} is {:.4g} {}", name, value, unit), "the coupling of this device",
                    fmt::format("give a number from {:.4g} to {:.4g}", low, high));
}

}  // namespace

CouplingLimits limits_of(const DevicePreset& preset) noexcept {
  const double scale = preset.motion_scale * preset.force_scale;
  CouplingLimits limits;
  limits.most_n_per_mm = preset.capability.max_stiffness_n_per_mm / scale;
  if (preset.has_force()) limits.most_ns_per_mm = preset.max_damping_ns_per_mm / scale;
  limits.least_n_per_mm = std::min(limits.least_n_per_mm, limits.most_n_per_mm);
  return limits;
}

CouplingParams within(const CouplingParams& coupling, const CouplingLimits& limits) noexcept {
  CouplingParams nearest = coupling;
  nearest.stiffness_n_per_mm = std::clamp(coupling.stiffness_n_per_mm, limits.least_n_per_mm, limits.most_n_per_mm);
  nearest.damping_ns_per_mm *= std::min(1.0, nearest.stiffness_n_per_mm / coupling.stiffness_n_per_mm);
  const double most_ns_per_mm = std::min(limits.most_ns_per_mm, limits.longest_s * nearest.stiffness_n_per_mm);
  nearest.damping_ns_per_mm = std::clamp(nearest.damping_ns_per_mm, 0.0, most_ns_per_mm);
  return nearest;
}

Status check(const CouplingParams& coupling, const CouplingLimits& limits) {
  TROCAR_TRY_STATUS(check_coupling_value(coupling.stiffness_n_per_mm, limits.least_n_per_mm, limits.most_n_per_mm,
                                         "coupling.stiffness", "N/mm"));
  const double most_ns_per_mm = std::min(limits.most_ns_per_mm, limits.longest_s * coupling.stiffness_n_per_mm);
  return check_coupling_value(coupling.damping_ns_per_mm, 0.0, most_ns_per_mm, "coupling.damping", "N s/mm");
}

namespace {

Vec3 rounded(const Vec3& v, double count) noexcept {
  return count > 0.0 ? Vec3((v / count).array().round() * count) : v;
}

}  // namespace

Pose quantise(const Pose& X_DS, const EncoderParams& encoder) noexcept {
  const Vec3 p = rounded(X_DS.p(), encoder.count_mm);
  if (!(encoder.count_rad > 0.0)) return {X_DS.R(), p};
  return {rotation_from_vector(rounded(rotation_vector(X_DS.R()), encoder.count_rad)), p};
}

}  // namespace trocar::stylus
