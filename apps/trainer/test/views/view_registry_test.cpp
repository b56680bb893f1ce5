#include "views/view_registry.h"

#include <gtest/gtest.h>

#include <QAction>
#include <QCoreApplication>
#include <QDialog>
#include <QDockWidget>
#include <QLabel>
#include <QMenu>
#include <QSettings>
#include <QTimer>

#include "test/open_abdomen.h"
#include "views/patient/patient_view.h"
#include "workspace/workspace.h"

namespace trocar::trainer {
namespace {

/// Counts what it receives.
struct Received {
  int opened = 0, helped = 0, hidden = 0, tools = 0, updates = 0, draws = 0;
  double last_s = 0.0;
  bool is_visible_tip_deep = false;
};

class DummyView final : public View {
 public:
  explicit DummyView(Received& received) : received_(received), label_(new QLabel(QStringLiteral("dummy"))) {}

  QWidget& widget() override { return *label_; }
  bool open(const CaseContext& context) override {
    if (context.open) ++received_.opened;
    return true;
  }
  void show_help(TrainingMode) override { ++received_.helped; }
  void set_tip_hidden(bool) override { ++received_.hidden; }
  void show_tools(const ToolContext& context) override {
    ++received_.tools;
    received_.is_visible_tip_deep = context.visible->shaft_P.back() == context.tools->shaft_P.back();
  }
  void update(const FrameContext& frame) override {
    ++received_.updates;
    received_.last_s = frame.now_s;
  }
  void draw(const FrameContext&) override { ++received_.draws; }

 private:
  Received& received_;
  QLabel* label_;
};

struct ViewRegistryTest : ::testing::Test {
  ViewRegistryTest() { QSettings().clear(); }

  /// All views of the trainer, and one more: a file with its description and this line.
  ViewRegistry with_dummy() {
    ViewRegistry registry = standard_views();
    ViewDescription dummy;
    dummy.id = QStringLiteral("dummy");
    dummy.title = QStringLiteral("Dummy view");
    dummy.toggled_by = Action::kXrayView;
    dummy.places = {{QStringLiteral("Puncture"), 1, 20}, {QStringLiteral("Fluoroscopy"), 0, 1}};
    dummy.make = [this](ViewContext&) { return std::make_unique<DummyView>(received_); };
    registry.add(std::move(dummy));
    return registry;
  }
  static bool is_visible(const Workspace& workspace, const char* dock) {
    QCoreApplication::processEvents();
    return workspace.findChild<QDockWidget*>(QString::fromLatin1(dock))->isVisible();
  }

  Received received_;
};

TEST_F(ViewRegistryTest, MenuListsARegisteredViewWithItsShortcut) {
  Workspace workspace(with_dummy());
  QMenu menu;
  workspace.fill_menu(menu);
  auto* action = menu.findChild<QAction*>(QStringLiteral("show-dummy"));
  ASSERT_NE(action, nullptr);
  EXPECT_EQ(action->text(), QStringLiteral("Dummy view"));
  EXPECT_EQ(action->shortcut(), key_of(Action::kXrayView));
}

TEST_F(ViewRegistryTest, PlacesARegisteredViewInLayouts) {
  Workspace workspace(with_dummy());
  workspace.resize(1000, 700);
  workspace.show();
  EXPECT_TRUE(is_visible(workspace, "dock-dummy")) << "in the first layout";
  workspace.choose_layout(QStringLiteral("Slices"));
  EXPECT_FALSE(is_visible(workspace, "dock-dummy"));
  workspace.choose_layout(QStringLiteral("Fluoroscopy"));
  EXPECT_TRUE(is_visible(workspace, "dock-dummy")) << "a layout of its own";
  EXPECT_FALSE(is_visible(workspace, "dock-3d"));
  EXPECT_EQ(workspace.layouts().size(), layouts_of(standard_views()).size() + 1);
}

TEST_F(ViewRegistryTest, RegisteredViewReceivesCaseToolsAndFrames) {
  Workspace workspace(with_dummy());
  workspace.show_case(open_abdomen());
  workspace.show_help(TrainingMode::kGuided);
  const Segment& path_P = open_abdomen()->the_case.plan.line_P;
  ToolsShown tools;
  tools.shaft_P = {path_P.a - 100.0 * path_P.direction(), path_P.b};
  tools.X_PN = needle_pose(path_P.b, path_P.direction());
  tools.inside_mm = (path_P.b - path_P.a).norm();
  workspace.show_tools(tools);
  workspace.show_tools(tools);
  workspace.draw(3.0);
  EXPECT_EQ(received_.opened, 1);
  EXPECT_EQ(received_.helped, 1);
  EXPECT_EQ(received_.tools, 1) << "the second time nothing has moved";
  EXPECT_TRUE(received_.is_visible_tip_deep);
  EXPECT_EQ(received_.updates, 1);
  EXPECT_EQ(received_.draws, 1);
  EXPECT_EQ(received_.last_s, 3.0);
  workspace.set_tip_hidden(true);
  workspace.show_tools(tools);
  EXPECT_EQ(received_.hidden, 1);
  EXPECT_FALSE(received_.is_visible_tip_deep) << "an exam hides the needle in the body";
}

TEST_F(ViewRegistryTest, StoredLayoutsStayValidWhenAViewIsAdded) {
  {
    Workspace before;
    before.resize(1000, 700);
    before.show();
    before.choose_layout(QStringLiteral("Puncture"));
    before.findChild<QDockWidget*>(QStringLiteral("dock-forces"))->hide();
    QCoreApplication::processEvents();
    before.save_layout();
  }
  Workspace after(with_dummy());
  after.resize(1000, 700);
  after.show();
  EXPECT_FALSE(is_visible(after, "dock-forces")) << "as the person left it";
  EXPECT_TRUE(is_visible(after, "dock-ultrasound"));
  EXPECT_FALSE(is_visible(after, "dock-dummy"));
  QMenu menu;
  after.fill_menu(menu);
  menu.findChild<QAction*>(QStringLiteral("show-dummy"))->trigger();
  EXPECT_TRUE(is_visible(after, "dock-dummy"));
  after.reset_layout();
  EXPECT_TRUE(is_visible(after, "dock-forces"));
  EXPECT_TRUE(is_visible(after, "dock-dummy"));
}

TEST_F(ViewRegistryTest, FindsAWidgetByIdAndType) {
  const Workspace workspace(with_dummy());
  EXPECT_NE(workspace.find<PatientView>("3d"), nullptr);
  EXPECT_NE(workspace.find<PatientView>("3d"), workspace.find<PatientView>("side"));
  EXPECT_EQ(workspace.find<PatientView>("dummy"), nullptr);
  EXPECT_EQ(workspace.find<QLabel>("nothing"), nullptr);
}

TEST(ViewRegistryDeathTest, RefusesADuplicateId) {
  ViewRegistry registry = standard_views();
  EXPECT_DEATH(registry.add(registry.views().front()), "");
}

}  // namespace
}  // namespace trocar::trainer
