#include <gtest/gtest.h>

#include "storage/detail/database.h"
#include "storage/session_file.h"
#include "storage/test/example_session.h"

namespace trocar::storage {
namespace {

namespace fs = std::filesystem;

const std::vector<tasks::Action> kActions{
    {0.1, tasks::ActionKind::kAnaesthetise, 5.0, {}, Vec3(1.0, 2.0, 3.0), 0.5},
    {0.2, tasks::ActionKind::kDrawStylet, 0.0, {tasks::Substance::kCsf, 0.75}, Vec3(1.0, 40.0, 3.0), 40.25}};

void write_with_actions(const fs::path& path) {
  auto writer = SessionWriter::create(path, testing::example_info());
  ASSERT_TRUE(writer) << writer.error().text();
  for (std::size_t n = 0; n < 50; ++n) ASSERT_TRUE(writer->append(testing::example_sample(10 * n)));
  for (const tasks::Action& action : kActions) ASSERT_TRUE(writer->append(action));
  ASSERT_TRUE(writer->finish(testing::example_outcome(), {}));
}

TEST(SessionActions, RoundTrip) {
  const TemporaryFolder folder;
  write_with_actions(folder / "s.trocar");
  const auto session = load_session(folder / "s.trocar");
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_EQ(session->actions, kActions);
}

TEST(SessionActions, AreOptionalInOldSessionsAndCheckedForChanges) {
  const TemporaryFolder folder;
  for (const char* statement :
       {"DROP TABLE actions", "UPDATE actions SET kind = 99", "UPDATE actions SET share = 0.5"}) {
    const bool is_old = statement[0] == 'D';
    const fs::path path = folder / (std::string(statement + 15) + ".trocar");
    write_with_actions(path);
    {
      soci::session database;
      detail::open_database(database, path);
      if (is_old) database << "DELETE FROM checksums WHERE name = 'actions'";
      database << statement;
    }
    const auto session = load_session(path);
    if (is_old) {
      ASSERT_TRUE(session) << session.error().text();
      EXPECT_TRUE(session->actions.empty());
    } else {
      ASSERT_FALSE(session) << statement;
      EXPECT_NE(session.error().text().find("actions of the trainee"), std::string::npos) << session.error().text();
    }
  }
}

TEST(SessionActions, RestoreShotsOfAKilledSession) {
  const TemporaryFolder folder;
  const fs::path path = folder / "killed.trocar";
  std::vector<double> times_s;
  {
    auto writer = SessionWriter::create(path, testing::example_info());
    ASSERT_TRUE(writer) << writer.error().text();
    for (std::size_t n = 0; n < 2000; ++n) {
      telemetry::TickSample sample = testing::example_sample(n);
      sample.time_s = 0.001 * static_cast<double>(n);
      times_s.push_back(sample.time_s);
      ASSERT_TRUE(writer->append(sample));
      const auto kind = n == 300   ? std::optional(tasks::ActionKind::kFire)
                        : n == 400 ? std::optional(tasks::ActionKind::kLoad)
                        : n == 700 ? std::optional(tasks::ActionKind::kFire)
                                   : std::nullopt;
      if (kind) {
        ASSERT_TRUE(writer->append(tasks::Action{sample.time_s, *kind, 0.0, {}, Vec3::Zero(), 10.0}));
      }
    }
  }
  const auto session = load_session(path);
  ASSERT_TRUE(session) << session.error().text();
  EXPECT_TRUE(session->is_incomplete);
  EXPECT_EQ(session->shots, (std::vector<std::size_t>{300, 700}));
}

}  // namespace
}  // namespace trocar::storage
