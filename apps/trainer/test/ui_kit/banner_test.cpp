#include "ui_kit/banner.h"

#include <gtest/gtest.h>

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QComboBox>
#include <QCoreApplication>
#include <QElapsedTimer>
#include <QPushButton>
#include <QVBoxLayout>

#include "pages/start_page.h"
#include "test/widget_actions.h"
#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

/// A start page in a window with a banner over it.
struct BannerTest : ::testing::Test {
  BannerTest() {
    auto* column = new QVBoxLayout(&window);
    column->setContentsMargins(0, 0, 0, 0);
    page = new StartPage;
    column->addWidget(page);
    banner = new Banner(window);
    window.resize(1024, 700);
    window.show();
    QCoreApplication::processEvents();
  }
  QRect place_of(const QWidget& widget) const { return {widget.mapTo(&window, QPoint(0, 0)), widget.size()}; }
  bool has_color(const QColor& color) const { return banner->styleSheet().contains(color.name()); }

  QWidget window;
  StartPage* page = nullptr;
  Banner* banner = nullptr;
};

TEST_F(BannerTest, OverlaysThePageWithoutCoveringControls) {
  const QRect page_before = page->geometry();
  auto& start = *page->findChild<QPushButton*>(QStringLiteral("start"));
  const QRect start_before = place_of(start);
  for (const QSize& size : {QSize(1024, 700), QSize(1280, 760), QSize(1920, 1000)}) {
    window.resize(size);
    banner->set_state(QStringLiteral("The disk is almost full: 64 MB are free in /home/trainee/.local/state/trocar/"
                                     "sessions, enough to record 5 minutes."),
                      BannerKind::kWarning);
    QCoreApplication::processEvents();
    ASSERT_TRUE(banner->isVisible());
    EXPECT_TRUE(window.rect().contains(banner->geometry()));
    for (const QWidget* control : window.findChildren<QWidget*>()) {
      const bool is_control = qobject_cast<const QAbstractButton*>(control) != nullptr ||
                              qobject_cast<const QComboBox*>(control) != nullptr ||
                              qobject_cast<const QAbstractItemView*>(control) != nullptr;
      if (!is_control || !control->isVisible()) continue;
      EXPECT_FALSE(place_of(*control).intersects(banner->geometry()))
          << control->objectName().toStdString() << " at " << size.width();
    }
  }
  window.resize(1024, 700);
  QCoreApplication::processEvents();
  EXPECT_EQ(page->geometry(), page_before);
  EXPECT_EQ(place_of(start), start_before);
  save(window, "banner.png");
}

TEST_F(BannerTest, LetsClicksThrough) {
  banner->set_state(QStringLiteral("Forces are stopped."), BannerKind::kWarning);
  QCoreApplication::processEvents();
  EXPECT_NE(window.childAt(banner->geometry().center()), banner);
}

TEST_F(BannerTest, SuccessMessageIsGreenAndExpires) {
  banner->set_state(QStringLiteral("The disk is almost full."), BannerKind::kWarning);
  EXPECT_TRUE(has_color(theme().warning));
  banner->show_message(QStringLiteral("The report is in /tmp/report.html"), BannerKind::kSuccess);
  EXPECT_TRUE(has_color(theme().good));
  banner->set_state(QStringLiteral("The disk is almost full."), BannerKind::kWarning);  // as each frame does
  EXPECT_TRUE(banner->text().startsWith(QStringLiteral("The report")));
  QElapsedTimer clock;
  clock.start();
  while (banner->text().startsWith(QStringLiteral("The report")) && clock.elapsed() < 2 * Banner::kMessage_ms)
    QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents);
  EXPECT_EQ(banner->text(), QStringLiteral("The disk is almost full."));
  banner->show_message(QStringLiteral("The report is in /tmp/report.html"), BannerKind::kSuccess);
  banner->set_state(QStringLiteral("The server of the needle was killed."), BannerKind::kError);
  EXPECT_TRUE(has_color(theme().bad)) << "what is wrong is not hidden by a success";
  banner->set_state({}, BannerKind::kWarning);
  EXPECT_TRUE(banner->isHidden());
}

}  // namespace
}  // namespace trocar::trainer
