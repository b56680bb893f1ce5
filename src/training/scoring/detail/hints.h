#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scoring/detail/judgement.h"

namespace trocar::scoring {

/// Advice for improvement in the words of an instructor, the costliest first, with the moment to look at; praise if
/// there is nothing to improve. No advice contradicts another: what was too deep is not also to be pulled back less.
std::vector<Hint> make_hints(const Judgement& judged, std::span<const ScorePart> parts);

/// Advice, and the points that following it would bring.
struct Advice {
  double lost_points = 0.0;
  std::string text;
  std::optional<double> at_s = {};
};

inline constexpr double kFaultPoints = 1000.0;  ///< Of advice about a fault that fails the attempt: it comes first.
inline constexpr double kNameable = 0.5;        ///< Rounds to 1 mm or degree.
inline constexpr double kElsewhere_mm = 40.0;   ///< A needle farther off has to begin anew: corrections make no sense.

/// What advice is made of.
struct HintSubject {
  const Judgement& judged;
  std::span<const ScorePart> parts;
  double matters = 0.1;  ///< Least lost share of a part's points that is worth advice.

  const tasks::Task& task() const noexcept { return judged.attempt.task; }
  const tasks::Needle& needle() const noexcept { return judged.attempt.needle; }
  const metrics::AttemptMetrics& measured() const noexcept { return judged.measured; }
  bool has_stylet() const noexcept { return needle().stylet_diameter_mm > 0.0 && !needle().is_biopsy; }
  const ScorePart* find_part(std::string_view name) const noexcept;
  /// Points lost in a part; 0 if they are not worth advice.
  double lost(std::string_view name) const noexcept;
  /// Name of the target for people: "lesion", "dural sac", "liver tissue".
  std::string target_name() const;
  /// The bone that stopped a stylet; empty: none did.
  std::string bone_of_stylet() const;
};

/// What the trainee finds a place by: "find it in the image", "by the landmarks".
const char* found_by(tasks::ImagingModality guidance) noexcept;
/// "the heart" -> "The heart".
std::string as_sentence(std::string text);

void add_harm_advice(const HintSubject& subject, std::vector<Advice>& advice);
void add_target_advice(const HintSubject& subject, std::vector<Advice>& advice);
void add_confirmation_advice(const HintSubject& subject, std::vector<Advice>& advice);
void add_way_advice(const HintSubject& subject, std::vector<Advice>& advice);
void add_comfort_advice(const HintSubject& subject, std::vector<Advice>& advice);
void add_economy_advice(const HintSubject& subject, std::vector<Advice>& advice);

}  // namespace trocar::scoring
