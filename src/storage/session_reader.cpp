#include <fmt/format.h>

#include <array>
#include <cstring>
#include <fstream>
#include <limits>
#include <set>

#include "storage/detail/columns.h"
#include "storage/detail/database.h"
#include "storage/detail/info_table.h"
#include "storage/detail/outcome_json.h"
#include "storage/detail/transducer_table.h"
#include "storage/session_file.h"

namespace trocar {
namespace fs = std::filesystem;
using namespace storage_detail;
namespace {

constexpr std::size_t kRowsAFetch = 4096;
constexpr const char* kAdvice = "name a file made by `trocar run`";

/// Looks at the first bytes, so that SQLite never sees (or makes) what is no database.
Status check_file(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (status.type() == fs::file_type::not_found) return fail("no such session", path.string(), "check the path");
  if (error) return fail("cannot be read: " + error.message(), path.string(), "check the permissions");
  if (fs::is_directory(status)) return fail("is a folder, not a session", path.string(), kAdvice);
  if (!fs::is_regular_file(status)) return fail("is not a file", path.string(), kAdvice);
  std::ifstream file(path, std::ios::binary);
  if (!file) return fail("cannot be read", path.string(), "check the permissions");
  std::array<char, 16> head{};
  file.read(head.data(), head.size());
  if (file.gcount() == 0) return fail("is empty, not a session", path.string(), kAdvice);
  if (std::memcmp(head.data(), "SQLite format 3", head.size()) != 0)
    return fail("is not a session", path.string(), kAdvice);
  return {};
}

Status check_identity(soci::session& database, const fs::path& path) {
  if (pragma_integer(database, "application_id") != kApplicationId)
    return fail("is a database, but not a session", path.string(), kAdvice);
  const int version = pragma_integer(database, "user_version");
  if (version > kSessionFormatVersion)
    return fail(fmt::format("the session has format {}, this program reads up to {}", version, kSessionFormatVersion),
                path.string(), "use a newer program");
  if (version < 1) return fail(fmt::format("the session has the unknown format {}", version), path.string(), kAdvice);
  return {};
}

void set_field(std::uint8_t& field, int value) {
  if (value < 0 || value > 255) throw soci::soci_error("a tissue is out of range");
  field = static_cast<std::uint8_t>(value);
}
void set_field(InsertionPhase& field, int value) {
  if (value < 0 || value > static_cast<int>(InsertionPhase::kRetracting))
    throw soci::soci_error("a phase is out of range");
  field = static_cast<InsertionPhase>(value);
}
void set_field(GateMode& field, int value) {
  if (value < 0 || value > static_cast<int>(kLastGateMode)) throw soci::soci_error("a gate mode is out of range");
  field = static_cast<GateMode>(value);
}
void set_field(GateFault& field, int value) {
  if (value < 0 || value > static_cast<int>(kLastGateFault)) throw soci::soci_error("a gate fault is out of range");
  field = static_cast<GateFault>(value);
}
void set_field(bool& field, int value) {
  field = value != 0;
}

/// The columns of one fetch.
struct TickColumns {
  std::vector<int> tick;
  std::vector<std::vector<double>> reals;
  std::vector<std::vector<soci::indicator>> indicators;
  std::vector<std::vector<int>> integers;

