// Advice for 10,000 attempts that are made of measurements: whatever was measured, what is said has to make sense.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <regex>

#include "scoring/detail/judgement.h"
#include "scoring/test/outcome_support.h"
#include "tasks/testing/shipped_task.h"

namespace trocar::scoring {
namespace {

/// A task of the data folder with its needle.
struct Subject {
  tasks::Task task;
  tasks::Needle needle;
};
std::vector<Subject> shipped() {
  std::vector<Subject> all;
  const auto tasks = tasks::load_tasks(testing::tasks_folder());
  EXPECT_TRUE(tasks);
  for (const tasks::Task& task : *tasks) all.push_back({task, testing::shipped_needle(task.needle)});
  return all;
}

/// Draws the measurements of an attempt in the box patient.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : random_(seed) {}

  bool chance(double share) { return std::bernoulli_distribution(share)(random_); }
  double number(double from, double to) { return std::uniform_real_distribution(from, to)(random_); }
  std::size_t index(std::size_t count) { return std::uniform_int_distribution<std::size_t>(0, count - 1)(random_); }
  Vec3 vector(double spread) {
    std::normal_distribution<double> one(0.0, spread);
    return {one(random_), one(random_), one(random_)};
  }

 private:
  std::mt19937_64 random_;
};

class DrawnAttempt {
 public:
  DrawnAttempt(const Subject& subject, std::uint64_t seed) : subject_(subject), draw_(seed) {
    draw_actions();
    for (std::size_t n = draw_.chance(0.2) ? 0 : 1 + draw_.index(4); n > 0 && subject.needle.is_biopsy; --n)
      shots_.push_back(0);
    attempt_.xray.dose_area_gycm2 = draw_.number(0.0, 12.0);
    attempt_.has_transducer = subject.task.guidance == tasks::ImagingModality::kUltrasound;
    if (attempt_.has_transducer && draw_.chance(0.9)) attempt_.tip_visible_share = draw_.number(0.0, 1.0);
    attempt_.shots = shots_;
    attempt_.actions = actions_;
    judged_.is_parenchymal = judged_.is_planned_place = subject.needle.is_biopsy && draw_.chance(0.3);
    draw_measures();
    draw_place();
    draw_harms();
    if (draw_.chance(0.3)) judged_.pain.push_back({1.0, 0.0, ""});
    if (draw_.chance(0.3)) judged_.pain.push_back({2.0, 12.0, "rib_right_9"});
    if (subject.task.highest_entry && draw_.chance(0.1)) judged_.too_high_s = 3.0;
    if (subject.task.bevel && draw_.chance(0.7)) judged_.bevel = {draw_.number(0.0, 90.0), 2.0};
    if (subject.task.min_organ_path_mm > 0.0) judged_.bleeding = Bleeding{BleedingRisk::kUsual, {}, draw_.index(5)};
  }

  const Judgement& judged() const { return judged_; }

 private:
  void draw_actions() {
    const bool has_stylet = subject_.needle.stylet_diameter_mm > 0.0;
    if (draw_.chance(0.7)) {
      const Vec3 where_P = make_box_plan_entry() + (draw_.chance(0.3) ? Vec3(0.0, -30.0, 0.0) : Vec3(Vec3::Zero()));
      actions_.push_back({0.1, tasks::ActionKind::kAnaesthetise, draw_.chance(0.2) ? 0.0 : 5.0, {}, where_P, 0.0});
    }
    const tasks::Substance wanted = subject_.task.confirmed_by;
    if (wanted == tasks::Substance::kNothing || draw_.chance(0.3)) return;
    const auto kind = has_stylet ? tasks::ActionKind::kDrawStylet : tasks::ActionKind::kAspirate;
    const bool is_right = draw_.chance(0.5);
    const auto other = draw_.chance(0.5) ? tasks::Substance::kBlood : tasks::Substance::kNothing;
    actions_.push_back({5.0, kind, 0.0, {is_right ? wanted : other, draw_.number(0.1, 1.0)}, {}, 40.0});
    if (is_right) judged_.confirmed_s = 5.0;
  }
  static Vec3 make_box_plan_entry() { return testing::make_box_plan().line_P.a; }

