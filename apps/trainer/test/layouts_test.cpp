#include "workspace/layouts.h"

#include <gtest/gtest.h>

#include <QAction>
#include <QApplication>
#include <QDockWidget>
#include <QSettings>
#include <set>

#include "workspace/standard_views.h"
#include "workspace/workspace.h"

namespace trocar::trainer {
namespace {

using Names = std::set<std::string>;

/// With the places of the views.
const std::vector<Layout>& standard_layouts() {
  static const std::vector<Layout> layouts = layouts_of(standard_views());
  return layouts;
}

/// Without layouts that an earlier test has kept.
struct LayoutsTest : ::testing::Test {
  LayoutsTest() { QSettings().clear(); }
};

Names shown_by(const Workspace& workspace) {
  Names names;
  for (const QDockWidget* dock : workspace.findChildren<QDockWidget*>()) {
    if (dock->isVisible()) names.insert(dock->objectName().mid(5).toStdString());
  }
  return names;
}

Names named_by(const Layout& layout) {
  Names names;
  for (const LayoutColumn& column : layout.columns) {
    for (const LayoutCell& cell : column.cells) {
      for (const QString& view : cell.views) names.insert(view.toStdString());
    }
  }
  return names;
}

TEST_F(LayoutsTest, ShowsExactlyTheViewsOfTheLayout) {
  Workspace workspace;
  workspace.resize(1000, 700);
  workspace.show();
  for (int round = 0; round < 3; ++round) {  // from the second on as it was kept
    for (const Layout& layout : standard_layouts()) {
      workspace.choose_layout(layout.name);
      QApplication::processEvents();
      EXPECT_EQ(workspace.width(), 1000) << "a change of layout must not widen the window";
      EXPECT_EQ(shown_by(workspace), named_by(layout)) << layout.name.toStdString() << " in round " << round;
    }
  }
}

TEST_F(LayoutsTest, MenuAddsAViewToALayoutWithoutIt) {
  Workspace workspace;
  workspace.resize(1000, 700);
  workspace.show();
  const Layout& first = standard_layouts().front();
  workspace.choose_layout(first.name);
  auto* dock = workspace.findChild<QDockWidget*>(QStringLiteral("dock-coronal"));
  dock->toggleViewAction()->trigger();
  QApplication::processEvents();
  ASSERT_TRUE(dock->isVisible());
  const QRect place = dock->geometry();
  for (const QDockWidget* other : workspace.findChildren<QDockWidget*>()) {
    if (other != dock && other->isVisible()) {
      EXPECT_FALSE(other->geometry().intersects(place)) << "it covers " << other->objectName().toStdString();
    }
  }
}

TEST_F(LayoutsTest, HiddenViewStaysHiddenUntilTheLayoutIsReset) {
  Workspace workspace;
  workspace.resize(1000, 700);
  workspace.show();
  const Layout& first = standard_layouts().front();
  workspace.choose_layout(first.name);
  workspace.findChild<QDockWidget*>(QStringLiteral("dock-forces"))->hide();
  workspace.choose_layout(standard_layouts().back().name);
  workspace.choose_layout(first.name);
  Names expected = named_by(first);
  expected.erase("forces");
  EXPECT_EQ(shown_by(workspace), expected);
  workspace.reset_layout();
  EXPECT_EQ(shown_by(workspace), named_by(first));
}

}  // namespace
}  // namespace trocar::trainer
