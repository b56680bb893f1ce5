#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "storage/detail/database.h"
#include "storage/session_file.h"
#include "storage/test/example_session.h"

namespace trocar::storage {
namespace {

namespace fs = std::filesystem;

/// Number n of a made-up way, every 10 ms.
TransducerSample example_transducer(std::size_t n) {
  Random random(n + 1000);
  const auto number = [&] { return random.uniform(-100.0, 100.0); };
  const Eigen::Quaterniond q = Eigen::Quaterniond(number(), number(), number(), number()).normalized();
  return {0.01 * static_cast<double>(n), Pose(q.toRotationMatrix(), Vec3(number(), number(), number())),
          std::abs(number())};
}

SessionWriter begin(const fs::path& path) {
  auto writer = SessionWriter::create(path, testing::example_info());
  EXPECT_TRUE(writer) << (writer ? "" : writer.error().text());
  return *std::move(writer);
}

/// A finished session of some ticks and a transducer that moves all the while.
void write_with_transducer(const fs::path& path, std::size_t moments) {
  SessionWriter writer = begin(path);
  for (std::size_t n = 0; n < moments; ++n) {
    ASSERT_TRUE(writer.append(testing::example_sample(10 * n)));
    ASSERT_TRUE(writer.append(example_transducer(n)));
  }
  ASSERT_TRUE(writer.finish(testing::example_outcome(), {}));
}

constexpr double kTolerance = 1e-12;  // a rotation becomes a quaternion and comes back

TEST(SessionTransducer, RoundTripsInOrder) {
  const TemporaryFolder folder;
  write_with_transducer(folder / "s.trocar", 2345);
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  ASSERT_EQ(session->transducer.size(), 2345u);
  for (std::size_t n = 0; n < 2345; ++n) {
    const TransducerSample &is = session->transducer[n], was = example_transducer(n);
    EXPECT_EQ(is.time_s, was.time_s);
    EXPECT_EQ(is.X_PT.p(), was.X_PT.p());
    EXPECT_LT((is.X_PT.R() - was.X_PT.R()).norm(), kTolerance);
    EXPECT_EQ(is.contact_n, was.contact_n);
  }
  EXPECT_EQ(session->samples.size(), 2345u);
}

TEST(SessionTransducer, MovesIndependentlyOfTheNeedle) {
  const TemporaryFolder folder;
  SessionWriter writer = begin(folder / "s.trocar");
  for (std::size_t n = 0; n < 120; ++n) ASSERT_TRUE(writer.append(example_transducer(n)));
  // Seen from outside, as after a crash: at most half a second is missing.
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_GE(session->transducer.size(), 70u);
  EXPECT_TRUE(session->samples.empty());
}

TEST(SessionTransducer, SkipsInvalidOrOutOfOrderPoses) {
  const TemporaryFolder folder;
  {
    SessionWriter writer = begin(folder / "s.trocar");
    TransducerSample broken = example_transducer(3);
    broken.contact_n = std::numeric_limits<double>::quiet_NaN();
    for (const TransducerSample& sample :
         {example_transducer(1), example_transducer(1), example_transducer(0), broken, example_transducer(4)})
      ASSERT_TRUE(writer.append(sample));
    ASSERT_TRUE(writer.finish(testing::example_outcome(), {}));
  }
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  ASSERT_EQ(session->transducer.size(), 2u);
  EXPECT_EQ(session->transducer[1].time_s, example_transducer(4).time_s);
}

TEST(SessionTransducer, OpensOlderSessionsWithoutTransducer) {
  const TemporaryFolder folder;
  write_with_transducer(folder / "s.trocar", 20);
  // What a program of format 1 wrote before there was such a table, nor checksums.
  for (const char* statement : {"DROP TABLE transducer", "DROP TABLE checksums", "DROP TABLE tick_blocks"})
    testing::change(folder / "s.trocar", statement);
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ(session->samples.size(), 20u);
  EXPECT_TRUE(session->transducer.empty());
  EXPECT_TRUE(session->outcome);
}

TEST(SessionTransducer, KeepsTheFormatVersion) {
  const TemporaryFolder folder;
  write_with_transducer(folder / "s.trocar", 2);
  soci::session database;
  detail::open_database(database, folder / "s.trocar");
  EXPECT_EQ(detail::pragma_integer(database, "user_version"), 1);  // older programs still read its ticks
}

TEST(SessionTransducer, RefusesInvalidPoses) {
  for (const char* damage : {"UPDATE transducer SET qw = 0, qx = 0, qy = 0, qz = 0 WHERE time_s > 0.05",
                             "UPDATE transducer SET x_mm = 9e999 WHERE time_s > 0.05",
                             "ALTER TABLE transducer RENAME COLUMN x_mm TO left_mm"}) {
    const TemporaryFolder folder;
    write_with_transducer(folder / "s.trocar", 20);
    testing::change(folder / "s.trocar", damage);
    const auto session = load_session(folder / "s.trocar");
    ASSERT_FALSE(session) << damage;
    EXPECT_EQ(session.error().text().find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace trocar::storage