  void draw_measures() {
    metrics::AttemptMetrics& m = judged_.measured;
    m.has_touched_skin = !draw_.chance(0.03);
    m.has_entered = m.has_touched_skin && !draw_.chance(0.05);
    m.entries = 1 + static_cast<int>(draw_.index(3));
    m.entry_offset_P = draw_.vector(draw_.chance(0.5) ? 1.0 : 20.0);
    m.entry_offset_P.y() = 0.0;
    m.axis_P = (expert_.line_P.direction() + draw_.vector(draw_.chance(0.5) ? 0.02 : 0.3)).normalized();
    m.angle_deg = kDegPerRad * angle_between_rad(m.axis_P, expert_.line_P.direction());
    m.target_offset_P = draw_.vector(draw_.chance(0.5) ? 1.0 : 25.0);
    m.tip_P = m.pierced_tip_P = expert_.line_P.b + m.target_offset_P;
    m.deepest_mm = std::max(1.0, m.tip_P.y());
    m.travel_mm = m.deepest_mm * draw_.number(1.0, 3.0);
    m.end_s = 5.0;
    m.time_s = draw_.number(1.0, 400.0);
    judged_.entry_mm = m.entry_offset_P.norm();
    if (draw_.chance(0.5)) judged_.access.missing_margin_mm = draw_.number(0.0, 5.0);
    judged_.access.margin_label = "portal_vein";
    judged_.access.margin_mm = 5.0;
    if (subject_.task.entry_zone && draw_.chance(0.5)) {
      judged_.access.outside_zone_mm = judged_.entry_mm;
      judged_.access.to_zone_P = -m.entry_offset_P;
    }
    if (subject_.task.target_away_mm > 0.0 && draw_.chance(0.3))
      judged_.access.missing_away_mm = draw_.number(0.0, 20.0);
    if (draw_.chance(0.3)) judged_.access.excess_angle_deg = draw_.number(0.0, 30.0);
    if (draw_.chance(0.3)) judged_.access.missing_organ_mm = draw_.number(0.0, 10.0);
  }

  /// The target is a ball of 10 mm, as in the box patient.
  void draw_place() {
    judged_.possible_core_mm = subject_.needle.notch_mm;
    const auto to_ball = [](const Vec3& p_P) {
      const Vec3 way_P = Vec3(50.0, 60.0, 50.0) - p_P;
      return Vec3(way_P * std::max(0.0, 1.0 - 10.0 / std::max(way_P.norm(), 1e-6)));
    };
    if (subject_.needle.is_biopsy && judged_.measured.has_entered)
      for (std::size_t n = 0; n < shots_.size(); ++n) {
        const Vec3 tip_P = judged_.measured.tip_P + draw_.vector(1.0);
        BiopsyCore core = take_core(subject_.task, patient(), subject_.needle, tip_P, judged_.measured.axis_P);
        core.time_s = 5.0 + static_cast<double>(n);
        if (tip_P.y() > 0.0) judged_.cores.push_back(std::move(core));
      }
    const Vec3 reach_P = judged_.measured.tip_P + subject_.needle.notch_middle_mm() * judged_.measured.axis_P;
    judged_.to_target_P = to_ball(reach_P);
    judged_.target_mm =
        judged_.is_planned_place ? judged_.measured.target_offset_P.norm() : judged_.to_target_P->norm();
    if (judged_.confirmed_s) judged_.target_mm = 0.0;
  }

  void draw_harms() {
    const char* const labels[] = {"portal_vein", "rib_right_9", "muscle"};
    for (const char* const label : labels) {
      if (!draw_.chance(0.15)) continue;
      metrics::HarmEvent event;
      event.label = label;
      event.grade = static_cast<tasks::Harm>(1 + draw_.index(3));
      event.is_graze = event.grade == tasks::Harm::kMinor && draw_.chance(0.3);
      event.is_by_stylet = subject_.needle.is_biopsy && !judged_.cores.empty() && draw_.chance(0.3);
      event.has_stayed = !event.is_graze && !event.is_by_stylet && draw_.chance(0.1);
      event.inside_mm = draw_.chance(0.2) ? 0.0 : draw_.number(0.1, 30.0);
      event.reason = draw_.chance(0.5) ? "it bleeds" : "";
      judged_.harms.push_back(event);
    }
    std::stable_sort(judged_.harms.begin(), judged_.harms.end(), metrics::is_graver);
  }

