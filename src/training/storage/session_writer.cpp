#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "config/json.h"
#include "core/files/output_file.h"
#include "core/log.h"
#include "core/result.h"
#include "storage/detail/checksums.h"
#include "storage/detail/database.h"
#include "storage/detail/info_table.h"
#include "storage/detail/parameters_table.h"
#include "storage/detail/tick_buffer.h"
#include "storage/detail/timed_table.h"
#include "storage/score_json.h"
#include "storage/session_file.h"

namespace trocar::storage {
namespace fs = std::filesystem;
using namespace detail;
namespace {

constexpr double kBatchSeconds = 0.5;         ///< Session time between two commits.
constexpr double kMaxBatchTicks = 100'000.0;  ///< Limit of the buffer at any rate.
// With a rollback journal a commit waits for readers: shortly, then it is put off to the next one, but not for ever.
constexpr int kShortWait_ms = 100;
constexpr int kLongWait_ms = 5000;
constexpr std::size_t kMostPutOff = 20;  ///< Batches.
constexpr const char* kWriteAdvice = "free some disk space or choose another folder";
constexpr const char* kPlaceAdvice = "choose another folder";

/// Creates the file: an existing file is never changed. A missing folder is created.
Status claim(const fs::path& path) {
  TROCAR_TRY_STATUS(make_parent_folder(path));
  const int file = ::open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0644);
  if (file < 0 && errno == EEXIST)
    return fail_usage("output already exists", path.string(), "choose another name or delete it");
  if (file < 0) return fail(fmt::format("cannot write: {}", std::strerror(errno)), path.string(), kPlaceAdvice);
  ::close(file);
  // Leftover companion files of a deleted session would be read as a part of the new one.
  const std::vector<fs::path> files = session_files(path);
  for (std::size_t n = 1; n < files.size(); ++n) {
    std::error_code ignored;
    fs::remove(files[n], ignored);
  }
  return {};
}

void remove_all(const std::vector<fs::path>& files) {
  std::error_code ignored;
  for (const fs::path& file : files) fs::remove(file, ignored);
}

}  // namespace

struct SessionWriter::Impl {
  fs::path path;
  SessionInfo info;
  std::size_t batch_ticks = 1;
  std::size_t saved_ticks = 0;
  double batch_start_s = 0.0;
  std::size_t put_off_ticks = 0;            ///< Buffered ticks of commits that were put off.
  double transducer_due_s = kBatchSeconds;  ///< Time span of the transducer's buffer that is committed.
  std::optional<Error> failure;
  bool is_finished = false;

  TickBuffer ticks;
  TimedBuffer transducer{transducer_table()};
  TimedBuffer xray{xray_table()};
  TimedBuffer actions{action_table()};
  ShapeBuffer shapes;
  ParametersBuffer parameters;

  ContentHash all_ticks;
  std::string ticks_hash;  ///< When finished.

  soci::session database;
  database::Journal journal;
  WalCheckpointer checkpointer;  ///< Of a write-ahead log.
  SharedLock lock;               ///< With a rollback journal, until the session is complete.

  ~Impl() {
    if (!is_finished && !failure) static_cast<void>(flush(Readers::kAwait));
    ticks.end_statements();
    lock.release();
    if (!is_finished) static_cast<void>(make_single_file());  // an incomplete session is also one file
  }

  void set_up();
  enum class Readers { kAwait, kPutOff };
  /// Commits the buffer. kPutOff: where another program reads a session with a rollback journal, the buffer is kept.
  Status flush(Readers readers = Readers::kPutOff);
  void write_buffer();
  void undo();
  void clear();
  Status make_single_file();
};

void SessionWriter::Impl::set_up() {
  open_database(database, path);
  journal = database::set_journal(database, path, database::find_network_file_system(path));
  database << "BEGIN IMMEDIATE";
  for (const std::string& statement : schema_statements()) database << statement;
  write_info(database, info);
  write_checksum(database, kInfoRows);
  write_checksum(database, kNameRows);
  database << "COMMIT";
  if (!journal.is_write_ahead) lock.take(database);
  ticks.prepare(database);
  if (!journal.is_write_ahead) return;
  const bool is_beside = checkpointer.start(path).has_value();
  if (is_beside) database << "PRAGMA wal_autocheckpoint = 0";
  database << (is_beside ? "PRAGMA synchronous = OFF" : "PRAGMA synchronous = NORMAL");
}

