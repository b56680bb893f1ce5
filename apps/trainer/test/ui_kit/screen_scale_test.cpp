#include "ui_kit/screen_scale.h"

#include <gtest/gtest.h>

namespace trocar::trainer {
namespace {

TEST(ScreenScale, IsOneOnUsualScreens) {
  for (const QSize size : {QSize(1024, 768), QSize(1280, 800), QSize(1920, 1080), QSize(1920, 1200)})
    EXPECT_EQ(scale_of({size, 96.0, 96.0}), 1.0) << size.width();
}

TEST(ScreenScale, IsTwoOnA4kScreen) {
  EXPECT_EQ(scale_of({{3840, 2160}, 96.0, 96.0}), 2.0);
  EXPECT_EQ(scale_of({{3840, 2160}, 96.0, 1000.0}), 2.0);  // a wrong size of the screen
  EXPECT_EQ(scale_of({{3840, 2160}, 96.0, 0.0}), 2.0);
}

TEST(ScreenScale, FollowsTheDesktopAndTheScreensResolution) {
  EXPECT_EQ(scale_of({{2560, 1600}, 144.0, 96.0}), 1.5);
  EXPECT_EQ(scale_of({{2560, 1600}, 96.0, 191.0}), 2.0);
  EXPECT_EQ(scale_of({{3840, 2160}, 96.0, 280.0}), 2.5);  // of a notebook: 1536x864 at this scale
}

TEST(ScreenScale, LeavesRoomForTheWindow) {
  for (const QSize size : {QSize(1024, 768), QSize(1280, 800), QSize(1920, 1080), QSize(2560, 1440)})
    for (const double dpi : {96.0, 144.0, 192.0, 300.0}) {
      const double scale = scale_of({size, dpi, dpi});
      EXPECT_GE(scale, 1.0);
      if (scale > 1.0) {
        EXPECT_GE(size.width() / scale, kSmallDesign.width());
        EXPECT_GE(size.height() / scale, kSmallDesign.height());
      }
    }
}

}  // namespace
}  // namespace trocar::trainer
