#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "geometry/vec.h"
#include "tasks/needle.h"

namespace trocar::tasks {

/// What comes out of a needle's hub when its stylet is drawn, or into a syringe.
enum class Substance : std::uint8_t { kNothing, kBlood, kCsf, kAscites, kBile, kUrine, kAir, kBowelContent, kFluid };
inline constexpr Substance kLastSubstance = Substance::kFluid;
/// Name in data files: "nothing", "blood", "csf" …
const char* to_string(Substance substance) noexcept;
/// For people: "spinal fluid", "bile" …
const char* substance_words(Substance substance) noexcept;
std::optional<Substance> find_substance(std::string_view name) noexcept;

/// How a substance comes and what it looks like (data/substances.toml).
struct SubstanceLook {
  std::string flows;      ///< "Clear fluid drips from the hub"
  std::string aspirated;  ///< "Clear fluid fills the syringe"
};

/// Which substance each structure gives (data/substances.toml).
struct SubstanceTable {
  std::map<std::string, Substance, std::less<>> tissues;  ///< By tissue class; flows by itself or into a syringe.
  std::map<std::string, Substance, std::less<>> labels;   ///< By a label's name without side and number; goes first.
  std::map<std::string, Substance, std::less<>>
      aspirated;  ///< By tissue: only a syringe draws it, e.g. blood of organs.
  std::map<Substance, SubstanceLook> looks;

  /// The substance of a label; kNothing: it gives none.
  Substance of(const anatomy::Label& label, bool is_aspirated) const;
};
/// Errors name file, line and key: an unknown substance, a missing look.
Result<SubstanceTable> load_substances(const std::filesystem::path& file);

/// What comes, and how fast.
struct Return {
  Substance substance = Substance::kNothing;
  double share = 0.0;  ///< Part of the bevel's opening that lies in it. Range 0..1.

  /// Less than half of the opening: single drops.
  bool is_slow() const noexcept { return share < 0.5; }
  bool operator==(const Return&) const = default;
};

/// Length of the opening from the tip back over the bevel: outer diameter / tan(bevel angle).
double bevel_opening_mm(const Needle& needle) noexcept;

/// What comes out of a needle whose stylet is out, or into a syringe (`is_aspirated`). Tissue that closes the opening
/// gives nothing. The substance with the largest part of the opening comes. Frame P.
Return what_returns(const SubstanceTable& table, const anatomy::VirtualPatient& patient, const Needle& needle,
                    const Vec3& tip_P, const Vec3& axis_P, bool is_aspirated);

/// What a trainee does besides moving tools.
enum class ActionKind : std::uint8_t {
  kAnaesthetise,   ///< Injects local anaesthetic at the tip; `amount` in ml.
  kDrawStylet,     ///< Draws the stylet; the result is what flows.
  kReplaceStylet,  ///< Puts it back.
  kAspirate,       ///< Pulls at a syringe; the result is what comes.
  kAdvanceWire,    ///< Advances a guide wire through the needle; `amount`: mm beyond the tip.
  kHoldBreath,     ///< Asks the patient to hold the breath; it does so at the end of the breath (motion/breathing.h).
  kBreathe,        ///< Ends it.
  kFire,           ///< Fires the loaded biopsy gun: the core is taken at this moment.
  kLoad,           ///< Takes the core out and loads the gun again: outside the body, or through a coaxial needle.
};
inline constexpr ActionKind kLastAction = ActionKind::kLoad;
/// Name in files: "draw_stylet" …
const char* to_string(ActionKind kind) noexcept;

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

/// State of the fluoroscope at one moment of an attempt, with the contrast agent and the dose up to then. Frame P.
struct XrayUse {
  double time_s = 0.0;  ///< Session time.
  double lao_deg = 0.0, cranial_deg = 0.0;
  Vec3 isocentre_P = Vec3::Zero();
  double field_mm = 0.0;
  bool is_beam_on = false;
  double contrast_ml = 0.0;      ///< Injected.
  double beam_s = 0.0;           ///< Time with the beam on.
  double air_kerma_mgy = 0.0;    ///< At the reference point.
  double dose_area_gycm2 = 0.0;  ///< Air kerma times irradiated area.

  bool operator==(const XrayUse&) const = default;
};

/// Contrast agent that was injected without a pause.
struct ContrastInjection {
  double end_s = 0.0;     ///< Session time.
  double ml = 0.0;        ///< Of this injection.
  double total_ml = 0.0;  ///< Of all up to its end.
};
inline constexpr double kBetweenInjections_s = 0.5;  ///< A longer pause begins another injection. [assumed]
/// `uses`: of an attempt, by time.
std::vector<ContrastInjection> find_injections(std::span<const XrayUse> uses);

/// A time in which the trainee could not act: a haptic server was unavailable, or no tick was answered. Session times;
/// `to_s` is the time of the first tick after it.
struct Interruption {
  double from_s = 0.0;
  double to_s = 0.0;
  std::string reason;  ///< One of the words below.
};
/// Why; after this one the insertion restarts at the needle's pose.
inline constexpr const char* kServerWasAway = "the needle's server was away";
inline constexpr const char* kServerSentNothing = "the needle's server sent no data";
inline constexpr const char* kProgramDidNotRun = "the program did not run";
inline constexpr const char* kSamplesWereLost = "samples were lost";

/// Shorter ones are counted and not listed: a hand does not notice them. [assumed]
inline constexpr double kNoticedInterruption_s = 0.1;

/// Time from `from_s` to `to_s` in which the trainee could act. Interruptions do not overlap.
inline double active_time_s(double from_s, double to_s, std::span<const Interruption> interruptions) noexcept {
  double time_s = std::max(0.0, to_s - from_s);
  for (const Interruption& gap : interruptions)
    time_s -= std::max(0.0, std::min(to_s, gap.to_s) - std::max(from_s, gap.from_s));
  return std::max(0.0, time_s);
}

}  // namespace trocar::tasks
