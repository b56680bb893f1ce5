#include "storage/detail/wal_checkpointer.h"

#include <condition_variable>
#include <memory>
#include <mutex>

#include "core/live/live_thread.h"
#include "core/start_thread.h"
#include "storage/detail/database.h"

namespace trocar::storage::detail {
namespace {

constexpr int kNice = 5;

/// The writer starts the log again from its beginning if all of it was copied. What was committed during a checkpoint
/// is therefore copied at once, which is quicker than the first time. An error (another connection is busy, a full
/// disk) leaves the log whole; the next checkpoint tries again, and the last one, by the writer at the end, reports it.
void checkpoint(sqlite_api::sqlite3* database) {
  constexpr int kMostTries = 4;
  int pages = -1, copied = 0;
  for (int n = 0; n < kMostTries && pages != copied; ++n)
    sqlite_api::sqlite3_wal_checkpoint_v2(database, nullptr, SQLITE_CHECKPOINT_PASSIVE, &pages, &copied);
}

}  // namespace

Status WalCheckpointer::start(const std::filesystem::path& session, std::chrono::milliseconds interval) {
  const auto database = std::make_shared<soci::session>();
  TROCAR_TRY_STATUS(guarded("cannot open the session a second time", session, "free some file handles", [&] {
    open_database(*database, session);
    *database << "PRAGMA synchronous = NORMAL";
  }));
  TROCAR_TRY(thread_, start_stoppable_thread("checkpoint", [database, interval](const std::stop_token& stop) {
               lower_priority(kNice);
               std::mutex mutex;
               std::condition_variable_any wake;
               std::unique_lock lock(mutex);
               while (!wake.wait_for(lock, stop, interval, [&stop] { return stop.stop_requested(); }))
                 checkpoint(handle_of(*database));
             }));
  return {};
}

}  // namespace trocar::storage::detail
