#include "panels/feedback_panel.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QLabel>
#include <QPushButton>
#include <QScrollArea>
#include <QScrollBar>

namespace trocar::trainer {
namespace {

TEST(FeedbackPanelTest, ShowsWhatHappenedBesideTheTrainee) {
  FeedbackPanel panel;
  const auto* notes = panel.findChild<QLabel*>(QStringLiteral("attempt-notes"));
  ASSERT_NE(notes, nullptr);
  EXPECT_TRUE(notes->isHidden());
  panel.show_notes(
      {QStringLiteral("12 ticks of the needle did not arrive"), QStringLiteral("at 3.0 s, parameters: skin.fp=6")});
  EXPECT_FALSE(notes->isHidden());
  EXPECT_TRUE(notes->text().contains(QStringLiteral("12 ticks")));
  EXPECT_TRUE(notes->text().contains(QStringLiteral("skin.fp=6")));
  panel.show_notes({});
  EXPECT_TRUE(notes->isHidden());
}

scoring::Outcome long_outcome() {
  scoring::Outcome outcome;
  outcome.score = 42.0;
  for (int n = 0; n < 8; ++n) outcome.parts.push_back({"target", "Distance to the target", 12.0, "mm", 3.0, 25.0});
  for (int n = 0; n < 6; ++n)
    outcome.hints.push_back({"Bring the tip to the target, hold it still and fire the gun.", {}});
  return outcome;
}

TEST(FeedbackPanelTest, OpensAtTheTopEachTime) {
  FeedbackPanel panel;
  panel.resize(260, 500);
  panel.show();
  QScrollBar& bar = *panel.findChild<QScrollArea*>()->verticalScrollBar();
  for (int attempt = 0; attempt < 2; ++attempt) {
    panel.show_outcome(long_outcome(), QStringLiteral("Worst moment: 3.0 mm from the planned path, after 4 s"));
    QCoreApplication::processEvents();
    ASSERT_GT(bar.maximum(), 0);
    EXPECT_EQ(bar.value(), 0);
    bar.setValue(bar.maximum());
  }
}

TEST(FeedbackPanelTest, AFilesNameInANoteCutsNothingOff) {
  FeedbackPanel panel;
  panel.resize(238, 700);
  panel.show_outcome(long_outcome(), {});
  panel.show_notes({QStringLiteral("The recording ended: disk full (/disk/sessions/2026-11-22_20-50-14-025.trocar)")});
  panel.show();
  QCoreApplication::processEvents();
  const QScrollArea& area = *panel.findChild<QScrollArea*>();
  EXPECT_LE(area.widget()->width(), area.viewport()->width());
}

TEST(FeedbackPanelTest, TheLevelStandsBesideTheScore) {
  FeedbackPanel panel;
  panel.show_level(QStringLiteral("Exam"));
  auto* level = panel.findChild<QLabel*>(QStringLiteral("level"));
  EXPECT_EQ(level->text(), QStringLiteral("Exam"));
  EXPECT_FALSE(level->isHidden());
  panel.show_level({});
  EXPECT_TRUE(level->isHidden());
}

TEST(FeedbackPanelTest, SaysWhyAnAttemptIsNotScored) {
  FeedbackPanel panel;
  scoring::Outcome outcome;
  outcome.not_scored = "the needle never touched the skin";
  outcome.hints = {{"The needle never reached the skin: bring its tip to the planned insertion point.", {}}};
  panel.show_outcome(outcome, {});
  EXPECT_EQ(panel.findChild<QLabel*>(QStringLiteral("verdict"))->text(),
            QStringLiteral("Not scored: the needle never touched the skin"));
  EXPECT_TRUE(panel.findChild<QWidget*>(QStringLiteral("score-dial"))->isHidden());
  EXPECT_FALSE(panel.findChild<QPushButton*>(QStringLiteral("worst-moment"))->isEnabled());
  panel.show_outcome(long_outcome(), QStringLiteral("Worst moment: 3.0 mm from the planned path, after 4 s"));
  EXPECT_FALSE(panel.findChild<QWidget*>(QStringLiteral("score-dial"))->isHidden());
  EXPECT_TRUE(panel.findChild<QPushButton*>(QStringLiteral("worst-moment"))->isEnabled());
}

}  // namespace
}  // namespace trocar::trainer
