#include "workspace/workspace.h"

#include <gtest/gtest.h>

#include <QAction>
#include <QCoreApplication>
#include <QDockWidget>
#include <QMenu>
#include <QSettings>
#include <QStackedWidget>
#include <QToolButton>
#include <map>

#include "core/files/folders.h"
#include "scene/tool_shapes.h"
#include "script/widget_events.h"
#include "tasks/needle.h"
#include "test/open_abdomen.h"
#include "ui_kit/theme.h"
#include "views/patient/patient_view.h"
#include "views/slices/slice_view.h"
#include "views/ultrasound/ultrasound_view.h"

namespace trocar::trainer {
namespace {

TEST(Workspace, ShowsThePlanPerHelpLevel) {
  Workspace workspace;
  workspace.resize(1000, 700);
  workspace.show();
  workspace.show_case(open_abdomen());
  QCoreApplication::processEvents();
  auto* axial = workspace.findChild<SliceView*>(QStringLiteral("slice-axial"));
  ASSERT_NE(axial, nullptr);
  axial->resize(480, 400);
  const auto share_of = [&](const QColor& color) { return share_near(axial->grab().toImage(), color, 40); };
  const cases::Case& the_case = open_abdomen()->the_case;
  const anatomy::Label* target = anatomy::find_label(
      *the_case.patient, the_case.plan.line_P.b + the_case.needle.notch_middle_mm() * the_case.plan.line_P.direction());
  ASSERT_NE(target, nullptr);
  const image::Rgb& green = target->color;
  const QColor lesion(green[0], green[1], green[2]);
  auto* lesion_eye = workspace.findChild<QToolButton*>(QStringLiteral("structure-eye-liver-lesion-1"));
  ASSERT_NE(lesion_eye, nullptr);
  struct Expected {
    TrainingMode mode;
    scene::Guidance in_space;
    bool has_target, is_guide_offered, is_guide_shown;
  };
  double last_path = 1.0;
  for (const Expected& e : {Expected{TrainingMode::kGuided, scene::Guidance::kPath, true, true, true},
                            Expected{TrainingMode::kAssisted, scene::Guidance::kTarget, true, true, false},
                            Expected{TrainingMode::kExam, scene::Guidance::kNone, false, false, false}}) {
    workspace.show_help(e.mode);
    EXPECT_EQ(workspace.find<PatientView>("3d")->scene().guidance(), e.in_space);
    EXPECT_EQ(workspace.find<UltrasoundView>("ultrasound")->is_guide_offered(), e.is_guide_offered);
    EXPECT_EQ(workspace.find<UltrasoundView>("ultrasound")->is_guide_visible(), e.is_guide_shown);
    EXPECT_EQ(workspace.findChild<QToolButton*>(QStringLiteral("show-guidance"))->isEnabled(),
              e.in_space != scene::Guidance::kNone);
    EXPECT_EQ(share_near(axial->grab().toImage(), theme().target, 8) > 0.0002, e.has_target) << title_of(e.mode);
    EXPECT_EQ(share_near(axial->grab().toImage(), lesion, 12) > 0.0001, e.has_target) << title_of(e.mode);
    EXPECT_EQ(!lesion_eye->parentWidget()->isHidden(), e.has_target) << title_of(e.mode);
    const double path = share_of(theme().path);  // the entry zone's circle has its colour too
    EXPECT_LE(path, last_path) << title_of(e.mode);
    last_path = path;
  }
}

TEST(Workspace, SideViewFollowsTheNeedleOfEachCase) {
  Workspace workspace;
  workspace.resize(1000, 700);
  workspace.show();
  workspace.choose_layout(QStringLiteral("Navigation"));
  for (int times = 0; times < 2; ++times) {
    workspace.show_case(open_abdomen());
    QCoreApplication::processEvents();
    workspace.draw(0.0);
    EXPECT_EQ(workspace.find<PatientView>("side")->follow(), scene::FollowMode::kSide);
    EXPECT_EQ(workspace.find<PatientView>("3d")->follow(), scene::FollowMode::kFree);
  }
}

using Sizes = std::map<QString, QSize>;

/// Of the views that are shown.
Sizes sizes_of(const Workspace& workspace) {
  Sizes sizes;
  for (const QDockWidget* dock : workspace.findChildren<QDockWidget*>())
    if (dock->isVisible()) sizes[dock->objectName()] = dock->size();
  return sizes;
}

void settle() {
  for (int n = 0; n < 5; ++n) QCoreApplication::processEvents();
}

void expect_same(const Sizes& now, const Sizes& before, const std::string& after) {
  ASSERT_EQ(now.size(), before.size()) << after;
  for (const auto& [view, size] : before) {
    const QSize moved = now.at(view) - size;
    // Whole pixels.
    EXPECT_LE(std::abs(moved.width()), 2) << view.toStdString() << " after " << after;
    EXPECT_LE(std::abs(moved.height()), 2) << view.toStdString() << " after " << after;
  }
}

struct WorkspaceLayoutTest : ::testing::Test {
  WorkspaceLayoutTest() {
    QSettings().clear();
    workspace.resize(1000, 700);
    workspace.show();
    workspace.choose_layout(QStringLiteral("Puncture"));
    settle();
  }
  Workspace workspace;
};

TEST_F(WorkspaceLayoutTest, KeepsViewSizesAcrossLayoutChanges) {
  const Sizes before = sizes_of(workspace);
  for (int round = 0; round < 5; ++round) {
    // As a time line below and a panel beside come and go, and pages change.
    workspace.resize(760, 640);
    settle();
    workspace.hide();
    workspace.resize(1000, 700);
    workspace.show();
    settle();
    expect_same(sizes_of(workspace), before, "round " + std::to_string(round));
  }
}

TEST_F(WorkspaceLayoutTest, RestoresLayoutsAsLeft) {
  const Sizes before = sizes_of(workspace);
  for (const Layout& layout : workspace.layouts()) {
    workspace.choose_layout(layout.name);
    settle();
  }
  workspace.choose_layout(QStringLiteral("Puncture"));
  settle();
  expect_same(sizes_of(workspace), before, "all layouts");
}

TEST_F(WorkspaceLayoutTest, EveryLayoutFitsBesideTheTissuePanelOnSmallScreens) {
  for (const Layout& layout : workspace.layouts()) {
    workspace.choose_layout(layout.name);
    settle();
    EXPECT_LE(workspace.needed_width(), 680) << layout.name.toStdString();
    EXPECT_LE(workspace.minimumSizeHint().height(), 560) << layout.name.toStdString();
  }
}

TEST_F(WorkspaceLayoutTest, MenuRaisesAViewFromBehindATab) {
  QMenu menu;
  workspace.fill_menu(menu);
  auto* ultrasound = workspace.findChild<QDockWidget*>(QStringLiteral("dock-ultrasound"));
  auto* space = workspace.findChild<QDockWidget*>(QStringLiteral("dock-3d"));
  ASSERT_NE(ultrasound, nullptr);
  ASSERT_NE(space, nullptr);
  workspace.tabifyDockWidget(ultrasound, space);
  space->raise();
  settle();
  ASSERT_TRUE(ultrasound->visibleRegion().isEmpty());
  auto* action = menu.findChild<QAction*>(QStringLiteral("show-ultrasound"));
  ASSERT_NE(action, nullptr);
  action->trigger();
  settle();
  EXPECT_FALSE(ultrasound->visibleRegion().isEmpty());
  EXPECT_FALSE(ultrasound->isHidden());
  action->trigger();  // in sight: hidden
  settle();
  EXPECT_TRUE(ultrasound->isHidden());
}

/// A straight needle on the planned path, so deep.
ToolsShown needle_at(double inside_mm) {
  const Segment& path_P = open_abdomen()->the_case.plan.line_P;
  ToolsShown tools;
  const Vec3 tip_P = path_P.a + inside_mm * path_P.direction();
  tools.X_PN = needle_pose(tip_P, path_P.direction());
  tools.shaft_P = {path_P.a - 100.0 * path_P.direction(), tip_P};
  tools.focus_P = tip_P;
  tools.inside_mm = inside_mm;
  return tools;
}

TEST(Workspace, SlicesHideTheDepthOfAHiddenTip) {
  Workspace workspace;
  workspace.resize(1000, 700);
  workspace.choose_layout(QStringLiteral("Slices"));
  workspace.show();
  workspace.show_case(open_abdomen());
  workspace.show_help(TrainingMode::kExam);
  QCoreApplication::processEvents();
  auto* axial = workspace.findChild<SliceView*>(QStringLiteral("slice-axial"));
  const Vec3 entry_P = open_abdomen()->the_case.plan.line_P.a;
  const auto show = [&](double inside_mm) {
    workspace.show_tools(needle_at(inside_mm));
    workspace.draw(0.0);
  };
  workspace.set_tip_hidden(true);
  const Vec3 middle_P = axial->focus();
  for (const char* name : {"slice-axial", "slice-along-needle", "slice-across-needle"}) {
    auto* slice = workspace.findChild<SliceView*>(QString::fromLatin1(name));
    show(20.0);
    axial->set_focus(entry_P);  // where the needle is
    const QImage shallow = slice->grab().toImage();
    workspace.show_tools(needle_at(50.0));
    workspace.draw(0.0);
    EXPECT_EQ(slice->grab().toImage(), shallow) << name;
    axial->set_focus(middle_P);
  }
  EXPECT_EQ(axial->focus(), middle_P);
  workspace.set_tip_hidden(false);
  show(20.0);
  const QImage shallow = axial->grab().toImage();
  show(50.0);
  EXPECT_NE(axial->grab().toImage(), shallow);
  EXPECT_EQ(axial->focus(), *needle_at(50.0).focus_P);
}

TEST(NeedleModels, CoverEveryNeedleInTheList) {
  const auto needles = tasks::load_needles(data_dir() / "needles.toml");
  ASSERT_TRUE(needles) << needles.error().text();
  std::map<std::string, scene::NeedleModel> models;
  for (const tasks::Needle& needle : *needles) models[needle.name] = scene::needle_model(needle.model);
  EXPECT_EQ(models.at("paracentesis-14g"), scene::NeedleModel::kTrocar);
  EXPECT_EQ(models.at("biopsy-16g"), scene::NeedleModel::kBiopsyGun);
  EXPECT_EQ(models.at("tuohy-17g"), scene::NeedleModel::kTuohy);
  EXPECT_EQ(models.at("quincke-22g"), scene::NeedleModel::kQuincke);
  EXPECT_EQ(models.at("chiba-22g"), scene::NeedleModel::kChiba);
}

TEST(Workspace, AFloatingViewIsHiddenWithThePage) {
  QSettings().clear();
  QStackedWidget pages;
  auto* workspace = new Workspace;
  pages.addWidget(workspace);
  pages.addWidget(new QWidget);
  pages.resize(1000, 700);
  pages.show();
  auto* dock = workspace->findChild<QDockWidget*>(QStringLiteral("dock-3d"));
  dock->setFloating(true);
  dock->show();
  QCoreApplication::processEvents();
  pages.setCurrentIndex(1);
  EXPECT_TRUE(dock->isHidden());
  pages.setCurrentIndex(0);
  EXPECT_FALSE(dock->isHidden());
  EXPECT_TRUE(dock->isFloating());
}

}  // namespace
}  // namespace trocar::trainer
