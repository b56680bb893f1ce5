#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "geometry/vec.h"
#include "tasks/substance.h"

namespace trocar::tasks {

/// What a trainee does besides moving tools.
enum class ActionKind : std::uint8_t {
  kAnaesthetise,   ///< Injects local anaesthetic at the tip; `amount` in ml.
  kDrawStylet,     ///< Draws the stylet; the result is what flows.
  kReplaceStylet,  ///< Puts it back.
  kAspirate,       ///< Pulls at a syringe; the result is what comes.
  kAdvanceWire,    ///< Advances a guide wire through the needle; `amount`: mm beyond the tip.
  kHoldBreath,     ///< Asks the patient to hold the breath. Acts once patients breathe.
  kBreathe,        ///< Ends it.
  kFire,           ///< Fires the loaded biopsy gun: the core is taken at this moment.
  kLoad,           ///< Takes the core out and loads the gun again: outside the body, or through a coaxial needle.
};
inline constexpr ActionKind kLastAction = ActionKind::kLoad;
/// Name in files: "draw_stylet" …
const char* to_string(ActionKind kind) noexcept;
std::optional<ActionKind> find_action(std::string_view name) noexcept;

/// An action that a trainee or an operator asks for.
struct ActionRequest {
  ActionKind kind = ActionKind::kAspirate;
  double amount = 0.0;  ///< See ActionKind.
};

/// An action during an attempt.
struct Action {
  double time_s = 0.0;  ///< Session time.
  ActionKind kind = ActionKind::kAspirate;
  double amount = 0.0;
  Return result;              ///< kDrawStylet and kAspirate only.
  Vec3 tip_A = Vec3::Zero();  ///< Needle's tip at that time, in the anatomy at rest.
  double depth_mm = 0.0;      ///< Of the tip below the skin.

  bool operator==(const Action& other) const noexcept = default;
};

/// The last advance of the guide wire up to a time, whose amount is its length; nullptr: there is no wire in the
/// needle.
const Action* find_wire(std::span<const Action> actions, double time_s) noexcept;
/// What came at the last look: stylet removed or syringe pulled; empty: nobody looked.
std::optional<Return> last_return(std::span<const Action> actions) noexcept;
/// A biopsy gun is loaded at first, and again after kLoad.
bool is_gun_loaded(std::span<const Action> actions) noexcept;

}  // namespace trocar::tasks
