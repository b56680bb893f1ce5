#include <gtest/gtest.h>

#include <numbers>

#include "cases/scene_request.h"
#include "core/files/folders.h"

namespace trocar::cases {
namespace {

TEST(NeedleGeometryOfNeedle, HalvesDiametersAndTurnsDegreesIntoRadians) {
  tasks::Needle needle;
  needle.outer_diameter_mm = 1.2;
  needle.inner_diameter_mm = 0.8;
  needle.stylet_diameter_mm = 0.7;
  needle.length_mm = 90.0;
  needle.bevel_deg = 30.0;
  needle.bevel_share = 0.25;
  const haptics::NeedleGeometry geometry = needle_geometry(needle);
  EXPECT_DOUBLE_EQ(geometry.radius_mm, 0.6);
  EXPECT_DOUBLE_EQ(geometry.inner_radius_mm, 0.4);
  EXPECT_DOUBLE_EQ(geometry.stylet_radius_mm, 0.35);
  EXPECT_DOUBLE_EQ(geometry.length_mm, 90.0);
  EXPECT_DOUBLE_EQ(geometry.bevel_rad, std::numbers::pi / 6.0);
  EXPECT_DOUBLE_EQ(geometry.bevel_share, 0.25);
}

TEST(NeedleGeometryOfNeedle, EveryListedNeedleIsATubeThatFitsItsStylet) {
  const auto needles = tasks::load_needles(data_dir() / "needles.toml");
  ASSERT_TRUE(needles) << needles.error().text();
  for (const tasks::Needle& needle : *needles) {
    const haptics::NeedleGeometry geometry = needle_geometry(needle);
    EXPECT_GT(geometry.inner_radius_mm, 0.0) << needle.name;
    EXPECT_LE(geometry.inner_radius_mm, 0.95 * geometry.radius_mm) << needle.name;
    EXPECT_LE(geometry.stylet_radius_mm, geometry.inner_radius_mm) << needle.name;
  }
}

}  // namespace
}  // namespace trocar::cases