Status SessionWriter::Impl::flush(Readers readers) {
  if (ticks.is_empty() && transducer.is_empty() && xray.is_empty() && actions.is_empty() && shapes.is_empty() &&
      parameters.is_empty())
    return {};
  const bool may_put_off =
      readers == Readers::kPutOff && !journal.is_write_ahead && ticks.samples().size() < kMostPutOff * batch_ticks;
  set_wait(database, may_put_off ? kShortWait_ms : kLongWait_ms);
  const Status status = guarded("the session cannot be written", path, kWriteAdvice, [&] { write_buffer(); });
  if (!status && may_put_off && is_busy(database)) {
    undo();
    put_off_ticks = ticks.samples().size();
    if (!ticks.is_empty()) batch_start_s = ticks.samples().back().time_s;
    transducer_due_s = transducer.span_s() + kBatchSeconds;
    return {};
  }
  put_off_ticks = 0;
  transducer_due_s = kBatchSeconds;
  if (!status) failure = status.error();
  if (status) saved_ticks += ticks.samples().size();
  if (status) add_ticks(all_ticks, ticks.samples());
  clear();
  return status;
}

void SessionWriter::Impl::write_buffer() {
  database << "BEGIN IMMEDIATE";
  ticks.write(database);
  transducer.write(database);
  xray.write(database);
  actions.write(database);
  shapes.write(database);
  parameters.write(database);
  database << "COMMIT";
}

/// Ends the transaction that could not be committed, if it has begun.
void SessionWriter::Impl::undo() {
  static_cast<void>(guarded("", path, "", [&] { database << "ROLLBACK"; }));
}

void SessionWriter::Impl::clear() {
  ticks.clear();
  transducer.clear();
  xray.clear();
  actions.clear();
  shapes.clear();
  parameters.clear();
}

/// All is committed: another reader of the session, which keeps the -wal file, is not an error; a full disk is.
Status SessionWriter::Impl::make_single_file() {
  checkpointer.stop();
  const Status status = guarded("the session cannot be written", path, kWriteAdvice, [&] {
    std::string mode;
    if (journal.is_write_ahead) database << "PRAGMA synchronous = NORMAL";
    database << "PRAGMA journal_mode = DELETE", soci::into(mode);
  });
  const bool is_locked = !status && status.error().what.find("is locked") != std::string::npos;
  if (!is_locked) return status;
  log_warning("{} remains in two files: another program is reading it", path.string());
  return {};
}

