#include "report/svg_plot.h"

#include <gtest/gtest.h>

#include "report/test/count_of.h"

namespace trocar::report {
namespace {

Plot two_curves() {
  Plot plot;
  plot.description = "a < b";
  plot.x_title = "depth (mm)";
  plot.y_title = "force (N)";
  plot.bands = {{0.0, 2.0, "skin", "t-skin"}, {2.0, 9.0, "fat & fascia", "t-adipose"}};
  plot.series = {{"first", "c-total", {{0.0, 0.0}, {5.0, 2.0}}}, {"second", "c-second", {{0.0, 1.0}, {9.0, 1.0}}}};
  return plot;
}

TEST(SvgFile, IsSelfContained) {
  const std::string file = to_svg_file(two_curves(), "Forces <1>");
  EXPECT_TRUE(file.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" width="));
  EXPECT_TRUE(file.ends_with("</svg>\n"));
  EXPECT_EQ(testing::count_of(file, "<svg"), 1U);
  EXPECT_NE(file.find(".c-second {"), std::string::npos);  // its own style ...
  EXPECT_EQ(file.find("var(--"), std::string::npos);       // ... in words that every program knows
  EXPECT_NE(file.find("Forces &lt;1&gt;"), std::string::npos);
  EXPECT_NE(file.find("fat &amp; fascia"), std::string::npos);
  EXPECT_EQ(file.find("a < b"), std::string::npos);
}

TEST(SvgFile, MatchesThePlotInThePage) {
  const std::string in_page = to_svg(two_curves());
  const std::string file = to_svg_file(two_curves(), "");
  const auto from = in_page.find('>') + 1;
  const std::string elements = in_page.substr(from, in_page.rfind("</svg>") - from);
  EXPECT_GT(elements.size(), 100U);
  EXPECT_NE(file.find(elements), std::string::npos);
}

}  // namespace
}  // namespace trocar::report
