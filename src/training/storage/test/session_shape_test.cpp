#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "storage/session_file.h"
#include "storage/test/example_session.h"

namespace trocar::storage {
namespace {

namespace fs = std::filesystem;

telemetry::NeedleShape example_shape(std::size_t n) {
  Random random(n + 5000);
  telemetry::NeedleShape shape;
  shape.time_s = 0.01 * static_cast<double>(n);
  shape.spans = static_cast<std::uint8_t>(n % (telemetry::NeedleShape::kMostSpans + 1));
  for (std::size_t i = 0; i < shape.spans; ++i)
    for (float& mm : shape.beside_mm[i]) mm = static_cast<float>(random.uniform(-60.0, 60.0));
  return shape;
}

void write_with_shapes(const fs::path& path, std::size_t shapes) {
  auto writer = SessionWriter::create(path, testing::example_info());
  ASSERT_TRUE(writer) << writer.error().text();
  for (std::size_t n = 0; n < shapes; ++n) {
    ASSERT_TRUE(writer->append(testing::example_sample(10 * n)));
    ASSERT_TRUE(writer->append(example_shape(n)));
  }
  ASSERT_TRUE(writer->finish(testing::example_outcome(), {}));
}

TEST(SessionShape, RoundTripsToTheMicrometre) {
  const TemporaryFolder folder;
  write_with_shapes(folder / "s.trocar", 2345);
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  ASSERT_EQ(session->shapes.size(), 2345u);
  for (std::size_t n = 0; n < 2345; ++n) {
    EXPECT_EQ(session->shapes[n].time_s, example_shape(n).time_s);
    EXPECT_EQ(session->shapes[n].spans, example_shape(n).spans);
    EXPECT_LT(telemetry::largest_difference_mm(session->shapes[n], example_shape(n)), 0.00075);
  }
}

TEST(SessionShape, SkipsInvalidOrOutOfOrderShapes) {
  const TemporaryFolder folder;
  {
    auto writer = SessionWriter::create(folder / "s.trocar", testing::example_info());
    ASSERT_TRUE(writer);
    telemetry::NeedleShape broken = example_shape(3), endless = example_shape(3);
    broken.beside_mm[1][0] = std::numeric_limits<float>::quiet_NaN();
    endless.spans = 200;
    for (const telemetry::NeedleShape& shape :
         {example_shape(2), example_shape(2), example_shape(1), broken, endless, example_shape(4)})
      ASSERT_TRUE(writer->append(shape));
    ASSERT_TRUE(writer->finish(testing::example_outcome(), {}));
  }
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  ASSERT_EQ(session->shapes.size(), 2u);
  EXPECT_EQ(session->shapes[1].time_s, example_shape(4).time_s);
}

TEST(SessionShape, OpensOlderSessionsWithoutShapes) {
  const TemporaryFolder folder;
  write_with_shapes(folder / "s.trocar", 20);
  for (const char* statement : {"DROP TABLE needle_shape", "DELETE FROM checksums WHERE name = 'needle_shape'"})
    testing::change(folder / "s.trocar", statement);
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ(session->samples.size(), 20u);
  EXPECT_TRUE(session->shapes.empty());
}

TEST(SessionShape, ReportsInvalidShapesAsDamage) {
  for (const char* damage : {"UPDATE needle_shape SET beside_um = '1 2 3' WHERE time_s > 0.05",
                             "UPDATE needle_shape SET beside_um = '1 x' WHERE time_s > 0.05",
                             "UPDATE needle_shape SET beside_um = '1 99999999999' WHERE time_s > 0.05",
                             "UPDATE needle_shape SET beside_um = beside_um || hex(zeroblob(9000000))",
                             "UPDATE needle_shape SET beside_um = '1 2' WHERE time_s > 0.05",
                             "DELETE FROM needle_shape WHERE time_s > 0.05", "DROP TABLE needle_shape"}) {
    const TemporaryFolder folder;
    write_with_shapes(folder / "s.trocar", 20);
    testing::change(folder / "s.trocar", damage);
    const auto session = load_session(folder / "s.trocar");
    ASSERT_FALSE(session) << damage;
    EXPECT_NE(session.error().text().find("shapes of the needle"), std::string::npos) << session.error().text();
    const auto saved = salvage_session(folder / "s.trocar");
    ASSERT_TRUE(saved) << saved.error().text();
    EXPECT_TRUE(saved->shapes.empty());
    EXPECT_EQ(saved->samples.size(), 20u);
  }
}

}  // namespace
}  // namespace trocar::storage
