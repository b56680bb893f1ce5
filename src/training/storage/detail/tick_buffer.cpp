#include "storage/detail/tick_buffer.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "storage/detail/checksums.h"
#include "storage/detail/columns.h"

namespace trocar::storage::detail {

void TickBuffer::prepare(soci::session& database) {
  prepare_ticks(database);
  prepare_events(database);
}

void TickBuffer::end_statements() noexcept {
  insert_events_.reset();
  insert_ticks_.reset();
}

void TickBuffer::prepare_ticks(soci::session& database) {
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
  real_columns_.resize(reals);
  real_indicators_.resize(reals);
  integer_columns_.resize(integers);

  insert_ticks_.emplace(database);
  insert_ticks_->exchange(soci::use(tick_column_));
  reals = integers = 0;
  visit_stored_columns(sample, [&](const char*, const auto& field) {
    if constexpr (kIsReal<std::remove_cvref_t<decltype(field)>>) {
      insert_ticks_->exchange(soci::use(real_columns_[reals], real_indicators_[reals]));
      ++reals;
    } else {
      insert_ticks_->exchange(soci::use(integer_columns_[integers++]));
    }
  });
  insert_ticks_->alloc();
  insert_ticks_->prepare(fmt::format("INSERT INTO ticks ({}) VALUES ({})", names, values));
  insert_ticks_->define_and_bind();
}

void TickBuffer::prepare_events(soci::session& database) {
  insert_events_.emplace(database);
  insert_events_->exchange(soci::use(events_.tick));
  insert_events_->exchange(soci::use(events_.slot));
  insert_events_->exchange(soci::use(events_.kind));
  insert_events_->exchange(soci::use(events_.id));
  insert_events_->exchange(soci::use(events_.text));
  insert_events_->alloc();
  insert_events_->prepare("INSERT INTO events (tick, slot, kind, id, text) VALUES (:tick, :slot, :kind, :id, :text)");
  insert_events_->define_and_bind();
}

void TickBuffer::add(const SessionInfo& info, const telemetry::TickSample& sample) {
  samples_.push_back(sample);
  tick_column_.push_back(next_tick_);
  std::size_t real = 0;
  std::size_t integer = 0;
  visit_stored_columns(sample, [&](const char*, const auto& field) {
    if constexpr (kIsReal<std::remove_cvref_t<decltype(field)>>) {
      // SQLite has no NaN: it is stored as NULL.
      real_indicators_[real].push_back(std::isnan(field) ? soci::i_null : soci::i_ok);
      real_columns_[real++].push_back(field);
    } else {
      integer_columns_[integer++].push_back(static_cast<int>(field));
    }
  });
  for (std::size_t slot = 0; slot < sample.events.size(); ++slot) {
    const telemetry::TickEvent& event = sample.events[slot];
    if (event.kind == telemetry::EventKind::kNone) continue;
    events_.tick.push_back(next_tick_);
    events_.slot.push_back(static_cast<int>(slot));
    events_.kind.push_back(static_cast<int>(event.kind));
    events_.id.push_back(event.id);
    events_.text.push_back(event_text(info, event));
  }
  ++next_tick_;
}

void TickBuffer::write(soci::session& database) {
  if (!samples_.empty()) {
    insert_ticks_->execute(true);
    write_block(database, {static_cast<std::size_t>(tick_column_.front()), samples_.size(), digest_of(samples_)});
  }
  if (!events_.tick.empty()) insert_events_->execute(true);
}

void TickBuffer::clear() noexcept {
  samples_.clear();
  tick_column_.clear();
  for (auto& column : real_columns_) column.clear();
  for (auto& column : real_indicators_) column.clear();
  for (auto& column : integer_columns_) column.clear();
  for (auto* column : {&events_.tick, &events_.slot, &events_.kind, &events_.id}) column->clear();
  events_.text.clear();
}

namespace {

constexpr std::size_t kTicksAFetch = 4096;

/// Values above `last` are those of a damaged file or of a newer program.
int within(int value, int last, const char* column) {
  if (value < 0 || value > last) throw soci::soci_error(fmt::format("a value of {} is out of range", column));
  return value;
}

void set_field(std::uint8_t& field, int value, const char* column) {
  field = static_cast<std::uint8_t>(within(value, std::numeric_limits<std::uint8_t>::max(), column));
}
void set_field(bool& field, int value, const char* column) {
  field = within(value, 1, column) != 0;
}
template <class Enum>
requires std::is_enum_v<Enum>
void set_field(Enum& field, int value, const char* column) {
  field = static_cast<Enum>(within(value, static_cast<int>(last_of(field)), column));
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
  telemetry::TickSample row(std::size_t index) const {
    telemetry::TickSample sample;
    std::size_t real = 0;
    std::size_t integer = 0;
    visit_stored_columns(sample, [&](const char* name, auto& field) {
      if constexpr (kIsReal<std::remove_cvref_t<decltype(field)>>) {
        const bool is_null = indicators[real][index] == soci::i_null;
        field = is_null ? std::numeric_limits<double>::quiet_NaN() : reals[real][index];
        ++real;
      } else {
        set_field(field, integers[integer++][index], name);
      }
    });
    return sample;
  }
};

/// The columns that this session's `ticks` has.
std::set<std::string> present_columns(soci::session& database) {
  std::set<std::string> present;
  std::string name;
  soci::statement select = (database.prepare << "SELECT name FROM pragma_table_info('ticks')", soci::into(name));
  select.execute();
  while (select.fetch()) present.insert(name);
  return present;
}

/// Text of a column in the SELECT: its name, or the default value if it is missing.
template <class Field>
std::string column_text(const std::set<std::string>& present, const char* name, const Field& unfilled) {
  if (present.contains(name)) return name;
  if constexpr (kIsReal<Field>)
    return fmt::format("{:.1f} AS {}", unfilled, name);
  else
    return fmt::format("{} AS {}", static_cast<int>(unfilled), name);
}

/// Binds the columns to a statement and returns their texts.
std::string bind_columns(soci::statement& select, TickColumns& columns, const std::set<std::string>& present) {
  std::string names = "tick";
  const telemetry::TickSample sample;
  visit_stored_columns(sample, [&](const char* name, const auto& field) {
    names += ", " + column_text(present, name, field);
    if constexpr (kIsReal<std::remove_cvref_t<decltype(field)>>)
      columns.reals.emplace_back();
    else
      columns.integers.emplace_back();
  });
  columns.indicators.resize(columns.reals.size());
  columns.resize(kTicksAFetch);

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
  return names;
}

std::string where_ticks(const TickBlock& block) {
  return fmt::format("WHERE tick BETWEEN {} AND {}", block.first_tick, block.first_tick + block.ticks - 1);
}

void read_events(soci::session& database, const TickBlock& block, std::vector<telemetry::TickSample>& samples) {
  int tick = 0;
  int slot = 0;
  int kind = 0;
  int id = 0;
  soci::statement select = (database.prepare << "SELECT tick, slot, kind, id FROM events " + where_ticks(block),
                            soci::into(tick), soci::into(slot), soci::into(kind), soci::into(id));
  select.execute();
  while (select.fetch()) {
    const bool is_valid = tick >= 0 && slot >= 0 &&
                          static_cast<std::size_t>(slot) < telemetry::TickSample{}.events.size() && id >= 0 &&
                          id <= 255 && kind > 0 && kind <= static_cast<int>(telemetry::kLastEventKind) &&
                          static_cast<std::size_t>(tick) - block.first_tick < samples.size();
    if (!is_valid) throw soci::soci_error("an event is out of range");
    samples[static_cast<std::size_t>(tick) - block.first_tick].events[static_cast<std::size_t>(slot)] = {
        static_cast<telemetry::EventKind>(kind), static_cast<std::uint8_t>(id)};
  }
}

}  // namespace

std::vector<telemetry::TickSample> TickReader::read(const TickBlock& block) {
  if (present_.empty()) present_ = present_columns(*database_);
  TickColumns columns;
  soci::statement select(*database_);
  const std::string names = bind_columns(select, columns, present_);
  select.alloc();
  select.prepare(fmt::format("SELECT {} FROM ticks {} ORDER BY tick", names, where_ticks(block)));
  select.define_and_bind();
  select.execute();

  std::vector<telemetry::TickSample> samples;
  while (select.fetch()) {
    for (std::size_t i = 0; i < columns.tick.size(); ++i) {
      if (columns.tick[i] != static_cast<int>(block.first_tick + samples.size()))
        throw soci::soci_error("a tick is missing");
      samples.push_back(columns.row(i));
    }
    columns.resize(kTicksAFetch);
  }
  if (samples.size() != block.ticks) throw soci::soci_error("ticks are missing");
  if (!present_.contains("rest_tip_x_mm"))  // an older program: its patients did not move
    for (telemetry::TickSample& sample : samples) telemetry::set_at_rest(sample);
  read_events(*database_, block, samples);
  if (!block.digest.empty() && digest_of(samples, &present_) != block.digest)
    throw soci::soci_error("the checksum is another");
  return samples;
}

}  // namespace trocar::storage::detail
