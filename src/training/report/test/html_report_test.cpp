#include "report/html_report.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "report/test/count_of.h"
#include "report/test/example_attempt.h"

namespace trocar::report {
namespace {

using testing::count_of;
using testing::example_attempt;
using testing::example_patient;

/// The page without the bytes of its pictures, which may spell any word.
std::string without_pictures(std::string html) {
  for (std::size_t at = html.find(";base64,"); at != std::string::npos; at = html.find(";base64,", at + 1))
    html.erase(at + 8, html.find('"', at) - at - 8);
  return html;
}

/// The first element that is not closed in order, empty when all are: a page that breaks this was not escaped or not
/// ended somewhere.
std::string first_unbalanced(const std::string& html) {
  std::vector<std::string> open;
  for (std::size_t at = html.find('<'); at != std::string::npos; at = html.find('<', at + 1)) {
    if (html.compare(at, 9, "<!DOCTYPE") == 0) continue;
    const std::size_t end = html.find('>', at);
    if (end == std::string::npos) return html.substr(at, 40);
    const bool is_close = html[at + 1] == '/';
    const std::size_t from = at + (is_close ? 2 : 1);
    const std::string name = html.substr(from, html.find_first_of(" >/", from) - from);
    if (html[end - 1] == '/' || name == "meta") continue;
    if (!is_close) {
      open.push_back(name);
    } else {
      if (open.empty() || open.back() != name) return html.substr(at, 40);
      open.pop_back();
    }
  }
  return open.empty() ? "" : open.back();
}

TEST(HtmlReport, NamesTheThreePeaks) {
  const storage::Session session = example_attempt();
  const std::string html = html_report(session, nullptr);
  EXPECT_EQ(count_of(html, "class=\"mark\""), 3u);
  EXPECT_EQ(count_of(html, "class=\"marklabel\""), 3u);
  for (const char* label : {">skin 2.80 N<", ">muscle fascia 2.60 N<", ">liver capsule 1.80 N<"})
    EXPECT_NE(html.find(label), std::string::npos) << label;
}

TEST(HtmlReport, ShowsTheLevelBesideTheScore) {
  storage::Session session = example_attempt();
  EXPECT_EQ(html_report(session, nullptr).find("<dt>Level</dt>"), std::string::npos);
  session.info.level = "exam";
  const std::string html = html_report(session, nullptr);
  EXPECT_NE(html.find("<dt>Level</dt><dd>Exam</dd>"), std::string::npos);
  EXPECT_NE(html.find("target reached, level Exam"), std::string::npos);
  EXPECT_EQ(first_unbalanced(html), "");
}

TEST(HtmlReport, ShowsScorePartsHintsAndCore) {
  const std::string html = html_report(example_attempt(), nullptr);
  for (const char* text : {">83</text>", "Distance to the target", "Hold the needle flatter", "Target tissue 11.0 mm",
                           "target reached", "gallbladder", "not a medical device", "2026-01-02 03:04 UTC",
                           "00112233445566778899aabbccddeeff", "liver.friction_mu"})
    EXPECT_NE(html.find(text), std::string::npos) << text;
}

/// The positions of texts in a page, which has all of them.
std::vector<std::size_t> places(const std::string& html, const std::vector<const char*>& texts) {
  std::vector<std::size_t> all;
  for (const char* text : texts) {
    all.push_back(html.find(text));
    EXPECT_NE(all.back(), std::string::npos) << text;
  }
  return all;
}

TEST(HtmlReport, ShowsTheVerdictWithReasonsFirst) {
  storage::Session session = example_attempt();
  session.outcome->is_passed = true;
  session.outcome->hints = {{"Well done: nothing at risk was touched.", {}}};
  places(html_report(session, nullptr), {"<h2>Passed</h2>", "<h2>Advice</h2>", "Well done"});
  session.outcome->hints = {{"Hold the needle flatter.", {}}};
  session.outcome->is_passed = false;
  session.outcome->fails = {"the lung was touched", "the target was missed"};
  session.outcome->hints.push_back({"Advance more slowly.", 4.25});
  const ReportStory story{{{"Find the lesion", 0.0, 2.5}, {"Fire", 2.5, {}}, {"Withdraw", {}, {}}},
                          {{1.5, 12.25, "aspirated: bile"}}};
  const std::string html = html_report(session, nullptr, story);
  const auto at = places(html, {"<h2>Not passed</h2>", "<li>The lung was touched</li>",
                                "<li>The target was missed</li>", "Improve this first", "Hold the needle flatter",
                                "Advance more slowly. <span class=\"when\">at 4.2 s</span>", "<h2>Score</h2>",
                                "<h2>Steps</h2>", "<h2>Actions</h2>", "Force against depth", "The case"});
  EXPECT_TRUE(std::ranges::is_sorted(at));
  places(html, {"<td>1. Find the lesion</td><td>0.0 s</td><td>2.5 s</td><td>2.5 s</td>",
                "<tr class=\"undone\"><td>2. Fire</td><td>2.5 s</td><td>not done</td><td>\u2013</td>",
                "<td>3. Withdraw</td><td>not begun</td><td>not done</td>", "No transducer was recorded",
                "<td>1.5 s</td><td>12.2 mm</td><td>Aspirated: bile</td>"});
  EXPECT_EQ(first_unbalanced(html), "");
}

TEST(HtmlReport, ShowsAnUnscoredAttemptAsNotPassed) {
  storage::Session session = example_attempt();
  session.outcome->not_scored = "the skin was not pierced";
  const std::string html = html_report(session, nullptr);
  places(html, {"<h2>Not passed</h2>", "<li>Not scored, the skin was not pierced</li>"});
  EXPECT_EQ(html.find("of 100"), std::string::npos);
}

TEST(HtmlReport, ShowsNoVerdictForAnOlderSession) {
  const std::string html = html_report(example_attempt(), nullptr);  // neither passed nor a reason against it
  places(html, {"<h2>No verdict</h2>", "older program"});
}

TEST(HtmlReport, ListsTheLongestOfManyInterruptions) {
  storage::Session session = testing::example_attempt();
  for (int n = 0; n < 8; ++n) session.interruptions.push_back({1.0 + n, 1.2 + n + 0.1 * (n % 4), "busy"});
  session.interruptions.push_back({20.0, 20.05, "busy"});
  const std::string html = html_report(session, nullptr);
  EXPECT_EQ(count_of(html, "<th>Interruption</th>"), 5u);
  places(html, {"8, 2.80 s in total; the longest ones follow", "at 3.00 s: 0.40 s, busy", "at 4.00 s: 0.50 s, busy",
                "at 7.00 s: 0.40 s, busy", "at 8.00 s: 0.50 s, busy", "1 interruption shorter than 0.1 s"});
  EXPECT_EQ(html.find("at 1.00 s: 0.20 s"), std::string::npos);
}

TEST(HtmlReport, ShortInterruptionsAreCounted) {
  storage::Session session = example_attempt();
  session.interruptions = {
      {1.0, 1.0, "busy"}, {2.0, 2.04, "busy"}, {3.0, 3.5, "the server was away"}, {4.0, 4.0, "busy"}};
  const std::string html = html_report(session, nullptr);
  places(html, {"3 interruptions shorter than 0.1 s, 0.04 s in total", "at 3.00 s: 0.50 s, the server was away"});
  EXPECT_EQ(count_of(html, "<th>Interruption</th>"), 1u);
}

TEST(HtmlReport, DerivesItsFileNameFromTheSession) {
  EXPECT_EQ(report_file_of("out/a.trocar"), "out/a.report.html");
  EXPECT_EQ(report_file_of("first.session"), "first.report.html");
}

TEST(HtmlReport, NamesDamagedPartsAndDeductions) {
  storage::Session session = example_attempt();
  session.damage = {{"ticks 500 to 999", 500, 500, 500}};
  session.outcome->parts.push_back({"deduction", "Deduction for structures at risk", 25.0, "points", -5.0, 0.0});
  session.outcome->risks_touched = {"rib_right_10"};
  const std::string html = html_report(session, nullptr);
  for (const char* text : {"This session is damaged.", "Missing: ticks 500 to 999", "<b>\u22125</b></td></tr>",
                           "Structures at risk touched: <b>right rib 10</b>"})
    EXPECT_NE(html.find(text), std::string::npos) << text;
  session.outcome.reset();
  const std::string without = html_report(session, nullptr);
  EXPECT_NE(without.find("This session is damaged."), std::string::npos);
  EXPECT_EQ(without.find("This session is incomplete."), std::string::npos);
}

TEST(HtmlReport, IsSelfContained) {
  const anatomy::VirtualPatient patient = example_patient();
  const std::string html = html_report(example_attempt(), &patient);
  EXPECT_EQ(count_of(html, "<script"), 0u);
  EXPECT_EQ(count_of(html, "http"), 0u);
  EXPECT_EQ(count_of(html, "url("), 0u);
  EXPECT_EQ(count_of(html, "href=\""), count_of(html, "href=\"data:image/png;base64,iVBOR"));
  EXPECT_LT(html.size(), 2'000'000u);
}

TEST(HtmlReport, ShowsThePathInThreeSlices) {
  const anatomy::VirtualPatient patient = example_patient();
  const std::string html = html_report(example_attempt(), &patient);
  EXPECT_EQ(count_of(html, "<image "), 3u);
  for (const char* text : {"Axial", "Coronal", "Sagittal", "50 mm", "Window 400/40 HU"})
    EXPECT_NE(html.find(text), std::string::npos) << text;
  EXPECT_EQ(html.find("has changed"), std::string::npos);
}

TEST(HtmlReport, ReportsAChangedPatient) {
  anatomy::VirtualPatient patient = example_patient();
  patient.content_hash = "other";
  EXPECT_NE(html_report(example_attempt(), &patient).find("The patient has changed"), std::string::npos);
}

TEST(HtmlReport, ReportsAMissingPatient) {
  EXPECT_NE(html_report(example_attempt(), nullptr).find("not found"), std::string::npos);
}

TEST(HtmlReport, EscapesUserText) {
  storage::Session session = example_attempt();
  const std::string evil = "<script>alert('x')</script>\"&";
  session.info.patient_name = session.info.task = session.info.operator_name = session.info.device = evil;
  session.info.tissue_table_toml = session.info.needle = session.info.started_utc = session.info.patient_source = evil;
  for (std::string& name : session.info.layer_names) name = evil;
  for (std::string& name : session.info.tissue_names) name = evil;
  session.outcome->hints = {{evil, {}}};
  session.outcome->risks_touched = session.outcome->cores.back().risks_in_throw = {evil};
  for (scoring::CorePiece& piece : session.outcome->cores.back().pieces) piece.label = piece.tissue = evil;
  for (scoring::ScorePart& part : session.outcome->parts) part.title = part.unit = evil;
  session.outcome->fails = {evil};
  const std::string html = html_report(session, nullptr, {{{evil, 1.0, 2.0}}, {{1.0, 2.0, evil}}});
  EXPECT_EQ(html.find("<script"), std::string::npos);
  EXPECT_EQ(first_unbalanced(html), "");
}

TEST(HtmlReport, IsWellFormedWithAnyPartMissing) {
  const anatomy::VirtualPatient patient = example_patient();
  storage::Session whole = example_attempt();
  storage::Session no_outcome = whole;
  no_outcome.outcome.reset();
  no_outcome.shots.clear();
  storage::Session no_events = whole;
  for (telemetry::TickSample& sample : no_events.samples) sample.events = {};
  storage::Session outside = whole;
  for (telemetry::TickSample& sample : outside.samples) sample.phase = telemetry::InsertionPhase::kOutside;
  storage::Session one_tick = whole;
  one_tick.samples.resize(1);
  storage::Session no_ticks = whole;
  no_ticks.samples.clear();
  storage::Session no_plan = whole;
  no_plan.info.plan_P = {};
  storage::Session no_names = whole;
  no_names.info.tissue_names.clear();
  no_names.info.layer_names.clear();
  for (const storage::Session& session :
       {whole, no_outcome, no_events, outside, one_tick, no_ticks, no_plan, no_names, storage::Session{}}) {
    for (const anatomy::VirtualPatient* shown : {static_cast<const anatomy::VirtualPatient*>(nullptr), &patient}) {
      const std::string html = without_pictures(html_report(session, shown));
      EXPECT_EQ(first_unbalanced(html), "");
      EXPECT_EQ(count_of(html, "nan"), 0u);
    }
  }
}

TEST(HtmlReport, ReportsAnIncompleteSessionAndStillPlots) {
  storage::Session session = example_attempt();
  session.outcome.reset();
  session.shots.clear();
  const std::string html = html_report(session, nullptr);
  EXPECT_NE(html.find("This session is incomplete"), std::string::npos);
  EXPECT_EQ(count_of(html, "class=\"mark\""), 3u);
  EXPECT_EQ(count_of(html, "<svg class=\"plot\""), 5u);
}

TEST(HtmlReport, OmitsNonFiniteNumbersFromPlots) {
  storage::Session session = example_attempt();
  for (std::size_t i = 0; i < session.samples.size(); i += 3) {
    session.samples[i].f_friction_n = std::numeric_limits<double>::quiet_NaN();
    session.samples[i].device_f_n.x() = std::numeric_limits<double>::infinity();
    session.samples[i].tip_mm.x() = session.samples[i].rest_tip_mm.x() = std::numeric_limits<double>::quiet_NaN();
  }
  session.outcome->score = std::numeric_limits<double>::quiet_NaN();
  session.outcome->parts[0].points = std::numeric_limits<double>::quiet_NaN();
  const anatomy::VirtualPatient patient = example_patient();
  const std::string html = without_pictures(html_report(session, &patient));
  EXPECT_EQ(count_of(html, "nan"), 0u);
  EXPECT_EQ(count_of(html, "inf "), 0u);
  EXPECT_EQ(first_unbalanced(html), "");
}

TEST(HtmlReport, StaysSmallForALongSession) {
  storage::Session session = example_attempt();
  const auto one = session.samples;
  for (int n = 1; n < 30; ++n) {
    for (telemetry::TickSample sample : one) {
      sample.time_s += 8.0 * n;
      session.samples.push_back(sample);
    }
  }
  EXPECT_LT(html_report(session, nullptr).size(), 1'500'000u);
}

}  // namespace
}  // namespace trocar::report
