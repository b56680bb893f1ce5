#include "panels/puncture_panel.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QScrollArea>
#include <QToolButton>
#include <cmath>

#include "attempt/guide/needle_view.h"
#include "panels/step_list.h"
#include "test/widget_actions.h"

namespace trocar::trainer {
namespace {

/// As wide as beside the views; events come while it is shown.
struct ShownPanel {
  ShownPanel() {
    panel.resize(238, 700);
    panel.begin(8.0, true);
    panel.show();
    QCoreApplication::processEvents();
  }
  QListWidget& events() { return *panel.findChild<QListWidget*>(QStringLiteral("events")); }
  QRect place_of(int row) { return events().visualItemRect(events().item(row)); }
  /// Whether the last line of a row's height holds text.
  bool is_last_line_used(int row) {
    const QRect place = place_of(row);
    const int high = events().fontMetrics().lineSpacing();
    const QImage image = events().viewport()->grab(place.adjusted(4, place.height() - high, -4, 0)).toImage();
    const QColor ground = image.pixelColor(image.width() - 1, 0);
    for (int y = 0; y < image.height(); ++y)
      for (int x = 0; x < image.width(); ++x)
        if (std::abs(qGray(image.pixel(x, y)) - qGray(ground.rgb())) > 60) return true;
    return false;
  }
  PuncturePanel panel;
};

TEST(PuncturePanel, NoRowOfEventsHasABlankLine) {
  // Longer and longer: some text ends where the scroll bar would be.
  ShownPanel shown;
  QString text = QStringLiteral("3.7 s  through the");
  for (int longer = 0; longer < 24; ++longer) {
    shown.panel.begin(8.0, true);
    shown.panel.add_event(text);
    shown.panel.add_event(QStringLiteral("3.9 s  into the fat"));
    QCoreApplication::processEvents();
    EXPECT_TRUE(shown.is_last_line_used(0)) << text.toStdString();
    EXPECT_EQ(shown.place_of(1).top(), shown.place_of(0).bottom() + 1);
    text += longer % 5 == 0 ? QStringLiteral(" m") : QStringLiteral("i");
  }
  EXPECT_GT(shown.place_of(0).height(), shown.place_of(1).height()) << "the longest breaks";
  shown.panel.begin(8.0, true);
  shown.panel.add_event(QStringLiteral("3.7 s  through the skin at 2.8 N"));
  shown.panel.add_event(QStringLiteral("3.9 s  into the fat"));
  QCoreApplication::processEvents();
  save(shown.panel, "puncture_panel.png");
}

TEST(PuncturePanel, OffersAimOnlyWhenThePlanIsVisible) {
  ShownPanel shown;
  auto* aim = shown.panel.findChild<QPushButton*>(QStringLiteral("aim"));
  EXPECT_FALSE(aim->isHidden());
  shown.panel.begin(8.0, false);
  EXPECT_TRUE(aim->isHidden());
}

TEST(PuncturePanel, KeepsTheNewestEventVisibleWhenTheCoreIsShown) {
  ShownPanel shown;
  for (int n = 0; n < 12; ++n)
    shown.panel.add_event(QStringLiteral("%1.0 s  through the liver capsule at 1.5 N").arg(n));
  shown.panel.add_event(QStringLiteral("12.0 s  the gun was fired at 52 mm"));
  QCoreApplication::processEvents();
  attempt::GunShot shot;
  shot.depth_mm = 52.0;
  shot.pieces = {{scoring::CorePart::kOrgan, "liver", 0.0, 4.0},
                 {scoring::CorePart::kTarget, "liver_lesion", 4.0, 18.0}};
  shown.panel.show_core(shot);
  QCoreApplication::processEvents();
  EXPECT_TRUE(shown.events().viewport()->rect().contains(shown.place_of(12)));
}

TEST(PuncturePanel, ReplacesItsButtonsByTheQuestionWithoutResizing) {
  ShownPanel shown;
  auto& question = *shown.panel.findChild<QWidget*>(QStringLiteral("question"));
  auto& end = *shown.panel.findChild<QPushButton*>(QStringLiteral("end-attempt"));
  int yes = 0;
  QObject::connect(&shown.panel, &PuncturePanel::confirmed, [&] { ++yes; });
  const auto open = [&] {
    shown.panel.ask(QStringLiteral("End the attempt and score it?"), QStringLiteral("End (Enter)"));
    QCoreApplication::processEvents();
    EXPECT_TRUE(shown.panel.is_asking());
    EXPECT_FALSE(end.isVisible());
    EXPECT_TRUE(shown.panel.rect().contains(question.geometry()));
    const auto& yes_button = *shown.panel.findChild<QPushButton*>(QStringLiteral("question-yes"));
    EXPECT_GE(yes_button.width(), yes_button.sizeHint().width()) << "its text is cut off";
  };
  open();
  save(shown.panel, "puncture_panel_question.png");
  shown.panel.findChild<QPushButton*>(QStringLiteral("question-no"))->click();
  EXPECT_FALSE(shown.panel.is_asking());
  EXPECT_TRUE(end.isVisible());
  EXPECT_EQ(yes, 0);
  open();
  shown.panel.findChild<QPushButton*>(QStringLiteral("question-yes"))->click();
  EXPECT_FALSE(shown.panel.is_asking());
  EXPECT_EQ(yes, 1);
  open();
  shown.panel.begin(8.0, true);  // another attempt
  EXPECT_FALSE(shown.panel.is_asking());
  EXPECT_EQ(yes, 1);
}

/// The first two of four steps are done, the second one at 12 s; the third one is the current one.
std::vector<attempt::PhaseView> four_steps() {
  return {{"Find the lesion with the transducer", "You can only hit what you see.", {}, true, 1.0, 5.0},
          {"Give local anaesthetic", "Skin and capsule hurt.", {}, true, 5.0, 12.0},
          {"Align the needle with the image plane",
           "Only in the plane does the image show needle and tip.",
           "Turn the needle into the plane",
           true,
           12.0,
           {}},
          {"Advance with the tip in sight", "If the tip leaves the image, stop.", {}, false, {}, {}}};
}

template <class Widget>
Widget& part(const QWidget& parent, const char* name) {
  auto* found = parent.findChild<Widget*>(QString::fromLatin1(name));
  if (found == nullptr) throw std::runtime_error(std::string("no ") + name);
  return *found;
}

TEST(PunctureSteps, ShowsWhatTheCurrentStepStillNeeds) {
  ShownPanel shown;
  StepList& steps = shown.panel.steps();
  EXPECT_TRUE(steps.isHidden()) << "an exam has no steps";
  steps.propose_folded(false);
  steps.show_steps(four_steps(), 2, 60.0, true);
  EXPECT_FALSE(steps.isHidden());
  EXPECT_EQ(part<QLabel>(steps, "step-lacks").text(), QStringLiteral("Turn the needle into the plane"));
  EXPECT_TRUE(part<QLabel>(steps, "step-why").text().contains(QStringLiteral("needle and tip")));
  EXPECT_EQ(part<QLabel>(steps, "steps-heading").text(), QStringLiteral("2 of 4 steps done"));
  EXPECT_EQ(part<QLabel>(steps, "step-1").accessibleName(),
            QStringLiteral("done: Find the lesion with the transducer"));
  EXPECT_EQ(part<QLabel>(steps, "step-3").accessibleName(),
            QStringLiteral("now: Align the needle with the image plane"));
  EXPECT_TRUE(part<QLabel>(steps, "step-4").isVisible());
  shown.panel.show_figures({});
  QCoreApplication::processEvents();
  save(shown.panel, "puncture_panel_steps.png");
}

TEST(PunctureSteps, AssistedShowsTitlesAndTicksOnly) {
  ShownPanel shown;
  StepList& steps = shown.panel.steps();
  steps.show_steps(four_steps(), 2, 60.0, false);
  EXPECT_TRUE(part<QLabel>(steps, "step-lacks").isHidden());
  EXPECT_TRUE(part<QLabel>(steps, "step-why").isHidden());
  EXPECT_TRUE(part<QLabel>(steps, "step-3").toolTip().isEmpty());
  EXPECT_TRUE(part<QLabel>(steps, "step-3").isVisible());
}

TEST(PunctureSteps, ConfirmsACompletedStepBriefly) {
  ShownPanel shown;
  StepList& steps = shown.panel.steps();
  const QLabel& heading = part<QLabel>(steps, "steps-heading");
  steps.show_steps(four_steps(), 2, 12.5, true);
  EXPECT_EQ(heading.text(), QStringLiteral("\u2713 Step 2 done"));
  steps.show_steps(four_steps(), 2, 12.0 + StepList::kConfirmed_s + 0.1, true);
  EXPECT_EQ(heading.text(), QStringLiteral("2 of 4 steps done"));
}

TEST(PunctureSteps, OnlyADoneStepCanBeRepeated) {
  ShownPanel shown;
  StepList& steps = shown.panel.steps();
  std::vector<std::size_t> repeated;
  QObject::connect(&steps, &StepList::repeat_requested, [&](std::size_t step) { repeated.push_back(step); });
  steps.propose_folded(false);
  steps.show_steps(four_steps(), 2, 60.0, true);
  EXPECT_FALSE(part<QToolButton>(steps, "step-3-repeat").isVisible());
  auto& second = part<QToolButton>(steps, "step-2-repeat");
  EXPECT_TRUE(second.isVisible());
  EXPECT_TRUE(second.focusPolicy() & Qt::TabFocus);
  second.click();
  EXPECT_EQ(repeated, std::vector<std::size_t>{1});
}

TEST(PunctureSteps, FoldedListShowsNeighboursOfTheCurrentStep) {
  ShownPanel shown;
  StepList& steps = shown.panel.steps();
  shown.panel.resize(238, 560);
  steps.show_steps(four_steps(), 2, 60.0, true);
  QCoreApplication::processEvents();
  ASSERT_TRUE(steps.is_folded());
  const bool are_shown[] = {false, true, true, true};
  for (int n = 0; n < 4; ++n)
    EXPECT_EQ(part<QLabel>(steps, qPrintable(QStringLiteral("step-%1").arg(n + 1))).isVisible(), are_shown[n]) << n;
  part<QToolButton>(steps, "steps-fold").click();
  EXPECT_TRUE(part<QLabel>(steps, "step-1").isVisible());
  shown.panel.resize(238, 550);
  QCoreApplication::processEvents();
  EXPECT_FALSE(steps.is_folded()) << "the user's choice stays";
}

tasks::Task liver_biopsy() {
  tasks::Task task;
  task.pain.needs_anaesthesia = true;
  task.phases.resize(1);
  task.phases[0].done = {{tasks::ConditionKind::kBreathHeld, 0.0, {}}};
  return task;
}

TEST(PunctureActions, ATaskShowsItsActionsOnly) {
  tasks::Needle gun;
  gun.is_biopsy = true;
  gun.stylet_diameter_mm = 0.788;
  EXPECT_EQ(actions_of(liver_biopsy(), gun), (std::vector{Action::kAnaesthetic, Action::kBreath, Action::kLoad}));
  tasks::Needle chiba;
  chiba.stylet_diameter_mm = 0.363;
  tasks::Task drainage;
  drainage.phases.resize(1);
  drainage.phases[0].done = {{tasks::ConditionKind::kWire, 50.0, {}}};
  EXPECT_EQ(actions_of(drainage, chiba), (std::vector{Action::kStylet, Action::kAspirate, Action::kWire}));
  chiba.stylet_diameter_mm = 0.0;
  EXPECT_EQ(actions_of({}, chiba), std::vector{Action::kAspirate});
}

TEST(PunctureActions, TellWhyAnActionIsNotPossible) {
  tasks::Needle gun;
  gun.is_biopsy = true;
  const auto reason = [&](bool is_loaded, bool is_outside) {
    const ActionState state{.can_act = true, .is_gun_loaded = is_loaded, .is_outside = is_outside};
    return why_not(Action::kLoad, state, gun);
  };
  EXPECT_EQ(reason(true, true), "The gun is loaded.");
  EXPECT_EQ(reason(false, true), "");
  EXPECT_EQ(reason(false, false), "Withdraw the needle first: without a coaxial needle the gun is loaded outside.");
  tasks::Needle chiba;
  chiba.stylet_diameter_mm = 0.363;
  EXPECT_TRUE(why_not(Action::kAspirate, {.can_act = true}, chiba).contains(QStringLiteral("(Y)")));
  EXPECT_EQ(why_not(Action::kAnaesthetic, {}, chiba), "The attempt is not running.");
}

TEST(PunctureActions, ButtonsShowTheStateAndEmitRequests) {
  ShownPanel shown;
  std::vector<Action> requested;
  QObject::connect(&shown.panel, &PuncturePanel::action_requested, [&](Action a) { requested.push_back(a); });
  shown.panel.begin(8.0, true, false, {Action::kStylet, Action::kAspirate, Action::kWire});
  auto& stylet = part<QPushButton>(shown.panel, "action-stylet");
  EXPECT_TRUE(stylet.isVisible());
  EXPECT_FALSE(part<QPushButton>(shown.panel, "action-anaesthetic").isVisible());
  EXPECT_FALSE(stylet.isEnabled());
  PunctureFigures figures;
  figures.actions.can_act = true;
  shown.panel.show_figures(figures);
  EXPECT_TRUE(stylet.toolTip().contains(QStringLiteral("(Y)")));
  stylet.click();
  EXPECT_EQ(requested, std::vector{Action::kStylet});
  EXPECT_EQ(stylet.text(), QStringLiteral("Remove stylet"));
  figures.actions.is_stylet_drawn = true;
  figures.hint = QStringLiteral("Stylet removed: fluid clear as water drips from the hub");
  figures.is_hint_notice = true;
  shown.panel.show_figures(figures);
  EXPECT_EQ(stylet.text(), QStringLiteral("Reinsert stylet"));
  QCoreApplication::processEvents();
  save(shown.panel, "puncture_panel_actions.png");
  shown.panel.begin(8.0, true);
  EXPECT_FALSE(stylet.isVisible());
}

/// As wide as in the window, beside the scroll bar of a low one.
TEST(PunctureActions, FitsEveryButton) {
  ShownPanel shown;
  shown.panel.begin(8.0, true, false, {std::begin(kTraineeActions), std::end(kTraineeActions)});
  PunctureFigures figures;
  figures.tissue = QStringLiteral("superior mesenteric vein, right lower lobe");
  figures.phase = QStringLiteral("forces stopped");
  figures.depth_mm = figures.to_target_mm = 123.4;
  figures.since_contact_s = 1234.0;
  shown.panel.show_figures(figures);
  shown.panel.steps().show_steps(four_steps(), 2, 60.0, true);
  shown.panel.resize(252, 450);
  for (int round = 0; round < 3; ++round) QCoreApplication::processEvents();
  const QScrollArea& area = *shown.panel.findChild<QScrollArea*>();
  EXPECT_LE(area.widget()->width(), area.viewport()->width());
  for (const QPushButton* button : shown.panel.findChildren<QPushButton*>()) {
    if (button->isVisible()) {
      EXPECT_GE(button->width(), button->sizeHint().width()) << button->objectName().toStdString();
    }
  }
}

}  // namespace
}  // namespace trocar::trainer