SessionWriter::SessionWriter(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
SessionWriter::SessionWriter(SessionWriter&&) noexcept = default;
SessionWriter& SessionWriter::operator=(SessionWriter&&) noexcept = default;
SessionWriter::~SessionWriter() = default;

Result<SessionWriter> SessionWriter::create(const fs::path& path, const SessionInfo& info) {
  TROCAR_TRY_STATUS(claim(path));
  auto impl = std::make_unique<Impl>();
  impl->path = path;
  impl->info = info;
  impl->batch_ticks = static_cast<std::size_t>(std::clamp(kBatchSeconds * info.rate_hz, 1.0, kMaxBatchTicks));
  const Status status = guarded("cannot create the session", path, kWriteAdvice, [&] { impl->set_up(); });
  if (!status) {
    impl.reset();
    remove_all(session_files(path));
    return tl::unexpected(status.error());
  }
  return SessionWriter(std::move(impl));
}

Status SessionWriter::append(const telemetry::TickSample& sample) {
  TROCAR_CHECK(impl_ != nullptr && !impl_->is_finished);
  if (impl_->failure) return tl::unexpected(*impl_->failure);
  if (impl_->ticks.is_empty()) impl_->batch_start_s = sample.time_s;
  impl_->ticks.add(impl_->info, sample);
  const bool is_due = sample.time_s - impl_->batch_start_s >= kBatchSeconds;
  const std::size_t new_ticks = impl_->ticks.samples().size() - impl_->put_off_ticks;
  if (is_due || new_ticks >= impl_->batch_ticks) return impl_->flush();
  return {};
}

Status SessionWriter::append(const TransducerSample& sample) {
  TROCAR_CHECK(impl_ != nullptr && !impl_->is_finished);
  if (impl_->failure) return tl::unexpected(*impl_->failure);
  add(impl_->transducer, sample);
  return impl_->transducer.span_s() >= impl_->transducer_due_s ? impl_->flush()
                                                               : Status{};  // it moves without the needle
}

Status SessionWriter::append(const tasks::XrayUse& use) {
  TROCAR_CHECK(impl_ != nullptr && !impl_->is_finished);
  if (impl_->failure) return tl::unexpected(*impl_->failure);
  add(impl_->xray, use);  // written with the next ticks
  return {};
}

Status SessionWriter::append(const tasks::Action& action) {
  TROCAR_CHECK(impl_ != nullptr && !impl_->is_finished);
  if (impl_->failure) return tl::unexpected(*impl_->failure);
  add(impl_->actions, action);  // written with the next ticks
  return {};
}

Status SessionWriter::append(const telemetry::NeedleShape& shape) {
  TROCAR_CHECK(impl_ != nullptr && !impl_->is_finished);
  if (impl_->failure) return tl::unexpected(*impl_->failure);
  impl_->shapes.add(shape);  // written with its tick
  return {};
}

Status SessionWriter::append(const SessionParameters& parameters) {
  TROCAR_CHECK(impl_ != nullptr && !impl_->is_finished);
  TROCAR_CHECK(parameters.tick < static_cast<std::size_t>(impl_->ticks.next_tick()));
  if (impl_->failure) return tl::unexpected(*impl_->failure);
  impl_->parameters.add(parameters);
  return {};
}

Status SessionWriter::append(const tasks::Interruption& interruption) {
  TROCAR_CHECK(impl_ != nullptr && !impl_->is_finished);
  if (impl_->failure) return tl::unexpected(*impl_->failure);
  impl_->parameters.add(interruption, static_cast<std::size_t>(impl_->ticks.next_tick()));
  return {};
}

std::size_t SessionWriter::saved_ticks() const noexcept {
  return impl_->saved_ticks;
}

std::string SessionWriter::note() const {
  if (impl_->journal.obstacle.empty()) return {};
  return fmt::format(
      "the session is written with a rollback journal ({}): while another program reads {}, up to {:.0f} s "
      "of it are not yet stored",
      impl_->journal.obstacle, impl_->path.string(), kBatchSeconds * static_cast<double>(kMostPutOff));
}

const std::string& SessionWriter::ticks_hash() const noexcept {
  return impl_->ticks_hash;
}

Status SessionWriter::finish(const scoring::Outcome& outcome, std::span<const std::size_t> shots) {
  TROCAR_CHECK(impl_ != nullptr && !impl_->is_finished);
  for (const std::size_t shot : shots) TROCAR_CHECK(shot < static_cast<std::size_t>(impl_->ticks.next_tick()));
  if (impl_->failure) return tl::unexpected(*impl_->failure);
  TROCAR_TRY_STATUS(impl_->flush(Impl::Readers::kAwait));
  set_wait(impl_->database, kLongWait_ms);
  const Status status = guarded("the session's outcome cannot be written", impl_->path, kWriteAdvice, [&] {
    double score = outcome.score;
    soci::indicator score_indicator = std::isnan(score) || !outcome.is_scored() ? soci::i_null : soci::i_ok;
    int target_reached = outcome.target_reached ? 1 : 0;
    int fired_tick = shots.empty() ? 0 : static_cast<int>(shots.front());  // for older programs
    soci::indicator fired_indicator = shots.empty() ? soci::i_null : soci::i_ok;
    std::string json = outcome_to_json(outcome);
    impl_->database << "BEGIN IMMEDIATE";
    impl_->database << "INSERT INTO outcome (score, target_reached, fired_tick, json) VALUES (:s, :t, :f, :j)",
        soci::use(score, score_indicator), soci::use(target_reached), soci::use(fired_tick, fired_indicator),
        soci::use(json);
    for (const CheckedRows& rows : {kTransducerRows, kXrayRows, kActionRows, kShapeRows, kParameterRows,
                                    kInterruptionRows, kOutcomeRows, kBlockRows})
      write_checksum(impl_->database, rows);
    impl_->ticks_hash = impl_->all_ticks.digest();
    write_ticks_hash(impl_->database, impl_->saved_ticks, impl_->ticks_hash);
    impl_->database << "COMMIT";
  });
  if (!status) impl_->failure = status.error();
  TROCAR_TRY_STATUS(status);
  impl_->is_finished = true;
  impl_->ticks.end_statements();
  impl_->lock.release();
  return impl_->make_single_file();
}

}  // namespace trocar::storage
