#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>

#include "config/json.h"
#include "core/check.h"
#include "core/files/atomic_file.h"
#include "core/log.h"
#include "storage/detail/action_table.h"
#include "storage/detail/checksums.h"
#include "storage/detail/columns.h"
#include "storage/detail/database.h"
#include "storage/detail/info_table.h"
#include "storage/detail/outcome_json.h"
#include "storage/detail/parameters_table.h"
#include "storage/detail/shape_table.h"
#include "storage/detail/transducer_table.h"
#include "storage/detail/xray_table.h"
#include "storage/session_file.h"

namespace trocar::storage {
namespace fs = std::filesystem;
using namespace detail;
namespace {

constexpr double kBatchSeconds = 0.5;         ///< Session time between two commits.
constexpr double kMaxBatchTicks = 100'000.0;  ///< Limit of the buffer at any rate.
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

/// Invariant: every buffered column has the length of `samples`.
struct SessionWriter::Impl {
  fs::path path;
  SessionInfo info;
  std::size_t batch_ticks = 1;
  int next_tick = 0;
  std::size_t saved_ticks = 0;
  double batch_start_s = 0.0;
  std::optional<Error> failure;
  bool is_finished = false;

  // Buffered columns, bound to the statements.
  std::vector<telemetry::TickSample> samples;
  std::vector<int> tick_column;
  std::vector<std::vector<double>> real_columns;
  std::vector<std::vector<soci::indicator>> real_indicators;
  std::vector<std::vector<int>> integer_columns;
  struct {
    std::vector<int> tick, slot, kind, id;
    std::vector<std::string> text;
  } events;
  TimedBuffer transducer{transducer_table()};
  TimedBuffer xray{xray_table()};
  TimedBuffer actions{action_table()};
  ShapeBuffer shapes;
  ParametersBuffer parameters;

  ContentHash all_ticks;
  std::string ticks_hash;  ///< When finished.

  soci::session database;
  std::optional<soci::statement> insert_ticks, insert_events;

  ~Impl() {
    if (!is_finished && !failure) static_cast<void>(flush());
    insert_events.reset();
    insert_ticks.reset();
    if (!is_finished) static_cast<void>(make_single_file());  // an incomplete session is also one file
  }

