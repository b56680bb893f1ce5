#include "ultrasound/scanner/measurements.h"

#include <gtest/gtest.h>

namespace trocar::ultrasound {
namespace {

DistanceCaliper distance(double mm) {
  return {{0.0, 10.0}, {0.0, 10.0 + mm}};
}

TEST(Measurements, UndoAndRedoStepThroughEdits) {
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

TEST(Measurements, DropOnlyTheOldestSteps) {
  Measurements list;
  for (int n = 0; n < 300; ++n) list.add(distance(n));
  EXPECT_EQ(list.items().size(), 300U);
  int steps = 0;
  for (; list.can_undo(); ++steps) list.undo();
  EXPECT_EQ(steps, 99);
}

TEST(Measurements, MovedMarkKeepsItsNewPosition) {
  const std::vector<Measurement> all = {distance(20.0), EllipseCaliper{{-10.0, 50.0}, {10.0, 52.0}, 6.0},
                                        AngleCaliper{{0, 0}, {10, 0}, {0, 10}}};
  for (const Measurement& measurement : all) {
    const std::size_t count = marks_T(measurement).size();
    for (std::size_t mark = 0; mark < count; ++mark) {
      EXPECT_EQ(marks_T(with_mark(measurement, mark, marks_T(measurement)[mark])).size(), count);
      const Vec2 to_T(3.0, 71.0);
      const Measurement moved = with_mark(measurement, mark, to_T);
      if (const auto* ellipse = std::get_if<EllipseCaliper>(&moved); ellipse != nullptr && mark == 2) {
        EXPECT_NEAR(ellipse->half_width_mm, ellipse->distance_to_axis_mm(to_T), 1e-12);
      } else {
        EXPECT_EQ(marks_T(moved)[mark], to_T);
      }
      for (std::size_t other = 0; other < 2; ++other) {
        if (other == mark) continue;
        EXPECT_EQ(marks_T(moved)[other], marks_T(measurement)[other]);
      }
    }
  }
  const EllipseCaliper lying{{-10.0, 50.0}, {10.0, 50.0}, 6.0};
  EXPECT_NEAR((marks_T(lying)[2] - Vec2(0.0, 56.0)).norm(), 0.0, 1e-12);
}

TEST(Measurements, DragIsOneStepAndAnyItemCanBeRemoved) {
  Measurements list;
  list.add(distance(10));
  list.add(distance(20));
  for (int n = 0; n < 5; ++n) list.put(0, distance(30 + n), n > 0);
  EXPECT_DOUBLE_EQ(std::get<DistanceCaliper>(list.items()[0]).distance_mm(), 34.0);
  list.undo();
  EXPECT_DOUBLE_EQ(std::get<DistanceCaliper>(list.items()[0]).distance_mm(), 10.0);
  list.redo();
  list.remove(0);
  ASSERT_EQ(list.items().size(), 1U);
  EXPECT_DOUBLE_EQ(std::get<DistanceCaliper>(list.items()[0]).distance_mm(), 20.0);
  list.remove(7);
  list.put(7, distance(1), false);
  EXPECT_EQ(list.items().size(), 1U);
}

TEST(Measurements, ResultsHaveUnits) {
  EXPECT_EQ(results(distance(23.44)), std::vector<std::string>{"Dist 23.4 mm"});
  const EllipseCaliper circle{{-10.0, 50.0}, {10.0, 50.0}, 10.0};
  EXPECT_EQ(results(circle), (std::vector<std::string>{"Ell 20.0 x 20.0 mm", "Area 3.14 cm²", "Circ 62.8 mm"}));
  EXPECT_EQ(results(AngleCaliper{{0, 0}, {10, 0}, {0, 10}}), std::vector<std::string>{"Angle 90.0°"});
}

}  // namespace
}  // namespace trocar::ultrasound
