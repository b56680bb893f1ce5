#include "ultrasound/probe/probe_view.h"

#include <gtest/gtest.h>

#include <fstream>
#include <numbers>

#include "core/files/folders.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::ultrasound {
namespace {

/// What loading a file of this text says.
Result<std::vector<ProbeView>> load(const std::string& text) {
  const auto path = std::filesystem::path(::testing::TempDir()) / "views.toml";
  std::ofstream(path) << text;
  return load_probe_views(path);
}

const std::string kRow = "[views.x]\ntitle = \"X\"\ntargets = [\"liver\"]\ntransducer = \"C5-2\"\n";

TEST(ProbeViews, ShippedRowsLoadAndNameKnownTransducers) {
  const auto views = load_probe_views(data_dir() / "views.toml");
  ASSERT_TRUE(views.has_value()) << views.error().text();
  EXPECT_GE(views->size(), 10U);
  for (const ProbeView& view : *views) {
    EXPECT_NEAR(view.direction_P.norm(), 1.0, 1e-12) << view.name;
    EXPECT_TRUE(load_transducer(data_dir() / "transducers.toml", view.transducer).has_value()) << view.name;
  }
}

TEST(ProbeViews, KeysReachTheirFields) {
  const auto views = load(kRow +
                          "direction = [0, 0.6, -0.8]\nplane = \"transverse\"\nangle_deg = -90\nbone = \"beside\"\n"
                          "through = [\"liver\", \"spleen\"]\npoint = \"facing\"\noffset_mm = [1, 2, 3]\n"
                          "pressed_mm = 7\nsearch_mm = 11\ndepth_mm = 99\n");
  ASSERT_TRUE(views.has_value()) << views.error().text();
  const ProbeView& view = views->front();
  EXPECT_EQ(view.name, "x");
  EXPECT_LT((view.direction_P - Vec3(0, 0.6, -0.8)).norm(), 1e-12);
  EXPECT_EQ(view.plane, ScanPlane::kTransverse);
  EXPECT_NEAR(view.angle_rad, -0.5 * std::numbers::pi, 1e-12);
  EXPECT_EQ(view.bone, BonePreference::kBeside);
  EXPECT_EQ(view.through.size(), 2U);
  EXPECT_EQ(view.point, TargetPoint::kFacing);
  EXPECT_EQ(view.offset_mm, Vec3(1, 2, 3));
  EXPECT_EQ(view.pressed_mm, 7.0);
  EXPECT_EQ(view.search_mm, 11.0);
  EXPECT_EQ(view.depth_mm, 99.0);
}

TEST(ProbeViews, RefuseInvalidRows) {
  EXPECT_TRUE(load(kRow).has_value());
  for (const char* line : {"direction = [0, 0, 0]", "direction = [0, 1]", "plane = \"axial\"", "bone = \"maybe\"",
                           "point = \"facing\"", "pressed_mm = 40", "depth_mm = 5", "presed_mm = 4"})
    EXPECT_FALSE(load(kRow + line + "\n").has_value()) << line;
  EXPECT_FALSE(load("[views.x]\ntitle = \"X\"\ntargets = []\ntransducer = \"C5-2\"\n").has_value());
  EXPECT_FALSE(load("[views.x]\ntitle = \"X\"\ntargets = [\"liver\"]\n").has_value());
}

}  // namespace
}  // namespace trocar::ultrasound
