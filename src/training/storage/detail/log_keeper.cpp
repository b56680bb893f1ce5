#include "storage/detail/log_keeper.h"

#include <condition_variable>
#include <mutex>
#include <utility>

#include "core/live/live_thread.h"
#include "core/log.h"
#include "core/start_thread.h"
#include "storage/detail/database.h"

namespace trocar::storage::detail {
namespace {

constexpr int kNice = 5;

/// The writer begins its log again from the start if all of it was moved. What it wrote meanwhile is moved at once:
/// that takes less time than the first move. A log that another connection keeps busy is left for the next time.
void move_log(sqlite_api::sqlite3* database) {
  constexpr int kMostMoves = 4;
  int rows = -1, moved = 0;
  for (int n = 0; n < kMostMoves && rows != moved; ++n)
    sqlite_api::sqlite3_wal_checkpoint_v2(database, nullptr, SQLITE_CHECKPOINT_PASSIVE, &rows, &moved);
}

void keep(const std::filesystem::path& session, std::chrono::milliseconds interval, const std::stop_token& stop) {
  lower_priority(kNice);
  soci::session database;
  open_database(database, session);
  database << "PRAGMA synchronous = NORMAL";
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  while (!wake.wait_for(lock, stop, interval, [&stop] { return stop.stop_requested(); })) move_log(handle_of(database));
}

}  // namespace

Status LogKeeper::start(const std::filesystem::path& session, std::chrono::milliseconds interval) {
  TROCAR_TRY(thread_, start_stoppable_thread("log keeper", [session, interval](const std::stop_token& stop) {
               // The log stays whole and is moved when the session ends, which tells what is wrong.
               const Status kept = guarded("the log of a session is not moved", session, "free some disk space",
                                           [&] { keep(session, interval, stop); });
               if (!kept) log_warning("{}", kept.error().text());
             }));
  return {};
}

}  // namespace trocar::storage::detail
