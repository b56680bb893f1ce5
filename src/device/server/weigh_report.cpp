#include "server/weigh_report.h"

#include <fmt/format.h>

#include "core/check.h"

namespace trocar::server {
namespace {

constexpr double kLargeTilt = 0.1;  // horizontal force of the weight: a base tilted by 6 degrees [assumed]
constexpr double kLargePull_n = 0.05;

struct Refusal {
  std::string what, advice;
};

Refusal refusal_of(const WeighResult& result) {
  switch (result.refusal) {
    case WeighRefusal::kNone:
      break;
    case WeighRefusal::kNoForce:
      return {"the device gives no force and cannot weigh its stylus", "weigh on a device with motors"};
    case WeighRefusal::kCarriedByDevice:
      return {"the weight in the device's preset is 0: the device carries its stylus itself",
              "use it without a weighing; an attachment must be balanced by the vendor's settings"};
    case WeighRefusal::kForcesOff:
      return {"the device accepts no forces", "switch its forces on (force button, power), and weigh again"};
    case WeighRefusal::kFault:
      return {fmt::format("a fault ended the forces: {}", telemetry::to_string(result.fault)),
              "check the device with push, then weigh again"};
    case WeighRefusal::kNotAtRest:
      return {"the stylus did not come to rest", "let it go when the device holds it, and keep cables free"};
    case WeighRefusal::kMoved:
      return {"the stylus was moved away", "hold it still until the device holds it, then let go"};
    case WeighRefusal::kHeld:
      return {"the stylus did not follow the device: a hand, its holder or an end stop holds it",
              "let go of it in the middle of the workspace, and weigh again"};
    case WeighRefusal::kUnsteady:
      return {fmt::format("the force was not constant (within {:.2f} N)", result.spread_n),
              "let go of the stylus, keep cables free, and weigh again"};
    case WeighRefusal::kTooHeavy:
      return {fmt::format("the stylus is heavier than the {:.2f} N that the device can hold for long, or held down",
                          result.limit_n),
              "take a lighter attachment, or let go of the stylus"};
    case WeighRefusal::kPullsUp:
      return {fmt::format("the arm pulls upwards with {:.2f} N", -result.weight_n), "lessen its counterweight"};
  }
  TROCAR_CHECK(false);
  return {};
}

}  // namespace

Error weigh_error(const WeighResult& result, const std::string& device) {
  const Refusal refusal = refusal_of(result);
  return {refusal.what, device, refusal.advice};
}

std::string weigh_text(const WeighResult& result, const haptics::DevicePreset& preset) {
  const haptics::DeviceCapability& device = preset.capability;
  std::string text = fmt::format("The stylus weighs {:.2f} N (preset: {:.2f} N); friction {:.2f} N.", result.weight_n,
                                 device.stylus_weight_n, result.friction_n);
  if (result.lever_mm)
    text += fmt::format(" Its centre of mass is {:.0f} mm behind the grip (preset: {:.0f} mm).", *result.lever_mm,
                        device.stylus_lever_mm);
  else if (!preset.has_torque())
    text += " The device has no torque: the lever is not measured.";
  else
    text += " The lever is not measured: hold the stylus level for it.";
  if (result.horizontal_n > kLargePull_n + kLargeTilt * result.weight_n)
    text +=
        fmt::format(" A horizontal force of {:.2f} N shows a tilted base or a cable that pulls.", result.horizontal_n);
  return text;
}

}  // namespace trocar::server
