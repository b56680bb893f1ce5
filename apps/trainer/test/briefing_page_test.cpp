#include "pages/briefing_page.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QLabel>
#include <QPushButton>
#include <algorithm>

#include "script/widget_events.h"
#include "test/open_abdomen.h"
#include "test/widget_actions.h"
#include "ui_kit/theme.h"
#include "views/slices/briefing_picture.h"

namespace trocar::trainer {
namespace {

TEST(BriefingPage, TellsHowFarOpeningIsAndLetsNobodyBeginBefore) {
  BriefingPage page;
  page.show_opening({});
  page.show_progress(QStringLiteral("surfaces"), 0.4);
  EXPECT_FALSE(page.findChild<QPushButton*>(QStringLiteral("begin"))->isEnabled());
  EXPECT_EQ(page.findChild<QLabel*>(QStringLiteral("opening-state"))->text(), QStringLiteral("surfaces"));
}

TEST(BriefingPage, ShowsTheCaseAndLetsBegin) {
  BriefingPage page;
  page.resize(1280, 700);
  page.show();
  page.show_opening({});
  QCoreApplication::processEvents();
  page.show_case(*open_abdomen(), Difficulty::kGuided);
  EXPECT_TRUE(page.findChild<QPushButton*>(QStringLiteral("begin"))->isEnabled());
  save(page, "briefing_guided.png");
  page.show_case(*open_abdomen(), Difficulty::kAssisted);
  save(page, "briefing_assisted.png");
  bool says_help = false;
  for (const QLabel* label : page.findChildren<QLabel*>())
    says_help |= label->text().contains(QStringLiteral("Assisted"));
  EXPECT_TRUE(says_help);
}

TEST(BriefingPage, TellsNothingOfTheWayInAnExam) {
  BriefingPage page;
  page.resize(1280, 700);
  page.show();
  const auto says = [&](const char* text) {
    const auto labels = page.findChildren<QLabel*>();
    return std::any_of(labels.begin(), labels.end(),
                       [&](const QLabel* label) { return label->text().contains(QString::fromUtf8(text)); });
  };
  page.show_case(*open_abdomen(), Difficulty::kAssisted);
  EXPECT_TRUE(says("lesion of the liver") && says("planned path"));
  page.show_case(*open_abdomen(), Difficulty::kExam);
  EXPECT_TRUE(says("lesion of the liver"));
  EXPECT_FALSE(says("planned path"));
  save(page, "briefing_exam.png");
}

TEST(BriefingPicture, ShowsThePathInGuidedAttemptsAlone) {
  const QSize size(400, 300);
  const auto share_of_path = [&](scene::Guidance guidance) {
    return share_near(briefing_picture(*open_abdomen(), BriefingPlane::kAlongPath, size, guidance), theme().path, 12);
  };
  const double line = share_of_path(scene::Guidance::kPath), entry = share_of_path(scene::Guidance::kTarget);
  EXPECT_GT(line, 0.001);
  EXPECT_LT(entry, 0.5 * line);
  EXPECT_GT(entry, 0.0001);  // the ring at the entry
  EXPECT_EQ(share_of_path(scene::Guidance::kNone), 0.0);
}

TEST(BriefingPicture, MarksTheTargetInEveryPlane) {
  for (const BriefingPlane plane : {BriefingPlane::kAxial, BriefingPlane::kSagittal, BriefingPlane::kAlongPath}) {
    const QImage image = briefing_picture(*open_abdomen(), plane, {400, 300}, scene::Guidance::kNone);
    EXPECT_GT(share_near(image, theme().target, 12), 0.0001);
  }
}

}  // namespace
}  // namespace trocar::trainer
