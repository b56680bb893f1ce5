#include "panels/feedback_panel.h"

#include <gtest/gtest.h>

#include <QLabel>

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

}  // namespace
}  // namespace trocar::trainer
