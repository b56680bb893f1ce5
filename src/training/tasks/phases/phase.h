#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "config/toml.h"
#include "config/toml_writer.h"
#include "core/result.h"

namespace trocar::tasks {

/// What can be asked of one moment of an attempt. The argument is a number, a name, or none.
enum class ConditionKind : std::uint8_t {
  kProbeOnSkin,     ///< The transducer touches the skin.
  kTargetInImage,   ///< Number: the target is in the fan, at most so far from the image plane, mm; nothing hides it.
  kNeedleInPlane,   ///< Number: angle of needle and image plane, degrees, with the tip at most 4 mm from the plane.
  kTipInImage,      ///< Number: the tip is in the fan, at most so far from the plane, mm.
  kTipOnSkin,       ///< The tip touches the skin or is in it.
  kAimsAtTarget,    ///< Number: angle between the needle and the line from its tip to the target, degrees.
  kPathClear,       ///< Number: the line on to the target stays so far from structures at risk, mm.
  kInserted,        ///< Number: depth of the tip, mm.
  kTargetDistance,  ///< Number: distance of the tip from where it has to be, mm.
  kTipIn,           ///< Name: tissue class or label that the tip is in, its wall pierced.
  /// Name: tissue class or label that the tip has been in since it came into the body, or one of several ("a|b").
  kPassed,
  kStyletDrawn,    ///< The stylet is out.
  kReturned,       ///< Name: a substance has come back in this phase.
  kAnaesthetised,  ///< Local anaesthetic was injected at the skin or below it.
  kBreathHeld,     ///< The patient holds the breath.
  kContrast,       ///< Number: contrast agent injected, ml, with the tip in the target.
  kWire,           ///< Number: guide wire advanced beyond the tip, mm.
  kThrowClear,     ///< The stylet's way when fired has no structure at risk.
  kFired,          ///< The gun was fired, and a core was taken.
  kCores,          ///< Number: so many cores were taken.
  kOutside,        ///< The needle has left the body again.
  kBevelToFibres,  ///< Number: angle between the bevel and the fibres that it has to part (BevelRule), degrees.
  kMoved,  ///< Number: distance of the tip from where it was when the attempt began, or the phase was repeated, mm.
};
inline constexpr ConditionKind kLastCondition = ConditionKind::kMoved;

struct Condition {
  ConditionKind kind = ConditionKind::kTipOnSkin;
  double number = 0.0;
  std::string name;

  bool operator==(const Condition&) const = default;
};
/// Key in a task file: "target_in_image_mm" …
const char* condition_key(ConditionKind kind) noexcept;
/// What a trainee has to do for it: "bring the target into the image".
std::string condition_words(const Condition& condition);

/// A step of a procedure.
struct Phase {
  std::string name;                ///< "find"
  std::string title;               ///< "Find the lesion with the transducer"
  std::string why;                 ///< The reason for it, one or two sentences.
  std::vector<std::string> after;  ///< Names of phases that come before.
  std::vector<Condition> done;     ///< All hold at the same time …
  double hold_s = 0.0;             ///< … for so long. Range 0..60.

  bool operator==(const Phase&) const = default;
};

/// Reads [[phases]] of a task file, in the file's order. Errors: unknown or missing key, a number out of range, an
/// unknown substance.
Result<std::vector<Phase>> read_phases(const config::TomlTable& document);
void write_phases(config::TomlWriter& writer, const std::vector<Phase>& phases);
/// Errors: two phases of one name, an unknown one in `after`, phases that wait for each other.
Status check_phases(const std::vector<Phase>& phases, const std::string& where);

}  // namespace trocar::tasks
