#include "scoring/detail/hints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "anatomy/structure_words.h"
#include "core/text.h"

namespace trocar::scoring {
namespace {

constexpr double kUsually = 0.1;      // least lost share of a part's points for a hint
constexpr double kWorthSaying = 0.5;  // points: a smaller loss rounds to none

std::vector<Advice> all_advice(const HintSubject& subject) {
  std::vector<Advice> advice;
  add_harm_advice(subject, advice);
  add_target_advice(subject, advice);
  add_confirmation_advice(subject, advice);
  add_way_advice(subject, advice);
  add_comfort_advice(subject, advice);
  add_economy_advice(subject, advice);
  std::stable_sort(advice.begin(), advice.end(),
                   [](const Advice& a, const Advice& b) { return a.lost_points > b.lost_points; });
  return advice;
}

std::string praise(const HintSubject& subject) {
  const Judgement& judged = subject.judged;
  double target_mm = 0.0;
  for (const BiopsyCore& core : judged.cores) target_mm += core.target_mm;
  std::string done = judged.target_mm < kNameable
                         ? fmt::format("the tip was in the {}", subject.target_name())
                         : fmt::format("the tip came within {:.1f} mm of the target", judged.target_mm);
  if (!judged.cores.empty())
    done = fmt::format("{:.0f} mm of {} in {}", target_mm, subject.target_name(),
                       judged.cores.size() == 1 ? "the core" : "the cores");
  return fmt::format("Well done: {}, and nothing was harmed.", done);
}

double points_lost(std::span<const ScorePart> parts) noexcept {
  double lost = 0.0;
  for (const ScorePart& part : parts) lost += part.max_points - part.points;
  return lost;
}

}  // namespace

const ScorePart* HintSubject::find_part(std::string_view name) const noexcept {
  const auto found = std::find_if(parts.begin(), parts.end(), [&](const ScorePart& part) { return part.name == name; });
  return found != parts.end() ? &*found : nullptr;
}

double HintSubject::lost(std::string_view name) const noexcept {
  const ScorePart* const part = find_part(name);
  if (part == nullptr || !part->is_judged) return 0.0;
  const double points = part->max_points - part->points;
  return points > 0.0 && points >= matters * part->max_points ? points : 0.0;
}

std::string HintSubject::target_name() const {
  if (task().target_tissues.empty() || judged.is_parenchymal) return anatomy::structure_words(task().organ) + " tissue";
  if (task().target_tissues.front() == "csf") return "dural sac";
  return needle().is_biopsy ? "lesion" : anatomy::structure_words(task().target_tissues.front());
}

std::string HintSubject::bone_of_stylet() const {
  for (const metrics::HarmEvent& event : judged.harms) {
    const anatomy::Label* const label = judged.attempt.patient.label_table.find(event.label);
    if (event.is_by_stylet && label != nullptr && label->tissue == "bone") return event.label;
  }
  return {};
}

const char* found_by(tasks::ImagingModality guidance) noexcept {
  switch (guidance) {
    case tasks::ImagingModality::kUltrasound:
      return "in the ultrasound image";
    case tasks::ImagingModality::kXray:
      return "in the X-ray image";
    case tasks::ImagingModality::kPalpation:
      return "by the landmarks";
  }
  return "";
}

std::string as_sentence(std::string text) {
  if (!text.empty()) text.front() = ascii::to_upper(text.front());
  return text;
}

std::vector<Hint> make_hints(const Judgement& judged, std::span<const ScorePart> parts) {
  std::vector<Advice> advice;
  const HintSubject subject{judged, parts, kUsually};
  if (!judged.measured.has_touched_skin) {
    advice.push_back({0.0, judged.attempt.shots.empty()
                               ? "The needle never reached the skin: bring its tip to the planned insertion point."
                               : "The gun was fired into the air: bring the tip to the planned insertion point, insert "
                                 "the needle to the target, then fire."});
  } else if (!judged.measured.has_entered) {
    add_harm_advice(subject, advice);  // of a shot through the skin
    advice.push_back({0.0, "The skin was not pierced: push steadily along the planned direction until it gives way."});
  } else {
    advice = all_advice(subject);
    if (advice.empty() && points_lost(parts) > kWorthSaying) {
      advice = all_advice({judged, parts, 0.0});
      if (advice.size() > 1) advice.resize(1);
    }
    if (advice.empty()) advice.push_back({0.0, praise(subject)});
  }
  std::vector<Hint> hints;
  for (Advice& one : advice) hints.push_back({std::move(one.text), one.at_s});
  return hints;
}

}  // namespace trocar::scoring
