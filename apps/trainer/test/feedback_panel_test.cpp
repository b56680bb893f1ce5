#include "panels/feedback_panel.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QLabel>
#include <QPushButton>
#include <QScrollArea>
#include <QScrollBar>

#include "panels/hint_list.h"
#include "test/widget_actions.h"

namespace trocar::trainer {
namespace {

scoring::Outcome long_outcome() {
  scoring::Outcome outcome;
  outcome.score = 42.0;
  for (int n = 0; n < 8; ++n) outcome.parts.push_back({"target", "Distance to the target", 12.0, "mm", 3.0, 25.0});
  for (int n = 0; n < 6; ++n)
    outcome.hints.push_back({"Bring the tip to the target, hold it still and fire the gun.", {}});
  return outcome;
}

TEST(FeedbackPanelTest, ShowsTheNextExerciseAndTheSignedResult) {
  FeedbackPanel panel;
  const auto* next = panel.findChild<QLabel*>(QStringLiteral("feedback-next"));
  const auto* result = panel.findChild<QLabel*>(QStringLiteral("exam-result"));
  EXPECT_TRUE(next->isHidden());
  EXPECT_TRUE(result->isHidden());
  panel.show_next(QStringLiteral("Liver biopsy, case 2, assisted. It is due today."));
  panel.show_result(QStringLiteral("The result of the exam is signed: a.result.json"));
  EXPECT_FALSE(next->isHidden());
  EXPECT_TRUE(next->text().contains(QStringLiteral("due today")));
  EXPECT_FALSE(result->isHidden());
  panel.show_next({});
  panel.show_result({});
  EXPECT_TRUE(next->isHidden());
  EXPECT_TRUE(result->isHidden());
}

/// Counts the windows that are opened while it lives.
class WindowCount : public QObject {
 public:
  WindowCount() { QCoreApplication::instance()->installEventFilter(this); }
  bool eventFilter(QObject* watched, QEvent* event) override {
    const auto* widget = qobject_cast<const QWidget*>(watched);
    if (event->type() == QEvent::Show && widget != nullptr && widget->isWindow()) ++opened;
    return false;
  }
  int opened = 0;
};

TEST(FeedbackPanelTest, OpensInsideTheMainWindow) {
  FeedbackPanel panel;
  panel.show();
  const WindowCount windows;
  panel.show_outcome(long_outcome(), QStringLiteral("Worst moment"));
  panel.show_next(QStringLiteral("Liver biopsy"));
  panel.show_notes({QStringLiteral("12 ticks of the needle did not arrive")});
  EXPECT_EQ(windows.opened, 0);
}

TEST(FeedbackPanelTest, ShowsAttemptNotes) {
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

TEST(FeedbackPanelTest, OpensAtTheTopEachTime) {
  FeedbackPanel panel;
  panel.resize(260, 500);
  panel.show();
  QScrollBar& bar = *panel.findChild<QScrollArea*>()->verticalScrollBar();
  for (int attempt = 0; attempt < 2; ++attempt) {
    panel.show_outcome(long_outcome(), QStringLiteral("Worst moment: 3.0 mm from the planned path, after 4 s"));
    QCoreApplication::processEvents();
    QCoreApplication::processEvents();  // the hints' rows are shown, and ask for their place
    ASSERT_GT(bar.maximum(), 0);
    EXPECT_EQ(bar.value(), 0);
    bar.setValue(bar.maximum());
  }
}

TEST(FeedbackPanelTest, WrapsALongFileNameInANote) {
  FeedbackPanel panel;
  panel.resize(238, 700);
  panel.show_outcome(long_outcome(), {});
  panel.show_notes({QStringLiteral("The recording ended: disk full (/disk/sessions/2026-11-22_20-50-14-025.trocar)")});
  panel.show();
  QCoreApplication::processEvents();
  const QScrollArea& area = *panel.findChild<QScrollArea*>();
  EXPECT_LE(area.widget()->width(), area.viewport()->width());
}

TEST(FeedbackPanelTest, ShowsTheLevelBesideTheScore) {
  FeedbackPanel panel;
  panel.show_level(QStringLiteral("Exam"));
  auto* level = panel.findChild<QLabel*>(QStringLiteral("level"));
  EXPECT_EQ(level->text(), QStringLiteral("Exam"));
  EXPECT_FALSE(level->isHidden());
  panel.show_level({});
  EXPECT_TRUE(level->isHidden());
}

TEST(FeedbackPanelTest, ButtonOffersTheNextExamAfterAnExam) {
  FeedbackPanel panel;
  auto* again = panel.findChild<QPushButton*>(QStringLiteral("try-again"));
  EXPECT_EQ(again->text(), QStringLiteral("Try again"));
  panel.show_again(true);
  EXPECT_EQ(again->text(), QStringLiteral("Next exam"));
  EXPECT_EQ(again->shortcut(), QKeySequence(QStringLiteral("Ctrl+R"))) << "a new text keeps the key";
  panel.show_again(false);
  EXPECT_EQ(again->text(), QStringLiteral("Try again"));
}

TEST(FeedbackPanelTest, ShowsWhyAnAttemptIsNotScored) {
  FeedbackPanel panel;
  scoring::Outcome outcome;
  outcome.not_scored = "the needle never touched the skin";
  outcome.hints = {{"The needle never reached the skin: bring its tip to the planned insertion point.", {}}};
  panel.show_outcome(outcome, {});
  EXPECT_EQ(panel.findChild<QLabel*>(QStringLiteral("verdict"))->text(),
            QStringLiteral("Not scored: the needle never touched the skin"));
  EXPECT_TRUE(panel.findChild<QWidget*>(QStringLiteral("score-dial"))->isHidden());
  EXPECT_TRUE(panel.findChild<QPushButton*>(QStringLiteral("worst-moment"))->isHidden());
  panel.show_outcome(long_outcome(), QStringLiteral("Worst moment: 3.0 mm from the planned path, after 4 s"));
  EXPECT_FALSE(panel.findChild<QWidget*>(QStringLiteral("score-dial"))->isHidden());
  EXPECT_FALSE(panel.findChild<QPushButton*>(QStringLiteral("worst-moment"))->isHidden());
}

QString text_of(const FeedbackPanel& panel, const char* name) {
  return panel.findChild<QLabel*>(QString::fromLatin1(name))->text();
}

TEST(FeedbackPanelTest, ShowsTheVerdictWithItsReasons) {
  FeedbackPanel panel;
  scoring::Outcome outcome = long_outcome();
  outcome.fails = {"the lung was touched", "the score is below 70"};
  panel.show_outcome(outcome, {});
  EXPECT_EQ(text_of(panel, "verdict"), QStringLiteral("Not passed"));
  EXPECT_EQ(text_of(panel, "verdict-reasons"), QStringLiteral("The lung was touched\nThe score is below 70"));
  outcome.fails.clear();
  outcome.is_passed = true;
  panel.show_outcome(outcome, {});
  EXPECT_EQ(text_of(panel, "verdict"), QStringLiteral("Passed"));
  EXPECT_TRUE(panel.findChild<QLabel*>(QStringLiteral("verdict-reasons"))->isHidden());
  outcome.is_passed = false;  // a session of an older program
  panel.show_outcome(outcome, {});
  EXPECT_EQ(text_of(panel, "verdict"), QStringLiteral("The target was missed"));
}

TEST(FeedbackPanelTest, HintJumpsToItsMoment) {
  FeedbackPanel panel;
  panel.resize(238, 900);
  scoring::Outcome outcome = long_outcome();
  outcome.parts.resize(3);
  outcome.hints = {{"The insertion point was 14 mm too far left: move the needle right before inserting it.", 3.2},
                   {"Give local anaesthetic before you pierce the skin.", {}},
                   {"The lung was touched: enter lower.", 8.5}};
  outcome.fails = {"the lung was touched", "the score is below 70"};
  panel.show_outcome(outcome, QStringLiteral("Worst moment: the lung was touched, after 8.5 s"));
  std::vector<double> moments;
  QObject::connect(&panel.hints(), &HintList::moment_chosen, [&](double time_s) { moments.push_back(time_s); });
  panel.show();
  QCoreApplication::processEvents();
  EXPECT_NE(panel.findChild<QLabel*>(QStringLiteral("hint-2")), nullptr) << "no moment, no button";
  auto* third = panel.findChild<QPushButton*>(QStringLiteral("hint-3"));
  ASSERT_NE(third, nullptr);
  third->click();
  EXPECT_TRUE(third->isChecked());
  panel.hints().choose_next();
  panel.hints().choose_next();
  EXPECT_EQ(moments, (std::vector{8.5, 3.2, 8.5}));
  auto* first = panel.findChild<QPushButton*>(QStringLiteral("hint-1"));
  EXPECT_FALSE(first->isChecked());
  EXPECT_TRUE(first->focusPolicy() & Qt::TabFocus);
  const auto* words = first->findChild<QLabel*>();
  EXPECT_GE(words->height(), words->heightForWidth(words->width())) << "its text is cut off";
  EXPECT_GT(words->height(), 2 * words->fontMetrics().lineSpacing()) << "the text wraps";
  save(panel, "feedback_panel.png");
}

}  // namespace
}  // namespace trocar::trainer