  void set_up();
  void prepare_insert_ticks();
  void prepare_insert_events();
  void buffer(const telemetry::TickSample& sample);
  Status flush();
  void clear();
  Status make_single_file();
};

void SessionWriter::Impl::set_up() {
  open_database(database, path);
  std::string mode;
  database << "PRAGMA journal_mode = WAL", soci::into(mode);
  database << "PRAGMA synchronous = NORMAL";
  database << "BEGIN IMMEDIATE";
  for (const std::string& statement : schema_statements()) database << statement;
  write_info(database, info);
  write_checksum(database, kInfoRows);
  write_checksum(database, kNameRows);
  database << "COMMIT";
  prepare_insert_ticks();
  prepare_insert_events();
}

void SessionWriter::Impl::prepare_insert_ticks() {
  std::string names = "tick";
  std::string values = ":tick";
  std::size_t reals = 0;
  std::size_t integers = 0;
  const telemetry::TickSample sample;
  visit_stored_columns(sample, [&](const char* name, const auto& field) {
    names += fmt::format(", {}", name);
    values += fmt::format(", :{}", name);
    ++(kIsReal<std::remove_cvref_t<decltype(field)>> ? reals : integers);
  });
  real_columns.resize(reals);
  real_indicators.resize(reals);
  integer_columns.resize(integers);

  insert_ticks.emplace(database);
  insert_ticks->exchange(soci::use(tick_column));
  reals = integers = 0;
  visit_stored_columns(sample, [&](const char*, const auto& field) {
    if constexpr (kIsReal<std::remove_cvref_t<decltype(field)>>) {
      insert_ticks->exchange(soci::use(real_columns[reals], real_indicators[reals]));
      ++reals;
    } else {
      insert_ticks->exchange(soci::use(integer_columns[integers++]));
    }
  });
  insert_ticks->alloc();
  insert_ticks->prepare(fmt::format("INSERT INTO ticks ({}) VALUES ({})", names, values));
  insert_ticks->define_and_bind();
}

void SessionWriter::Impl::prepare_insert_events() {
  insert_events.emplace(database);
  insert_events->exchange(soci::use(events.tick));
  insert_events->exchange(soci::use(events.slot));
  insert_events->exchange(soci::use(events.kind));
  insert_events->exchange(soci::use(events.id));
  insert_events->exchange(soci::use(events.text));
  insert_events->alloc();
  insert_events->prepare("INSERT INTO events (tick, slot, kind, id, text) VALUES (:tick, :slot, :kind, :id, :text)");
  insert_events->define_and_bind();
}

void SessionWriter::Impl::buffer(const telemetry::TickSample& sample) {
  samples.push_back(sample);
  tick_column.push_back(next_tick);
  std::size_t real = 0;
  std::size_t integer = 0;
  visit_stored_columns(sample, [&](const char*, const auto& field) {
    if constexpr (kIsReal<std::remove_cvref_t<decltype(field)>>) {
      // SQLite has no NaN: it is stored as NULL.
      real_indicators[real].push_back(std::isnan(field) ? soci::i_null : soci::i_ok);
      real_columns[real++].push_back(field);
    } else {
      integer_columns[integer++].push_back(static_cast<int>(field));
    }
  });
  for (std::size_t slot = 0; slot < sample.events.size(); ++slot) {
    const telemetry::TickEvent& event = sample.events[slot];
    if (event.kind == telemetry::EventKind::kNone) continue;
    events.tick.push_back(next_tick);
    events.slot.push_back(static_cast<int>(slot));
    events.kind.push_back(static_cast<int>(event.kind));
    events.id.push_back(event.id);
    events.text.push_back(event_text(info, event));
  }
  ++next_tick;
}

Status SessionWriter::Impl::flush() {
  if (tick_column.empty() && transducer.is_empty() && xray.is_empty() && actions.is_empty() && shapes.is_empty() &&
      parameters.is_empty())
    return {};
  Status status = guarded("the session cannot be written", path, kWriteAdvice, [&] {
    database << "BEGIN IMMEDIATE";
    if (!tick_column.empty()) {
      insert_ticks->execute(true);
      write_block(database, {static_cast<std::size_t>(tick_column.front()), samples.size(), digest_of(samples)});
    }
    if (!events.tick.empty()) insert_events->execute(true);
    transducer.write(database);
    xray.write(database);
    actions.write(database);
    shapes.write(database);
    parameters.write(database);
    database << "COMMIT";
  });
  if (!status) failure = status.error();
  if (status) saved_ticks += samples.size();
  if (status) add_ticks(all_ticks, samples);
  clear();
  return status;
}

void SessionWriter::Impl::clear() {
  samples.clear();
  tick_column.clear();
  for (auto& column : real_columns) column.clear();
  for (auto& column : real_indicators) column.clear();
  for (auto& column : integer_columns) column.clear();
  for (auto* column : {&events.tick, &events.slot, &events.kind, &events.id}) column->clear();
  events.text.clear();
  transducer.clear();
  xray.clear();
  actions.clear();
  shapes.clear();
  parameters.clear();
}

/// All is committed: another reader of the session, which keeps the -wal file, is not an error; a full disk is.
Status SessionWriter::Impl::make_single_file() {
  const Status status = guarded("the session cannot be written", path, kWriteAdvice, [&] {
    std::string mode;
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
  if (impl_->tick_column.empty()) impl_->batch_start_s = sample.time_s;
  impl_->buffer(sample);
  const bool is_due = sample.time_s - impl_->batch_start_s >= kBatchSeconds;
  if (is_due || impl_->tick_column.size() >= impl_->batch_ticks) return impl_->flush();
  return {};
}

Status SessionWriter::append(const TransducerSample& sample) {
  TROCAR_CHECK(impl_ != nullptr && !impl_->is_finished);
  if (impl_->failure) return tl::unexpected(*impl_->failure);
  add(impl_->transducer, sample);
  return impl_->transducer.span_s() >= kBatchSeconds ? impl_->flush() : Status{};  // it moves without the needle
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
  TROCAR_CHECK(parameters.tick < static_cast<std::size_t>(impl_->next_tick));
  if (impl_->failure) return tl::unexpected(*impl_->failure);
  impl_->parameters.add(parameters);
  return {};
}

Status SessionWriter::append(const tasks::Interruption& interruption) {
  TROCAR_CHECK(impl_ != nullptr && !impl_->is_finished);
  if (impl_->failure) return tl::unexpected(*impl_->failure);
  impl_->parameters.add(interruption, static_cast<std::size_t>(impl_->next_tick));
  return {};
}

std::size_t SessionWriter::saved_ticks() const noexcept {
  return impl_->saved_ticks;
}

const std::string& SessionWriter::ticks_hash() const noexcept {
  return impl_->ticks_hash;
}

Status SessionWriter::finish(const scoring::Outcome& outcome, std::span<const std::size_t> shots) {
  TROCAR_CHECK(impl_ != nullptr && !impl_->is_finished);
  for (const std::size_t shot : shots) TROCAR_CHECK(shot < static_cast<std::size_t>(impl_->next_tick));
  if (impl_->failure) return tl::unexpected(*impl_->failure);
  TROCAR_TRY_STATUS(impl_->flush());
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
  impl_->insert_events.reset();
  impl_->insert_ticks.reset();
  return impl_->make_single_file();
}

}  // namespace trocar::storage
