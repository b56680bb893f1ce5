#include "ultrasound/measurements.h"

#include <gtest/gtest.h>

namespace trocar {
namespace {

DistanceCaliper distance(double mm) {
  return {{0.0, 10.0}, {0.0, 10.0 + mm}};
}

TEST(Measurements, UndoAndRedoWalkThroughWhatWasDone) {
  Measurements list;
  EXPECT_FALSE(list.can_undo());
  list.undo();
  list.redo();
  list.remove_last();
  EXPECT_FALSE(list.can_undo()) << "nothing was done";
  list.add(distance(10));
  list.add(distance(20));
  list.remove_last();
  ASSERT_EQ(list.items().size(), 1U);
  list.undo();
  ASSERT_EQ(list.items().size(), 2U);
  EXPECT_DOUBLE_EQ(std::get<DistanceCaliper>(list.items()[1]).distance_mm(), 20.0);
  list.clear();
  EXPECT_TRUE(list.items().empty());
  list.undo();
  EXPECT_EQ(list.items().size(), 2U);
  EXPECT_TRUE(list.can_redo());
  list.undo();
  list.add(distance(30));
  EXPECT_FALSE(list.can_redo()) << "another future";
  EXPECT_DOUBLE_EQ(std::get<DistanceCaliper>(list.items()[1]).distance_mm(), 30.0);
}

TEST(Measurements, ForgetTheOldestStepsAlone) {
  Measurements list;
  for (int n = 0; n < 300; ++n) list.add(distance(n));
  EXPECT_EQ(list.items().size(), 300U);
  int steps = 0;
  for (; list.can_undo(); ++steps) list.undo();
  EXPECT_EQ(steps, 99);
}

TEST(Measurements, ResultsHaveUnits) {
  EXPECT_EQ(results(distance(23.44)), std::vector<std::string>{"Dist 23.4 mm"});
  const EllipseCaliper circle{{-10.0, 50.0}, {10.0, 50.0}, 10.0};
  EXPECT_EQ(results(circle), (std::vector<std::string>{"Ell 20.0 x 20.0 mm", "Area 3.14 cm²", "Circ 62.8 mm"}));
  EXPECT_EQ(results(AngleCaliper{{0, 0}, {10, 0}, {0, 10}}), std::vector<std::string>{"Angle 90.0°"});
}

}  // namespace
}  // namespace trocar
