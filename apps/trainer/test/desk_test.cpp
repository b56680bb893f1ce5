#include "desk/desk.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QToolButton>

#include "script/widget_events.h"
#include "shell/theme.h"
#include "test/open_abdomen.h"
#include "views/patient_view.h"
#include "views/slice_view.h"
#include "views/ultrasound_view.h"

namespace trocar::trainer {
namespace {

TEST(Desk, ShowsOfThePlanWhatTheHelpAllows) {
  Desk desk;
  desk.resize(1000, 700);
  desk.show();
  desk.show_case(open_abdomen());
  QCoreApplication::processEvents();
  auto* axial = desk.findChild<SliceView*>(QStringLiteral("slice-axial"));
  ASSERT_NE(axial, nullptr);
  axial->resize(480, 400);
  const auto share_of = [&](const QColor& color) { return share_near(axial->grab().toImage(), color, 40); };
  const Rgb& green = open_abdomen()->the_case.patient->label_table.find("liver_lesion_1")->color;
  const QColor lesion(green[0], green[1], green[2]);
  auto* lesion_eye = desk.findChild<QToolButton*>(QStringLiteral("structure-eye-liver-lesion-1"));
  ASSERT_NE(lesion_eye, nullptr);
  struct Expected {
    Difficulty difficulty;
    Guidance in_space;
    bool has_target, is_guide_offered, is_guide_shown;
  };
  double last_path = 1.0;
  for (const Expected& e : {Expected{Difficulty::kGuided, Guidance::kPath, true, true, true},
                            Expected{Difficulty::kAssisted, Guidance::kTarget, true, true, false},
                            Expected{Difficulty::kExam, Guidance::kNone, false, false, false}}) {
    desk.show_help(e.difficulty);
    EXPECT_EQ(desk.view_3d().scene().guidance(), e.in_space);
    EXPECT_EQ(desk.ultrasound().is_guide_offered(), e.is_guide_offered);
    EXPECT_EQ(desk.ultrasound().is_guide_visible(), e.is_guide_shown);
    EXPECT_EQ(desk.findChild<QToolButton*>(QStringLiteral("show-guidance"))->isEnabled(),
              e.in_space != Guidance::kNone);
    EXPECT_EQ(share_of(theme().target) > 0.0002, e.has_target) << title_of(e.difficulty);
    EXPECT_EQ(share_near(axial->grab().toImage(), lesion, 12) > 0.0001, e.has_target) << title_of(e.difficulty);
    EXPECT_EQ(!lesion_eye->parentWidget()->isHidden(), e.has_target) << title_of(e.difficulty);
    const double path = share_of(theme().path);  // the entry zone's circle has its colour too
    EXPECT_LT(path, last_path) << title_of(e.difficulty);
    last_path = path;
  }
}

}  // namespace
}  // namespace trocar::trainer