  void resize(std::size_t rows) {
    tick.resize(rows);
    for (auto& column : reals) column.resize(rows);
    for (auto& column : indicators) column.resize(rows);
    for (auto& column : integers) column.resize(rows);
  }
  TickSample row(std::size_t index) const {
    TickSample sample;
    std::size_t real = 0;
    std::size_t integer = 0;
    visit_stored_columns(sample, [&](const char*, auto& field) {
      if constexpr (kIsReal<std::remove_cvref_t<decltype(field)>>) {
        const bool is_null = indicators[real][index] == soci::i_null;
        field = is_null ? std::numeric_limits<double>::quiet_NaN() : reals[real][index];
        ++real;
      } else {
        set_field(field, integers[integer++][index]);
      }
    });
    return sample;
  }
};

/// The columns that this session's `ticks` has: a session of an older program lacks the newer ones.
std::set<std::string> present_columns(soci::session& database) {
  std::set<std::string> present;
  std::string name;
  soci::statement select = (database.prepare << "SELECT name FROM pragma_table_info('ticks')", soci::into(name));
  select.execute();
  while (select.fetch()) present.insert(name);
  return present;
}

/// Text of a column in the SELECT: its name, or the value of a sample that was never filled where it is missing.
template <class Field>
std::string column_text(const std::set<std::string>& present, const char* name, const Field& unfilled) {
  if (present.contains(name)) return name;
  if constexpr (kIsReal<Field>)
    return fmt::format("{:.1f} AS {}", unfilled, name);
  else
    return fmt::format("{} AS {}", static_cast<int>(unfilled), name);
}

std::vector<TickSample> read_ticks(soci::session& database) {
  const std::set<std::string> present = present_columns(database);
  std::string names = "tick";
  TickColumns columns;
  const TickSample sample;
  visit_stored_columns(sample, [&](const char* name, const auto& field) {
    names += ", " + column_text(present, name, field);
    if constexpr (kIsReal<std::remove_cvref_t<decltype(field)>>)
      columns.reals.emplace_back();
    else
      columns.integers.emplace_back();
  });
  columns.indicators.resize(columns.reals.size());
  columns.resize(kRowsAFetch);

  soci::statement select(database);
  select.exchange(soci::into(columns.tick));
  std::size_t real = 0;
  std::size_t integer = 0;
  visit_stored_columns(sample, [&](const char*, const auto& field) {
    if constexpr (kIsReal<std::remove_cvref_t<decltype(field)>>) {
      select.exchange(soci::into(columns.reals[real], columns.indicators[real]));
      ++real;
    } else {
      select.exchange(soci::into(columns.integers[integer++]));
    }
  });
  select.alloc();
  select.prepare("SELECT " + names + " FROM ticks ORDER BY tick");
  select.define_and_bind();
  select.execute();

  std::vector<TickSample> samples;
  while (select.fetch()) {
    for (std::size_t i = 0; i < columns.tick.size(); ++i) {
      if (columns.tick[i] != static_cast<int>(samples.size())) throw soci::soci_error("a tick is missing");
      samples.push_back(columns.row(i));
    }
    columns.resize(kRowsAFetch);
  }
  return samples;
}

void read_events(soci::session& database, std::vector<TickSample>& samples) {
  int tick = 0;
  int slot = 0;
  int kind = 0;
  int id = 0;
  soci::statement select = (database.prepare << "SELECT tick, slot, kind, id FROM events", soci::into(tick),
                            soci::into(slot), soci::into(kind), soci::into(id));
  select.execute();
  while (select.fetch()) {
    const bool is_good = tick >= 0 && static_cast<std::size_t>(tick) < samples.size() && slot >= 0 &&
                         static_cast<std::size_t>(slot) < TickSample{}.events.size() && id >= 0 && id <= 255 &&
                         kind > 0 && kind <= static_cast<int>(EventKind::kLimit);
    if (!is_good) throw soci::soci_error("an event is out of range");
    samples[static_cast<std::size_t>(tick)].events[static_cast<std::size_t>(slot)] = {static_cast<EventKind>(kind),
                                                                                      static_cast<std::uint8_t>(id)};
  }
}

/// The outcome's JSON, empty where there is none, and the fired tick.
std::string read_outcome(soci::session& database, Session& session) {
  std::string json;
  int fired = 0;
  soci::indicator indicator = soci::i_null;
  database << "SELECT fired_tick, json FROM outcome", soci::into(fired, indicator), soci::into(json);
  if (!json.empty() && indicator == soci::i_ok) {
    if (fired < 0 || static_cast<std::size_t>(fired) >= session.samples.size())
      throw soci::soci_error("the fired tick is out of range");
    session.fired = static_cast<std::size_t>(fired);
  }
  return json;
}

/// A killed session needs its folder: SQLite makes an index of the -wal file there.
const char* open_advice(const fs::path& path) {
  std::error_code error;
  return fs::exists(path.string() + "-wal", error)
             ? "the program was killed here: copy the session and its -wal file to a place that can be written"
             : "check the file; if it was copied, copy it again";
}

}  // namespace

Result<Session> load_session(const fs::path& path) {
  TROCAR_TRY_STATUS(check_file(path));
  Session session;
  std::string outcome_json;
  Status identity;
  TROCAR_TRY_STATUS(guarded("the session cannot be read", path, open_advice(path), [&] {
    soci::session database;
    open_database(database, path);
    identity = check_identity(database, path);
    if (!identity) return;
    session.info = read_info(database);
    session.samples = read_ticks(database);
    read_events(database, session.samples);
    session.transducer = read_transducer(database);
    outcome_json = read_outcome(database, session);
  }));
  TROCAR_TRY_STATUS(identity);
  if (!outcome_json.empty()) {
    TROCAR_TRY(session.outcome, outcome_from_json(outcome_json, path.string()));
  }
  return session;
}

}  // namespace trocar
