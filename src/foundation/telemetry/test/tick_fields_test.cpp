#include "telemetry/tick_fields.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace trocar::telemetry {
namespace {

// The header itself does not compile where the number of fields differs from the number of descriptions.
TEST(TickFields, DescribeEveryFieldOnce) {
  TickSample sample;
  std::set<const void*> places;
  std::set<std::string> names;
  for_each_tick_field([&](const auto& field) {
    places.insert(&(sample.*field.member));
    names.insert(field.name);
  });
  EXPECT_EQ(places.size(), kTickFieldCount);
  EXPECT_EQ(names.size(), kTickFieldCount);
}

TEST(TickFields, ColumnNamesAreUnique) {
  std::set<std::string> names;
  std::size_t columns = 0;
  for_each_tick_field([&](const auto& field) {
    for (const char* column : field.columns) {
      EXPECT_NE(std::string(column), "") << field.name;
      names.insert(column);
      ++columns;
    }
  });
  EXPECT_EQ(names.size(), columns);
}

TEST(TickFields, ColumnsReachEveryNumberOfAField) {
  TickSample sample;
  double next = 1.0;
  for_each_tick_field([&](const auto& field) {
    for_each_column(sample, field, [&](const char*, auto& value) {
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, double>) value = next++;
    });
  });
  EXPECT_EQ(sample.time_s, 1.0);
  EXPECT_EQ(sample.tip_mm, Vec3(2.0, 3.0, 4.0));
  EXPECT_EQ(sample.axis, Vec3(5.0, 6.0, 7.0));
  const Vec3 last(next - 3.0, next - 2.0, next - 1.0);
  EXPECT_EQ(sample.contact_to_puncture_mm, last);
  EXPECT_EQ(sample.device_rotation_wxyz, (Quaternion{next - 7.0, next - 6.0, next - 5.0, next - 4.0}));
}

}  // namespace
}  // namespace trocar::telemetry
