#include <gtest/gtest.h>

#include <functional>
#include <set>

#include "case_builder/case_draft.h"
#include "case_builder/case_edits.h"
#include "case_builder/test/made_draft.h"
#include "core/random.h"

namespace trocar::case_builder {
namespace {

using testing::made_draft;

using Edit = std::function<Result<CaseDraft>(const CaseDraft&, double)>;

/// One of each; `chance` is in 0..1.
std::vector<Edit> all_edits() {
  const auto point = [](double chance) { return Vec3(-60.0 + 40.0 * chance, 20.0 * chance, 10.0 * chance); };
  return {
      [](const CaseDraft& d, double c) { return rename_label(d, 3, c < 0.5 ? "my liver" : "liver"); },
      [](const CaseDraft& d, double c) { return set_label_tissue(d, 9, c < 0.5 ? "fluid" : "muscle"); },
      [](const CaseDraft& d, double c) {
        return set_label_color(d, 3, {static_cast<std::uint8_t>(200.0 * c), 10, 20});
      },
      [=](const CaseDraft& d, double c) { return set_target_point(d, point(c)); },
      [](const CaseDraft& d, double c) { return set_target_label(d, c < 0.5 ? "lesion" : ""); },
      [](const CaseDraft& d, double c) {
        return set_risk(d, {"vessel", "", 10.0 * c, false, {}});
      },
      [](const CaseDraft& d, double c) {
        return set_risk(d, {"", "gallbladder", 10.0 * c, false, {}});
      },
      [](const CaseDraft& d, double c) {
        return remove_risk(d, static_cast<std::size_t>(c * static_cast<double>(d.task.risks.size())));
      },
      [](const CaseDraft& d, double c) {
        return set_entry_zone(d, {-95.0, 20.0 * c, 0.0}, 5.0 + 20.0 * c);
      },
      [](const CaseDraft& d, double) { return Result<CaseDraft>(clear_entry_zone(d)); },
      [=](const CaseDraft& d, double c) {
        return set_expert_path(d, {{-100.0, 0.0, 0.0}, point(c)});
      },
      [](const CaseDraft& d, double) { return Result<CaseDraft>(clear_expert_path(d)); },
      [=](const CaseDraft& d, double c) { return set_landmark(d, c < 0.5 ? "rib 9" : "xiphoid process", point(c)); },
      [](const CaseDraft& d, double c) { return rename_landmark(d, 0, c < 0.5 ? "tenth rib" : "rib 9"); },
      [](const CaseDraft& d, double) { return remove_landmark(d, 0); },
  };
}

TEST(CaseHistory, UndoAndRedoRestoreAnyEditSequence) {
  const CaseDraft first = made_draft();
  const std::vector<Edit> edits = all_edits();
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    CaseHistory history;
    history.begin(first);
    std::vector<CaseDraft> seen{first};
    for (std::uint64_t n = 0; n < 60; ++n) {
      const auto which = static_cast<std::size_t>(uniform01(seed, 3 * n) * static_cast<double>(edits.size()));
      const auto next = edits[which](history.draft(), uniform01(seed, 3 * n + 1));
      if (!next) continue;
      const bool is_drag = uniform01(seed, 3 * n + 2) < 0.3;
      const bool is_step = !is_same_draft(*next, history.draft());
      const std::size_t before = seen.size();
      const std::string undo_before = history.undo_text();
      history.apply(*next, "step " + std::to_string(n), is_drag ? "drag" : "");
      if (!is_step) continue;
      if (history.undo_text() == undo_before && before > 1)
        seen.back() = history.draft();  // went on with a drag
      else
        seen.push_back(history.draft());
    }
    ASSERT_GT(seen.size(), 10U);
    for (std::size_t n = seen.size(); n-- > 1;) {
      ASSERT_TRUE(is_same_draft(history.draft(), seen[n])) << seed << " " << n;
      ASSERT_TRUE(history.can_undo());
      history.undo();
    }
    EXPECT_TRUE(is_same_draft(history.draft(), first)) << seed;
    EXPECT_FALSE(history.can_undo());
    while (history.can_redo()) history.redo();
    EXPECT_TRUE(is_same_draft(history.draft(), seen.back())) << seed;
  }
}

TEST(CaseEdits, PlaceMoveAndRenameALandmark) {
  CaseDraft draft = made_draft();
  const std::size_t before = draft.landmarks.size();
  draft = *set_landmark(draft, "xiphoid process", {0.0, -90.0, 0.0});
  draft = *set_landmark(draft, "umbilicus", {0.0, -90.0, -20.0});
  draft = *set_landmark(draft, "xiphoid process", {1.0, -90.0, 2.0});
  ASSERT_EQ(draft.landmarks.size(), before + 2);
  EXPECT_EQ(draft.landmarks[before].p_P, Vec3(1.0, -90.0, 2.0));
  EXPECT_FALSE(set_landmark(draft, "", {0.0, 0.0, 0.0}));
  EXPECT_FALSE(set_landmark(draft, "far away", {0.0, 0.0, 9000.0}));
  EXPECT_FALSE(rename_landmark(draft, before, "umbilicus")) << "another has that name";
  EXPECT_FALSE(rename_landmark(draft, before, ""));
  EXPECT_FALSE(rename_landmark(draft, before + 2, "new"));
  EXPECT_TRUE(rename_landmark(draft, before, "xiphoid process")) << "its own name";
  draft = *rename_landmark(draft, before, "xiphisternal joint");
  EXPECT_EQ(draft.landmarks[before].name, "xiphisternal joint");
}

TEST(CaseEdits, KeepLandmarkNamesUnique) {
  const auto names = landmark_names();
  EXPECT_EQ(std::set<std::string_view>(names.begin(), names.end()).size(), names.size());
}

TEST(CaseHistory, DraftsShareTheVolumes) {
  CaseHistory history;
  history.begin(made_draft());
  for (int n = 0; n < 10; ++n)
    history.apply(*set_landmark(history.draft(), "point", {0.0, 0.0, static_cast<double>(n)}), "landmark");
  EXPECT_EQ(history.draft().imported.use_count(), 11);  // ten steps and the draft: one import
}

TEST(CaseHistory, KeepsABoundedNumberOfSteps) {
  CaseHistory history;
  history.begin(made_draft());
  for (std::size_t n = 0; n < CaseHistory::kMaxSteps + 50; ++n)
    history.apply(*set_risk(history.draft(), {"vessel", "", 0.1 * static_cast<double>(n + 1), false, {}}), "margin");
  std::size_t undone = 0;
  for (; history.can_undo(); ++undone) history.undo();
  EXPECT_EQ(undone, CaseHistory::kMaxSteps);
}

TEST(CaseHistory, StepAfterUndoClearsRedo) {
  CaseHistory history;
  history.begin(made_draft());
  history.apply(*set_target_label(history.draft(), "lesion"), "target");
  history.undo();
  history.apply(*rename_label(history.draft(), 3, "my liver"), "rename");
  EXPECT_FALSE(history.can_redo());
  EXPECT_EQ(history.undo_text(), "rename");
}

TEST(CaseEdits, RefuseImpossibleEditsInOneLine) {
  const CaseDraft draft = made_draft();
  EXPECT_FALSE(rename_label(draft, 3, "fat"));
  EXPECT_FALSE(rename_label(draft, 3, ""));
  EXPECT_FALSE(rename_label(draft, 200, "x"));
  EXPECT_FALSE(set_target_point(draft, {500.0, 0.0, 0.0}));
  EXPECT_FALSE(set_target_label(draft, "spleen"));
  EXPECT_FALSE(set_risk(draft, {"vessel", "", 51.0, false, {}}));
  EXPECT_FALSE(set_risk(draft, {"", "", 1.0, false, {}}));
  EXPECT_FALSE(set_entry_zone(draft, {0.0, 0.0, 0.0}, 10.0));  // deep inside the body
  EXPECT_FALSE(set_expert_path(draft, {{-100.0, 0.0, 0.0}, {-99.0, 0.0, 0.0}}));
  EXPECT_FALSE(set_target_point(CaseDraft{}, {0.0, 0.0, 0.0}));
}

TEST(CaseEdits, RenamingALabelUpdatesTargetAndRisks) {
  CaseDraft draft = *set_target_label(made_draft(), "lesion");
  draft = *set_risk(draft, {"", "gallbladder", 4.0, false, {}});
  draft = *rename_label(draft, 4, "tumour");
  draft = *rename_label(draft, 8, "bladder of gall");
  EXPECT_EQ(draft.task.target_label, "tumour");
  EXPECT_EQ(draft.task.risks.back().label, "bladder of gall");
}

TEST(CaseEdits, ProjectTheEntryZoneOntoTheSkin) {
  const auto draft = set_entry_zone(made_draft(), {-92.0, 5.0, 3.0}, 15.0);
  ASSERT_TRUE(draft) << draft.error().text();
  EXPECT_NEAR(draft->task.entry_zone->centre_P.x(), -100.0, 0.5);
}

}  // namespace
}  // namespace trocar::case_builder
