#include "pages/briefing_page.h"

#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QLabel>
#include <QPushButton>

#include "script/widget_events.h"
#include "shell/theme.h"
#include "views/briefing_picture.h"

namespace trocar::trainer {
namespace {

/// The embedded patient's liver biopsy, opened once for all.
const OpenCase& open_abdomen() {
  static const std::shared_ptr<const OpenCase> open = [] {
    auto result = make_open_case({});
    return result ? *result : nullptr;
  }();
  return *open;
}

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
  page.show_case(open_abdomen(), Difficulty::kGuided);
  EXPECT_TRUE(page.findChild<QPushButton*>(QStringLiteral("begin"))->isEnabled());
}

TEST(BriefingPicture, ShowsThePathInGuidedAttemptsAlone) {
  const QSize size(400, 300);
  const auto share_of_path = [&](bool has_path) {
    return share_near(briefing_picture(open_abdomen(), BriefingPlane::kAlongPath, size, has_path), theme().path, 12);
  };
  EXPECT_GT(share_of_path(true), 0.001);
  EXPECT_LT(share_of_path(false), 0.0001);
}

}  // namespace
}  // namespace trocar::trainer
