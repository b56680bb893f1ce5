#include "motion/breathing_choice.h"

#include <fmt/format.h>

#include <array>
#include <optional>

#include "core/random.h"
#include "core/text.h"

namespace trocar::motion {
namespace {

constexpr double kDeepest_mm = 40.0;
constexpr const char* kExample = "give none, quiet, deep or the liver's motion in mm, then for example ,rate=18,seed=3";

struct Field {
  std::string_view name;
  double low, high;
  double BreathingChoice::*member;
};
constexpr std::array<Field, 4> kFields{{{"rate", 4.0, 40.0, &BreathingChoice::breaths_per_min},
                                        {"irregularity", 0.0, 0.4, &BreathingChoice::irregularity},
                                        {"cough", 5.0, 3600.0, &BreathingChoice::cough_every_s},
                                        {"hold-limit", 0.0, 120.0, &BreathingChoice::hold_limit_s}}};

Result<double> number_within(std::string_view text, double low, double high, std::string_view what) {
  const auto number = parse_number<double>(text);
  if (number && *number >= low && *number <= high) return *number;
  return fail_usage(fmt::format("{} needs a number from {} to {}", what, low, high), std::string(text), kExample);
}

Status read_part(std::string_view part, BreathingChoice& choice) {
  const std::size_t sign = part.find('=');
  const std::string_view name = part.substr(0, sign), value = sign < part.size() ? part.substr(sign + 1) : "";
  if (name == "seed") {
    const auto seed = parse_number<std::uint32_t>(value);
    if (!seed) return fail_usage("seed needs a whole number from 0 to 4294967295", std::string(value), kExample);
    choice.seed = *seed;
    return {};
  }
  for (const Field& field : kFields) {
    if (field.name != name) continue;
    TROCAR_TRY(choice.*field.member, number_within(value, field.low, field.high, name));
    return {};
  }
  return fail_usage("breathing has no such part", std::string(part), kExample);
}

}  // namespace

Result<BreathingChoice> parse_breathing(std::string_view text) {
  BreathingChoice choice;
  std::size_t comma = text.find(',');
  const std::string_view depth = text.substr(0, comma);
  if (depth == "none")
    choice.liver_mm = 0.0;
  else if (depth == "quiet")
    choice.liver_mm = kQuietLiver_mm;
  else if (depth == "deep")
    choice.liver_mm = kDeepLiver_mm;
  else {
    TROCAR_TRY(choice.liver_mm, number_within(depth, 0.0, kDeepest_mm, "the depth of breathing"));
  }
  while (comma != std::string_view::npos) {
    text.remove_prefix(comma + 1);
    comma = text.find(',');
    TROCAR_TRY_STATUS(read_part(text.substr(0, comma), choice));
  }
  return choice;
}

std::string to_text(const BreathingChoice& choice) {
  std::string text = fmt::format("{}", choice.liver_mm);
  const BreathingChoice usual;
  for (const Field& field : kFields)
    if (choice.*field.member != usual.*field.member) text += fmt::format(",{}={}", field.name, choice.*field.member);
  if (choice.seed) text += fmt::format(",seed={}", *choice.seed);
  return text;
}

Result<MotionDrive> drive_of(const BreathingChoice& choice, const MotionModel& model, double begins_s) {
  constexpr std::uint64_t kOfDrift = 0x64726966;
  const double depth = choice.liver_mm / model.parts().liver_mm;
  const double deepest_mm = kMostDrive / (1.0 + choice.irregularity) * model.parts().liver_mm;
  if (choice.liver_mm > deepest_mm)
    return fail_usage(
        fmt::format("the liver of this patient can be moved by {:.1f} mm, not {:.1f}", deepest_mm, choice.liver_mm),
        "breathing", "choose a shallower or a more regular breath");
  MotionDrive drive;
  drive.period_s = 60.0 / choice.breaths_per_min;
  drive.begins_s = begins_s;
  for (std::size_t d = 0; d < model.parts().drivers.size(); ++d) drive.depth[d] = depth;
  drive.irregularity = choice.irregularity;
  drive.cough_every_s = choice.cough_every_s;
  drive.hold_limit_s = choice.hold_limit_s;
  drive.seed = choice.seed.value_or(drive.seed);
  if (choice.liver_mm > 0.0)
    drive.drift_per_s = -uniform01(drive.seed, kOfDrift) * kMostDrift_mm_per_s / model.parts().liver_mm;
  return drive;
}

}  // namespace trocar::motion
