#include "storage/detail/tick_buffer.h"

#include <fmt/format.h>

#include <cmath>

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

}  // namespace trocar::storage::detail
