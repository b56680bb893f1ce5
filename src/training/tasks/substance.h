#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "anatomy/patient.h"
#include "core/result.h"
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

}  // namespace trocar::tasks
