#include <gtest/gtest.h>

#include "anatomy/patient.h"

namespace trocar::anatomy {
namespace {

TEST(LabelTable, FindsByIdAndByName) {
  LabelTable table;
  table.labels = {{2, "liver", "liver", {1, 2, 3}}, {7, "fat", "adipose", {4, 5, 6}}};
  ASSERT_NE(table.find(std::uint8_t{7}), nullptr);
  EXPECT_EQ(table.find(std::uint8_t{7})->name, "fat");
  ASSERT_NE(table.find("liver"), nullptr);
  EXPECT_EQ(table.find("liver")->id, 2);
  for (const int absent : {0, 1, 3, 8, 255}) EXPECT_EQ(table.find(static_cast<std::uint8_t>(absent)), nullptr);
  EXPECT_EQ(table.find("Liver"), nullptr);
}

TEST(LabelTable, FindsTheOrganOfEachLesion) {
  LabelTable table;
  table.labels = {{2, "livertumor1", "liver_lesion", {}},
                  {5, "liver", "liver", {}},
                  {6, "liver_segment_2", "liver", {}},
                  {7, "lung_tumour", "lung_lesion", {}}};
  const auto shown = lesions_as_organs(table);
  EXPECT_EQ(shown[2], 5);
  EXPECT_EQ(shown[7], 0);
  for (const std::size_t id : {0U, 1U, 5U, 6U, 255U}) EXPECT_EQ(shown[id], id);
}

}  // namespace
}  // namespace trocar::anatomy