  const Subject& subject_;
  Draw draw_;
  tasks::PlannedPath expert_ = testing::make_box_plan();
  anatomy::TissueTable tissues_ = testing::make_box_tissues();
  std::vector<tasks::Action> actions_;
  std::vector<std::size_t> shots_;
  AttemptData attempt_{.task = subject_.task,
                       .patient = patient(),
                       .tissues = tissues_,
                       .needle = subject_.needle,
                       .experts = {&expert_, 1},
                       .samples = {}};
  Judgement judged_{attempt_, expert_, {}};
};

bool says(const std::string& text, const char* words) {
  return text.find(words) != std::string::npos;
}

/// What is wrong with one piece of advice; empty: nothing.
std::string fault_of(const std::string& text, const Subject& subject, const Judgement& judged) {
  static const std::regex kBroken(
      R"(\s[.,:;]|[,:]\s*[.,:;]|\.\.|\s\s|[{}]|\bnan\b|\binf\b|\b0 mm (short|too|further|further)|\(\))");
  if (text.empty() || text.back() != '.') return "no sentence";
  if (std::regex_search(text, kBroken)) return "broken text";
  const bool has_stylet = subject.needle.stylet_diameter_mm > 0.0 || subject.needle.is_biopsy;
  if (!has_stylet && says(text, "stylet")) return "a needle without a stylet";
  if (!subject.needle.is_biopsy && (says(text, "gun") || says(text, "fire") || says(text, "core "))) return "no gun";
  if (subject.task.guidance == tasks::ImagingModality::kPalpation && (says(text, "image") || says(text, "transducer")))
    return "no image";
  if (subject.task.guidance != tasks::ImagingModality::kUltrasound && says(text, "transducer")) return "no transducer";
  if (subject.task.guidance != tasks::ImagingModality::kXray && says(text, "X-ray")) return "no X-ray";
  if (says(text, "too deep") && says(text, "advance ")) return "deeper and less deep";
  std::smatch match;
  static const std::regex kAdvance(R"(advance (\d+) mm further)");
  if (!says(text, "aim ") && std::regex_search(text, match, kAdvance)) {
    const double ahead_mm = std::stod(match[1]) - 1.0;
    for (double at_mm = 1.0; at_mm < ahead_mm; at_mm += 0.5) {
      const anatomy::Label* const label =
          anatomy::find_label(patient(), judged.measured.tip_P + at_mm * judged.measured.axis_P);
      if (label != nullptr && tasks::find_harm(subject.task, *label).grade > tasks::Harm::kNone)
        return "through the " + label->name;
    }
  }
  return {};
}

/// What contradicts the score; empty: nothing.
std::string contradiction_in(const Outcome& outcome) {
  if (outcome.hints.empty()) return "no advice";
  const bool is_praised = outcome.hints.front().text.starts_with("Well done");
  if (is_praised && (!outcome.is_passed || outcome.score < 99.0 || !outcome.harms.empty())) return "praise";
  if (is_praised && outcome.hints.size() > 1) return "praise and advice";
  if (!outcome.harms.empty() && outcome.harms.front().grade >= tasks::Harm::kMajor && outcome.is_scored() &&
      !says(outcome.hints.front().text, "mm below the skin"))
    return "the harm is not first";
  if (!outcome.is_scored()) return {};
  const auto is_full = [&](const char* name) {
    return std::ranges::none_of(outcome.parts, [&](const ScorePart& part) {
      return part.name == name && part.points < part.max_points - 1e-9;
    });
  };
  const std::pair<const char*, const char*> told[] = {{"The insertion point was", "entry"},
                                                      {"The needle pointed", "angle"},
                                                      {"The tip missed", "target"},
                                                      {"Position not confirmed", "confirmation"},
                                                      {"It took", "time"},
                                                      {"dose-area", "dose"},
                                                      {"The bevel stood", "bevel"},
                                                      {"The skin", "comfort"},
                                                      {"The tip was in the image", "visibility"}};
  for (const Hint& hint : outcome.hints)
    for (const auto& [words, part] : told)
      if (says(hint.text, words) && is_full(part)) return std::string("advice on ") + part;
  return {};
}

TEST(HintsProperty, AdviceIsConsistentForRandomOutcomes) {
  const std::vector<Subject> subjects = shipped();
  ASSERT_EQ(subjects.size(), 4U);
  std::size_t praised = 0, advised = 0;
  for (std::uint64_t seed = 0; seed < 10'000; ++seed) {
    const Subject& subject = subjects[seed % subjects.size()];
    const DrawnAttempt drawn(subject, seed);
    const Outcome outcome = conclude(drawn.judged());
    ASSERT_EQ(contradiction_in(outcome), "") << subject.task.name << " " << seed << ": " << outcome.hints.front().text;
    for (const Hint& hint : outcome.hints)
      ASSERT_EQ(fault_of(hint.text, subject, drawn.judged()), "")
          << subject.task.name << " " << seed << ": " << hint.text;
    (outcome.hints.front().text.starts_with("Well done") ? praised : advised) += 1;
  }
  EXPECT_GT(advised, 9'000U);
}

}  // namespace
}  // namespace trocar::scoring
