#include <gtest/gtest.h>

#include <limits>

#include "storage/detail/database.h"
#include "storage/session_file.h"
#include "storage/test/example_session.h"

namespace trocar::storage {
namespace {

namespace fs = std::filesystem;

tasks::XrayUse example_use(std::size_t n) {
  const auto x = static_cast<double>(n);
  return {0.1 * x, 20.0 - x, 5.0, Vec3(-30.0, 0.1 * x, 12.0), 220.0, n % 2 == 1, 0.5 * x, x, 2.0 * x, 0.25 * x};
}

void write_with_xray(const fs::path& path, const std::vector<tasks::XrayUse>& uses) {
  auto writer = SessionWriter::create(path, testing::example_info());
  ASSERT_TRUE(writer) << writer.error().text();
  for (std::size_t n = 0; n < 50; ++n) ASSERT_TRUE(writer->append(testing::example_sample(10 * n)));
  for (const tasks::XrayUse& use : uses) ASSERT_TRUE(writer->append(use));
  ASSERT_TRUE(writer->finish(testing::example_outcome(), {}));
}

TEST(SessionXray, RoundTripsInOrder) {
  const TemporaryFolder folder;
  const std::vector<tasks::XrayUse> uses{example_use(0), example_use(1), example_use(2)};
  write_with_xray(folder / "s.trocar", uses);
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ(session->xray, uses);
}

TEST(SessionXray, SkipsOutOfOrderOrNonFiniteSamples) {
  const TemporaryFolder folder;
  tasks::XrayUse broken = example_use(2);
  broken.air_kerma_mgy = std::numeric_limits<double>::quiet_NaN();
  write_with_xray(folder / "s.trocar", {example_use(1), example_use(0), broken, example_use(3)});
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ(session->xray, (std::vector<tasks::XrayUse>{example_use(1), example_use(3)}));
}

TEST(SessionXray, IsOptionalInOldSessionsAndCheckedForChanges) {
  const TemporaryFolder folder;
  for (const char* statement : {"DROP TABLE xray", "UPDATE xray SET beam_s = -1"}) {
    const fs::path path = folder / (statement[0] == 'D' ? "old.trocar" : "changed.trocar");
    write_with_xray(path, {example_use(1)});
    {
      soci::session database;
      detail::open_database(database, path);
      if (statement[0] == 'D') database << "DELETE FROM checksums WHERE name = 'xray'";
      database << statement;
    }
    const auto session = load_session(path);
    if (statement[0] == 'D') {
      ASSERT_TRUE(session) << session.error().text();
      EXPECT_TRUE(session->xray.empty());
    } else {
      ASSERT_FALSE(session);
      EXPECT_NE(session.error().text().find("use of the X-ray"), std::string::npos) << session.error().text();
    }
  }
}

}  // namespace
}  // namespace trocar::storage
