#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <utility>

#include "storage/detail/database.h"
#include "storage/session_file.h"
#include "storage/test/example_session.h"

namespace trocar::storage {
namespace {

namespace fs = std::filesystem;
using testing::example_info;
using testing::example_outcome;
using testing::example_sample;

/// A writer that neither checkpoints nor syncs.
void open_writer(soci::session& database, const fs::path& file) {
  detail::open_database(database, file);
  ASSERT_TRUE(database::set_journal(database, file, {}).is_write_ahead);
  database << "PRAGMA wal_autocheckpoint = 0";
  database << "PRAGMA synchronous = OFF";
  database << "CREATE TABLE rows (text TEXT)";
}

TEST(WalCheckpointer, CheckpointsALogDuringWritesSoThatItRestarts) {
  const TemporaryFolder folder;
  const fs::path file = folder / "s.trocar";
  const fs::path log = file.string() + "-wal";
  soci::session database;
  open_writer(database, file);
  const auto add_rows = [&] {
    const std::string text(100'000, 'x');
    for (int n = 0; n < 20; ++n) database << "INSERT INTO rows VALUES (:t)", soci::use(text);
  };
  add_rows();
  detail::WalCheckpointer checkpointer;
  ASSERT_TRUE(checkpointer.start(file, std::chrono::milliseconds(1)));
  auto largest = fs::file_size(log);
  EXPECT_GT(largest, 2'000'000u);
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(2);
  int rounds = 1;
  bool has_started_again = false;
  while (!has_started_again && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    add_rows();
    ++rounds;
    has_started_again = fs::file_size(log) == std::exchange(largest, fs::file_size(log));
  }
  EXPECT_TRUE(has_started_again) << largest << " bytes after " << rounds << " rounds";
  checkpointer.stop();
  int rows = 0;
  database << "SELECT count(*) FROM rows", soci::into(rows);
  EXPECT_EQ(rows, 20 * rounds);
}

TEST(WalCheckpointer, DoesNotStartWithoutASession) {
  const TemporaryFolder folder;
  detail::WalCheckpointer checkpointer;
  EXPECT_FALSE(checkpointer.start(folder / "missing" / "s.trocar"));
}

TEST(WalCheckpointer, SessionEndsAsOneFile) {
  const TemporaryFolder folder;
  for (const bool is_finished : {true, false}) {
    const fs::path file = folder / (is_finished ? "finished.trocar" : "left.trocar");
    {
      auto writer = SessionWriter::create(file, example_info());
      ASSERT_TRUE(writer);
      for (std::size_t n = 0; n < 1234; ++n) ASSERT_TRUE(writer->append(example_sample(n)));
      if (is_finished) {
        ASSERT_TRUE(writer->finish(example_outcome(), {}));
      }
    }
    EXPECT_FALSE(fs::exists(file.string() + "-wal"));
    const auto session = load_session(file);
    ASSERT_TRUE(session) << session.error().text();
    EXPECT_EQ(session->samples.size(), 1234u);
  }
}

}  // namespace
}  // namespace trocar::storage
