#include "devices/vendor/detail/haply_messages.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "devices/detail/factories.h"

namespace trocar::devices {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kMostIdBytes = 64;
constexpr std::size_t kMostDevices = 16;
constexpr double kQuaternionSlack = 0.1;  // tolerance of the unit length

const Json* member(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto it = object.find(key);
  return it == object.end() ? nullptr : &*it;
}

std::optional<double> number(const Json& object, const char* key) {
  const Json* value = member(object, key);
  if (value == nullptr || !value->is_number()) return std::nullopt;
  return value->get<double>();
}

std::optional<Vec3> vector_of(const Json& object) {
  const auto x = number(object, "x");
  const auto y = number(object, "y");
  const auto z = number(object, "z");
  if (!x || !y || !z) return std::nullopt;
  return Vec3(*x, *y, *z);
}

std::optional<Eigen::Quaterniond> quaternion_of(const Json& object) {
  const auto w = number(object, "w");
  const auto xyz = vector_of(object);
  if (!w || !xyz) return std::nullopt;
  const Eigen::Quaterniond q(*w, xyz->x(), xyz->y(), xyz->z());
  if (!(std::abs(q.norm() - 1.0) < kQuaternionSlack)) return std::nullopt;
  return q.normalized();
}

/// A missing flag counts as no error: older services send fewer flags.
bool is_denied(const Json* status, const char* key) {
  const Json* flag = status == nullptr ? nullptr : member(*status, key);
  return flag != nullptr && (!flag->is_boolean() || !flag->get<bool>());
}

HaplyCondition condition_of(const Json* status) {
  if (is_denied(status, "power_supply")) return HaplyCondition::kNoPower;
  if (is_denied(status, "calibrated")) return HaplyCondition::kNotCalibrated;
  if (is_denied(status, "ready")) return HaplyCondition::kNotReady;
  return HaplyCondition::kReady;
}

const std::string* id_of(const Json& device) {
  const Json* id = member(device, "device_id");
  const std::string* text = id == nullptr ? nullptr : id->get_ptr<const std::string*>();
  return text != nullptr && !text->empty() && text->size() <= kMostIdBytes ? text : nullptr;
}

/// The selected entry in an array of devices.
const Json* find_device(const Json& devices, std::string_view wanted_id) {
  std::size_t count = 0;
  for (const Json& device : devices) {
    if (++count > kMostDevices) break;
    const std::string* id = id_of(device);
    if (id != nullptr && (wanted_id.empty() || *id == wanted_id)) return &device;
  }
  return nullptr;
}

std::uint32_t buttons_of(const Json* buttons) {
  // Wireless grips name their buttons a, b, c; wired grips and older services use other names.
  constexpr std::array kNames{std::array{"a", "button_0", "button"}, std::array{"b", "button_1", "button_1"},
                              std::array{"c", "button_2", "button_2"}};
  std::uint32_t bits = 0;
  for (std::size_t i = 0; buttons != nullptr && i < kNames.size(); ++i) {
    for (const char* name : kNames[i]) {
      const Json* pressed = member(*buttons, name);
      if (pressed != nullptr && pressed->is_boolean() && pressed->get<bool>()) bits |= 1U << i;
    }
  }
  return bits;
}

/// Orientation and buttons of the first grip; false: its data are not valid.
bool read_grip(const Json& document, HaplyState& state) {
  for (const char* kind : {"wireless_verse_grip", "verse_grip", "custom_verse_grip"}) {
    const Json* grips = member(document, kind);
    if (grips == nullptr || !grips->is_array() || grips->empty()) continue;
    const Json* grip = member(grips->front(), "state");
    const Json* orientation = grip == nullptr ? nullptr : member(*grip, "orientation");
    if (orientation == nullptr) return false;
    state.q_grip = quaternion_of(*orientation);
    state.buttons = buttons_of(member(*grip, "buttons"));
    return state.q_grip.has_value();
  }
  return true;
}

bool has_centred_preset(const Json& device) {
  constexpr std::string_view kSuffix = "_centered";
  const Json* config = member(device, "config");
  const Json* preset = config == nullptr ? nullptr : member(*config, "preset");
  const std::string* name = preset == nullptr ? nullptr : preset->get_ptr<const std::string*>();
  return name != nullptr && name->ends_with(kSuffix);
}

HaplyState read_state(const Json& document, std::string_view wanted_id) {
  HaplyState state;
  if (!document.is_object()) return state;
  const Json* devices = member(document, "inverse3");
  if (devices != nullptr && !devices->is_array()) return state;
  const Json* device = devices == nullptr ? nullptr : find_device(*devices, wanted_id);
  if (device == nullptr) {
    state.condition = HaplyCondition::kNoDevice;
    return state;
  }
  state.device_id = *id_of(*device);
  state.is_centred = has_centred_preset(*device);
  const HaplyCondition condition = condition_of(member(*device, "status"));
  if (condition != HaplyCondition::kReady) {
    state.condition = condition;
    return state;
  }
  const Json* cursor = member(*device, "state");
  const Json* position = cursor == nullptr ? nullptr : member(*cursor, "cursor_position");
  const std::optional<Vec3> p_m = position == nullptr ? std::nullopt : vector_of(*position);
  if (!p_m || !(p_m->norm() <= kFarthestHaply_m) || !read_grip(document, state)) return state;
  state.p_m = *p_m;
  state.condition = HaplyCondition::kReady;
  return state;
}

}  // namespace

const char* to_string(HaplyCondition condition) noexcept {
  switch (condition) {
    case HaplyCondition::kReady:
      return "ready";
    case HaplyCondition::kMalformed:
      return "its messages cannot be read";
    case HaplyCondition::kNoDevice:
      return "no Inverse3 is connected";
    case HaplyCondition::kNoPower:
      return "the Inverse3 has no power";
    case HaplyCondition::kNotCalibrated:
      return "the Inverse3 is not calibrated";
    case HaplyCondition::kNotReady:
      return "the Inverse3 is not ready";
  }
  return "unknown";
}

HaplyState parse_haply_state(std::string_view text, std::string_view wanted_id) {
  if (text.size() > kMostHaplyBytes) return {};
  const Json document = Json::parse(text.begin(), text.end(), nullptr, false);
  if (document.is_discarded()) return {};
  return read_state(document, wanted_id);
}

std::string haply_force_command(std::string_view device_id, const Vec3& force_n) {
  const std::string id = Json(device_id).dump(-1, ' ', true, Json::error_handler_t::replace);
  return fmt::format(
      R"({{"inverse3":[{{"device_id":{},"commands":{{"set_cursor_force":{{"values":{{"x":{:.6f},"y":{:.6f},"z":{:.6f}}}}}}}}}]}})",
      id, force_n.x(), force_n.y(), force_n.z());
}

Pose haply_pose(const HaplyState& state, bool is_centred) noexcept {
  const Vec3 p_DS = kMmPerM * (is_centred ? state.p_m : Vec3(state.p_m - kHaplyCentre_m));
  if (!state.q_grip) return Pose::translation(p_DS);
  Mat3 R_GS;  // G: the vendor's axes of the grip
  R_GS << 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0;
  return {state.q_grip->toRotationMatrix() * R_GS, p_DS};
}

Vec3 haply_force(const Vec3& f_D) noexcept {
  return f_D;
}

}  // namespace trocar::devices
