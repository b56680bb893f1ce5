#include "devices/device_spec.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "devices/detail/factories.h"
#include "devices/simulated/faulty_device.h"

namespace trocar::devices {
namespace {

enum class Argument : std::uint8_t { kNone, kOptional, kNeeded };

struct DeviceKind {
  std::string_view name;
  Argument argument;
  OpenedDevice (*open)(const DeviceSpec&, const DeviceOptions&);
};

// clang-format off: one kind per line
constexpr std::array kKinds{
    DeviceKind{"virtual", Argument::kOptional, open_virtual},  // :PRESET
    DeviceKind{"mouse", Argument::kNone, open_pointer},
    DeviceKind{"gamepad", Argument::kNone, open_gamepad},
    DeviceKind{"spacemouse", Argument::kNone, open_spacemouse},
    DeviceKind{"replay", Argument::kNeeded, open_replay},              // :FILE
    DeviceKind{"openhaptics", Argument::kOptional, open_openhaptics},  // :NAME
    DeviceKind{"forcedimension", Argument::kNone, open_forcedimension},
    DeviceKind{"haply", Argument::kOptional, open_haply},  // :ws://HOST:PORT
};
// clang-format on

constexpr std::uint64_t kFaultSeed = 1;  ///< Seed of the jitter.

const DeviceKind* find_kind(std::string_view name) noexcept {
  const auto* it =
      std::find_if(kKinds.begin(), kKinds.end(), [&](const DeviceKind& kind) { return kind.name == name; });
  return it == kKinds.end() ? nullptr : it;
}

tl::unexpected<Error> fail_unknown(std::string_view text) {
  std::vector<std::string_view> names;
  for (const DeviceKind& kind : kKinds) names.push_back(kind.name);
  return fail_usage(fmt::format("there is no device kind \"{}\"", text), "device",
                    fmt::format("known are: {}", fmt::join(names, ", ")));
}

}  // namespace

Result<DeviceSpec> parse_device_spec(std::string_view text) {
  const std::size_t colon = text.find(':');
  DeviceSpec spec;
  spec.kind = text.substr(0, colon);
  if (colon != std::string_view::npos) spec.argument = text.substr(colon + 1);
  const DeviceKind* kind = find_kind(spec.kind);
  if (kind == nullptr) return fail_unknown(spec.kind);
  const bool has_colon = colon != std::string_view::npos;
  if (has_colon && kind->argument == Argument::kNone) {
    return fail_usage(fmt::format("device \"{}\" has no argument after the colon", spec.kind), std::string(text),
                      fmt::format("write {}", spec.kind));
  }
  if (spec.argument.empty() && (has_colon || kind->argument == Argument::kNeeded)) {
    return fail_usage(fmt::format("device \"{}\" needs an argument", spec.kind), std::string(text),
                      kind->argument == Argument::kNeeded ? "write it after the colon, as in replay:FILE"
                                                          : "write it after the colon, or leave the colon out");
  }
  return spec;
}

Result<std::unique_ptr<HapticDevice>> open_device(const DeviceSpec& spec, const DeviceOptions& options) {
  const DeviceKind* kind = find_kind(spec.kind);
  if (kind == nullptr) return fail_unknown(spec.kind);
  TROCAR_TRY(std::unique_ptr<HapticDevice> device, kind->open(spec, options));
  if (options.faults.empty()) return device;
  return std::make_unique<FaultyDevice>(std::move(device), options.faults, kFaultSeed);
}

Result<stylus::DevicePreset> load_preset_of(const DeviceOptions& options, std::string_view own) {
  return stylus::load_device_preset(options.devices_file,
                                    options.preset.empty() ? own : std::string_view(options.preset));
}

}  // namespace trocar::devices
