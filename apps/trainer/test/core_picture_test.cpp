#include "panels/core_picture.h"

#include <gtest/gtest.h>

#include <QImage>

#include "test/widget_actions.h"

namespace trocar::trainer {
namespace {

/// Share of the bar's middle row in a part's colour.
double share_of(CorePicture& picture, scoring::CorePart part) {
  const QImage image = picture.grab().toImage();
  const int y = picture.fontMetrics().height() / 2;
  int count = 0;
  for (int x = 0; x < image.width(); ++x)
    if (image.pixelColor(x, y) == CorePicture::color_of(part)) ++count;
  return static_cast<double>(count) / image.width();
}

TEST(CorePicture, ShowsEachPartToScale) {
  attempt::GunShot shot;
  shot.depth_mm = 60.0;
  shot.pieces = {{scoring::CorePart::kOrgan, "liver", 0.0, 4.0},
                 {scoring::CorePart::kTarget, "liver_lesion", 4.0, 14.0},
                 {scoring::CorePart::kVessel, "portal_vein", 14.0, 16.0}};
  CorePicture picture;
  picture.set_shots({&shot, 1});
  picture.resize(320, picture.sizeHint().height());
  picture.show();
  EXPECT_NEAR(share_of(picture, scoring::CorePart::kOrgan), 4.0 / 16.0, 0.02);
  EXPECT_NEAR(share_of(picture, scoring::CorePart::kTarget), 10.0 / 16.0, 0.02);
  EXPECT_NEAR(share_of(picture, scoring::CorePart::kVessel), 2.0 / 16.0, 0.02);
  EXPECT_EQ(share_of(picture, scoring::CorePart::kOther), 0.0);
  EXPECT_TRUE(picture.accessibleName().contains(QStringLiteral("10.0 mm target tissue")));
  save(picture, "core_picture.png");
}

TEST(CorePicture, ReportsAnEmptyNotch) {
  CorePicture picture;
  const attempt::GunShot empty;
  picture.set_shots({&empty, 1});
  picture.resize(200, picture.sizeHint().height());
  picture.show();
  EXPECT_EQ(share_of(picture, scoring::CorePart::kTarget), 0.0);
  EXPECT_TRUE(picture.accessibleName().contains(QStringLiteral("No tissue")));
}

}  // namespace
}  // namespace trocar::trainer
