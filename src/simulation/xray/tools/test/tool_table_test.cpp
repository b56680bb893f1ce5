#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>

#include "core/files/folders.h"
#include "xray/tools/tool_shape.h"

namespace trocar::xray {
namespace {

ToolKind guide_wire() {
  auto kind = load_tool_kind(data_dir() / "xray_tools.toml", "guide-wire");
  EXPECT_TRUE(kind) << kind.error().text();
  return kind.value_or(ToolKind{});
}

TEST(ToolTable, ListsWireCatheterAndMarker) {
  EXPECT_NEAR(guide_wire().outer_diameter_mm, 0.035 * 25.4, 1e-9);
  const auto catheter = load_tool_kind(data_dir() / "xray_tools.toml", "catheter");
  ASSERT_TRUE(catheter) << catheter.error().text();
  EXPECT_NEAR(catheter->outer_diameter_mm, 8.0 / 3.0, 1e-3);
  EXPECT_GT(catheter->inner_diameter_mm, 0.0);
  EXPECT_TRUE(load_tool_kind(data_dir() / "xray_tools.toml", "marker"));
  const auto unknown = load_tool_kind(data_dir() / "xray_tools.toml", "stent");
  ASSERT_FALSE(unknown);
  EXPECT_NE(unknown.error().text().find("catheter"), std::string::npos);
}

TEST(ToolTable, RefusesABoreAsWideAsTheTool) {
  const TemporaryFolder folder;
  std::ofstream(folder / "x.toml") << "[tools.a]\ntitle = \"a\"\nmaterial = \"steel\"\n"
                                      "outer_diameter_mm = {value = 1.0, source = \"x\"}\n"
                                      "inner_diameter_mm = {value = 1.0, source = \"x\"}\n"
                                      "density_g_per_cm3 = {value = 7.9, source = \"x\"}\n";
  EXPECT_FALSE(load_tool_kinds(folder / "x.toml"));
}

TEST(ToolTable, CurvePassesThroughItsPoints) {
  const std::array points{Vec3(0, 0, 0), Vec3(10, 0, 0), Vec3(10, 10, 0)};
  const ToolShape shape = tool_along(guide_wire(), points);
  for (const Vec3& point : points) {
    double nearest_mm = HUGE_VAL;
    for (const Vec3& p_P : shape.line_P) nearest_mm = std::min(nearest_mm, (p_P - point).norm());
    EXPECT_LT(nearest_mm, 1e-9);
  }
  double length_mm = 0.0;
  for (std::size_t n = 1; n < shape.line_P.size(); ++n) {
    const double piece_mm = (shape.line_P[n] - shape.line_P[n - 1]).norm();
    EXPECT_LT(piece_mm, 3.0);
    length_mm += piece_mm;
  }
  EXPECT_GT(length_mm, 20.0);  // longer than the polygon that it rounds
  EXPECT_LT(length_mm, 23.0);
  const ToolShape straight = tool_along(guide_wire(), std::array{Vec3(1, 2, 3), Vec3(1, 2, 13)});
  for (const Vec3& p_P : straight.line_P) EXPECT_NEAR(std::hypot(p_P.x() - 1.0, p_P.y() - 2.0), 0.0, 1e-12);
}

TEST(ToolTable, TreatsOnePointAsABead) {
  const ToolShape bead = tool_along(guide_wire(), std::array{Vec3(1, 2, 3)});
  ASSERT_EQ(bead.line_P.size(), 2U);
  EXPECT_NEAR((bead.line_P[1] - bead.line_P[0]).norm(), 2.0 * bead.outer_radius_mm, 1e-12);
  EXPECT_EQ(0.5 * (bead.line_P[0] + bead.line_P[1]), Vec3(1, 2, 3));
}

}  // namespace
}  // namespace trocar::xray
