#include "devices/workspace_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <system_error>

#include "config/toml.h"
#include "config/toml_writer.h"
#include "core/files/output_file.h"
#include "devices/haptic_device.h"

namespace trocar::devices {
namespace {

Pose shown(const WorkspaceState& state, double motion_scale, const Pose& X_DS) noexcept {
  const Pose& X_WD = state.X_WD_now;
  return {X_WD.R() * X_DS.R() * state.R_SS_now, X_WD * Vec3(motion_scale * X_DS.p())};
}

/// Moves base and tool so that this reading maps to the pose held by the clutch.
void release(WorkspaceState& state, double motion_scale, const Pose& X_DS) noexcept {
  const Mat3& R_WD = state.X_WD_now.R();
  state.R_SS_now = (R_WD * X_DS.R()).transpose() * state.X_WS_held.R();
  state.X_WD_now = Pose(R_WD, state.X_WS_held.p() - R_WD * (motion_scale * X_DS.p()));
  state.is_clutched = false;
}

}  // namespace

WorkspaceParams workspace_params(const stylus::DevicePreset& preset) noexcept {
  WorkspaceParams params{preset.X_WD, preset.motion_scale, preset.force_scale, 0};
  if (preset.clutch_button == 1) params.clutch = kButtonMain;
  if (preset.clutch_button == 2) params.clutch = kButtonSecond;
  return params;
}

Pose map_to_room(WorkspaceState& state, const WorkspaceParams& params, const Pose& X_DS,
                 std::uint32_t buttons) noexcept {
  if (!state.is_started) {
    state = {};
    state.X_WD_now = params.X_WD;
    state.is_started = true;
  }
  if (!X_DS.is_finite()) return X_DS;
  const bool is_pressed = (buttons & params.clutch) != 0;
  if (is_pressed && !state.is_clutched) {
    state.X_WS_held = shown(state, params.motion_scale, X_DS);
    state.is_clutched = true;
  }
  if (!is_pressed && state.is_clutched) release(state, params.motion_scale, X_DS);
  return state.is_clutched ? state.X_WS_held : shown(state, params.motion_scale, X_DS);
}

Pose map_from_room(const WorkspaceState& state, const WorkspaceParams& params, const Pose& X_WS) noexcept {
  const Pose& X_WD = state.is_started ? state.X_WD_now : params.X_WD;
  return {X_WD.R().transpose() * X_WS.R() * state.R_SS_now.transpose(),
          X_WD.inverse() * X_WS.p() / params.motion_scale};
}

Wrench map_to_device(const WorkspaceState& state, const WorkspaceParams& params, const Wrench& wrench_W) noexcept {
  if (state.is_clutched) return {};
  const Mat3 R_DW = (state.is_started ? state.X_WD_now : params.X_WD).R().transpose();
  return {R_DW * wrench_W.force_n * params.force_scale, R_DW * wrench_W.torque_nmm * params.force_scale};
}

Wrench without_torque(const Wrench& wrench, const Vec3& axis, const std::optional<Vec3>& p_SE) noexcept {
  Wrench turned{wrench.force_n, Vec3::Zero()};
  if (!p_SE) return turned;
  // A lateral force g at S has the moment -lever axis x g about the entry point: g = axis x torque / lever replaces the
  // torque, except its component along the axis, which cannot be replaced.
  const double lever_mm = p_SE->dot(axis);
  const double least_mm = std::max(std::abs(lever_mm), kLeastLever_mm);
  turned.force_n += axis.cross(wrench.torque_nmm) * (lever_mm / (least_mm * least_mm));
  return turned;
}

namespace {

namespace fs = std::filesystem;

constexpr config::Range kWeight_n{0.0, 5.0};
constexpr config::Range kLever_mm{-200.0, 200.0};
constexpr const char* kWeighAgain = "delete the file, or weigh the stylus again";

bool is_plain(char c) noexcept {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

std::string to_toml(const StylusProfile& profile) {
  config::TomlWriter writer;
  writer.comment("Weight of the stylus, measured by trocar-hapticd --test (weigh). Without this file, the weight in");
  writer.comment("data/devices.toml applies.");
  writer.set("device", profile.device);
  writer.set("preset", profile.preset);
  writer.set("stylus_weight_n", profile.weight_n);
  if (profile.lever_mm) writer.set("stylus_lever_mm", *profile.lever_mm);
  return writer.text();
}

Result<StylusProfile> parse_profile(std::string_view text, const std::string& file) {
  TROCAR_TRY(const config::TomlTable table, config::parse_toml(text, file));
  TROCAR_TRY_STATUS(table.check_keys({"device", "preset", "stylus_weight_n", "stylus_lever_mm"}));
  StylusProfile profile;
  TROCAR_TRY(profile.device, table.string("device"));
  TROCAR_TRY(profile.preset, table.string("preset"));
  TROCAR_TRY(profile.weight_n, table.number("stylus_weight_n", kWeight_n));
  if (table.has("stylus_lever_mm")) {
    TROCAR_TRY(profile.lever_mm, table.number("stylus_lever_mm", kLever_mm));
  }
  return profile;
}

Result<StylusProfile> read_profile(const fs::path& file) {
  constexpr std::size_t kMostBytes = 64 * 1024;
  TROCAR_TRY(const std::string text, read_file(file, kMostBytes));
  return parse_profile(text, file.string());
}

}  // namespace

fs::path stylus_profile_file(const fs::path& folder, const std::string& device) {
  std::string name;
  for (const char c : device)
    name += is_plain(c) ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  return folder / (name + ".toml");
}

Status save_stylus_profile(const StylusProfile& profile, const fs::path& folder) {
  const fs::path file = stylus_profile_file(folder, profile.device);
  const std::string text = to_toml(profile);
  TROCAR_TRY_STATUS(parse_profile(text, file.string()));
  return write_file_atomically(file, text);
}

Result<bool> remove_stylus_profile(const fs::path& folder, const std::string& device) {
  const fs::path file = stylus_profile_file(folder, device);
  std::error_code error;
  const bool was_there = fs::remove(file, error);
  if (error)
    return fail("the saved weight cannot be deleted: " + error.message(), file.string(),
                "check the permissions of its folder");
  return was_there;
}

Result<std::optional<StylusProfile>> load_stylus_profile(const fs::path& folder, const std::string& device) {
  const fs::path file = stylus_profile_file(folder, device);
  std::error_code error;
  if (!fs::exists(file, error) && !error) return std::nullopt;
  auto profile = read_profile(file);
  if (!profile) {
    Error broken = std::move(profile).error();
    broken.advice = kWeighAgain;
    return tl::unexpected(std::move(broken));
  }
  if (profile->device != device)
    return fail(fmt::format("the saved weight belongs to the device \"{}\"", profile->device), file.string(),
                kWeighAgain);
  return *std::move(profile);
}

Result<stylus::DevicePreset> with_stylus_profile(stylus::DevicePreset preset, const fs::path& folder,
                                                 const std::string& device) {
  if (folder.empty()) return preset;
  TROCAR_TRY(const std::optional<StylusProfile> profile, load_stylus_profile(folder, device));
  if (!profile) return preset;
  const std::string file = stylus_profile_file(folder, device).string();
  if (profile->preset != preset.name)
    return fail(fmt::format("the saved weight was measured with the preset \"{}\", and the device has \"{}\"",
                            profile->preset, preset.name),
                file, kWeighAgain);
  const double most_n = stylus::continuous_force_n(preset);
  if (profile->weight_n > most_n)
    return fail(
        fmt::format("stylus_weight_n is {}, and the device can hold {:.2f} N for long", profile->weight_n, most_n),
        file, kWeighAgain);
  preset.capability.stylus_weight_n = profile->weight_n;
  if (profile->lever_mm) preset.capability.stylus_lever_mm = *profile->lever_mm;
  return preset;
}

}  // namespace trocar::devices
