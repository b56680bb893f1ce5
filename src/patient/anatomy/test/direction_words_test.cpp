#include <gtest/gtest.h>

#include "anatomy/structure_words.h"

namespace trocar::anatomy {
namespace {

TEST(DirectionWords, NameTheTwoLargestDirectionsOfThePatient) {
  EXPECT_EQ(direction_words({0.0, 0.0, 6.0}, " mm"), "6 mm towards the head");
  EXPECT_EQ(direction_words({-3.0, 0.2, -4.0}, " mm"), "4 mm towards the feet and 3 mm to the patient's right");
  EXPECT_EQ(direction_words({5.0, -1.0, 0.0}, "°"), "5° to the patient's left");
  EXPECT_EQ(direction_words({0.0, 8.0, 0.0}, " mm"), "8 mm towards the back");
}

TEST(DirectionWords, NameADirectionWithoutALength) {
  EXPECT_EQ(direction_words({0.02, 0.03, -0.001}), "towards the back and to the patient's left");
  EXPECT_EQ(direction_words({0.0, -1.0, 0.1}), "towards the front");
}

}  // namespace
}  // namespace trocar::anatomy
