#include "results/detail/form_tables.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "config/csv.h"
#include "results/detail/attempt_query.h"

namespace trocar::results::detail {
namespace {

std::vector<Item> read_items(soci::session& session, const std::string& form_id) {
  std::vector<Item> items;
  Item item;
  int kind = 0, is_required = 0;
  soci::statement select =
      (session.prepare << "SELECT id, kind, text, is_required FROM form_items WHERE form_id = :f AND is_retired = 0"
                          " ORDER BY position",
       soci::use(form_id), soci::into(item.id), soci::into(kind), soci::into(item.text), soci::into(is_required));
  select.execute();
  while (select.fetch()) {
    item.kind = static_cast<ItemKind>(kind);
    item.is_required = is_required != 0;
    items.push_back(item);
  }
  return items;
}

/// Forms without their items. `key`: null without a condition.
std::vector<Form> read_rows(soci::session& session, const std::string& condition, const std::string* key) {
  std::vector<Form> forms;
  Form form;
  int is_open = 0;
  long long changed_s = 0, responses = 0;
  soci::statement select(session);
  select.exchange(soci::into(form.id));
  select.exchange(soci::into(form.token));
  select.exchange(soci::into(form.title));
  select.exchange(soci::into(form.intro));
  select.exchange(soci::into(is_open));
  select.exchange(soci::into(changed_s));
  select.exchange(soci::into(responses));
  if (key != nullptr) select.exchange(soci::use(*key));
  select.alloc();
  select.prepare(
      "SELECT f.id, f.token, f.title, f.intro, f.is_open, f.changed_s,"
      " (SELECT count(*) FROM responses r WHERE r.form_id = f.id) FROM forms f" +
      condition + " ORDER BY f.changed_s DESC, f.id");
  select.define_and_bind();
  select.execute();
  while (select.fetch()) {
    form.is_open = is_open != 0;
    form.changed = Seconds(std::chrono::seconds(changed_s));
    form.responses = responses;
    forms.push_back(form);
  }
  return forms;
}

}  // namespace

std::optional<Form> read_form(soci::session& session, const std::string& condition, const std::string& key) {
  std::vector<Form> found = read_rows(session, " WHERE " + condition, &key);
  if (found.empty()) return std::nullopt;
  found.front().items = read_items(session, found.front().id);
  return std::move(found.front());
}

std::vector<Form> read_forms(soci::session& session) {
  std::vector<Form> forms = read_rows(session, "", nullptr);
  for (Form& form : forms) form.items = read_items(session, form.id);
  return forms;
}

void insert_form(soci::session& session, const Form& form) {
  const int is_open = form.is_open ? 1 : 0;
  const long long changed_s = form.changed.time_since_epoch().count();
  session << "INSERT INTO forms (id, token, title, intro, is_open, changed_s) VALUES (:i, :k, :t, :n, :o, :c)",
      soci::use(form.id), soci::use(form.token), soci::use(form.title), soci::use(form.intro), soci::use(is_open),
      soci::use(changed_s);
}

void update_form(soci::session& session, const Form& form) {
  const int is_open = form.is_open ? 1 : 0;
  const long long changed_s = form.changed.time_since_epoch().count();
  session << "UPDATE forms SET title = :t, intro = :n, is_open = :o, changed_s = :c WHERE id = :i",
      soci::use(form.title), soci::use(form.intro), soci::use(is_open), soci::use(changed_s), soci::use(form.id);
}

void insert_item(soci::session& session, const std::string& form_id, const Item& item, int position) {
  const int kind = static_cast<int>(item.kind), is_required = item.is_required ? 1 : 0;
  session << "INSERT INTO form_items (id, form_id, position, kind, text, is_required, is_retired)"
             " VALUES (:i, :f, :p, :k, :t, :r, 0)",
      soci::use(item.id), soci::use(form_id), soci::use(position), soci::use(kind), soci::use(item.text),
      soci::use(is_required);
}

void update_item(soci::session& session, const Item& item, int position) {
  const int kind = static_cast<int>(item.kind), is_required = item.is_required ? 1 : 0;
  session << "UPDATE form_items SET position = :p, kind = :k, text = :t, is_required = :r WHERE id = :i",
      soci::use(position), soci::use(kind), soci::use(item.text), soci::use(is_required), soci::use(item.id);
}

bool has_answers(soci::session& session, const std::string& item_id) {
  int count = 0;
  session << "SELECT count(*) FROM answers WHERE item_id = :i", soci::use(item_id), soci::into(count);
  return count > 0;
}

void remove_or_retire(soci::session& session, const std::string& item_id) {
  const char* const statement = has_answers(session, item_id) ? "UPDATE form_items SET is_retired = 1 WHERE id = :i"
                                                              : "DELETE FROM form_items WHERE id = :i";
  session << statement, soci::use(item_id);
}

bool insert_response(soci::session& session, const std::string& id, const std::string& form_id,
                     const std::string& person_id, Seconds now) {
  Bound<std::string> person(person_id.empty() ? std::nullopt : std::optional(person_id));
  const long long now_s = now.time_since_epoch().count();
  soci::statement insert =
      (session.prepare << "INSERT INTO responses (id, form_id, person_id, submitted_s) VALUES (:i, :f, :p, :s)"
                          " ON CONFLICT (id) DO NOTHING",
       soci::use(id), soci::use(form_id), soci::use(person.value, person.indicator), soci::use(now_s));
  insert.execute(true);
  return insert.get_affected_rows() == 1;
}

void insert_answer(soci::session& session, const std::string& response_id, const std::string& item_id,
                   const Answer& answer) {
  session << "INSERT INTO answers (response_id, item_id, points, text) VALUES (:r, :i, :p, :t)", soci::use(response_id),
      soci::use(item_id), soci::use(answer.points), soci::use(answer.text);
}

namespace {

/// Mean and standard deviation (n - 1) of points from their counts.
void add_moments(ItemSummary& summary) {
  double sum = 0.0, squares = 0.0;
  for (int points = 1; points <= kScalePoints; ++points) {
    const auto count = static_cast<double>(summary.counts[static_cast<std::size_t>(points - 1)]);
    sum += count * points;
    squares += count * points * points;
  }
  const auto n = static_cast<double>(summary.n);
  if (summary.n == 0) return;
  summary.mean = sum / n;
  if (summary.n > 1) summary.sd = std::sqrt(std::max(0.0, (squares - n * *summary.mean * *summary.mean) / (n - 1.0)));
}

std::vector<ItemSummary> read_all_items(soci::session& session, const std::string& form_id) {
  std::vector<ItemSummary> items;
  ItemSummary one;
  int kind = 0, is_required = 0, is_retired = 0;
  soci::statement select =
      (session.prepare << "SELECT id, kind, text, is_required, is_retired FROM form_items WHERE form_id = :f"
                          " ORDER BY is_retired, position, id",
       soci::use(form_id), soci::into(one.item.id), soci::into(kind), soci::into(one.item.text),
       soci::into(is_required), soci::into(is_retired));
  select.execute();
  while (select.fetch()) {
    one.item.kind = static_cast<ItemKind>(kind);
    one.item.is_required = is_required != 0;
    one.is_retired = is_retired != 0;
    items.push_back(one);
  }
  return items;
}

}  // namespace

std::vector<ItemSummary> summarise_items(soci::session& session, const std::string& form_id) {
  std::vector<ItemSummary> items = read_all_items(session, form_id);
  for (ItemSummary& summary : items) {
    int points = 0;
    std::string text;
    long long submitted_s = 0;
    soci::statement select =
        (session.prepare << "SELECT a.points, a.text, r.submitted_s FROM answers a JOIN responses r ON"
                            " r.id = a.response_id WHERE a.item_id = :i ORDER BY r.submitted_s DESC, r.id",
         soci::use(summary.item.id), soci::into(points), soci::into(text), soci::into(submitted_s));
    select.execute();
    while (select.fetch()) {
      ++summary.n;
      if (summary.item.kind == ItemKind::kText) {
        summary.comments.push_back({text, Seconds(std::chrono::seconds(submitted_s))});
      } else if (points >= 1 && points <= kScalePoints) {
        ++summary.counts[static_cast<std::size_t>(points - 1)];
      }
    }
    if (summary.item.kind == ItemKind::kScale) add_moments(summary);
  }
  return items;
}

std::string write_answers(soci::session& session, const std::string& form_id) {
  const std::vector<ItemSummary> items = read_all_items(session, form_id);
  std::map<std::string, std::size_t> columns;
  std::vector<std::string> row{"submitted_utc"};
  for (const ItemSummary& summary : items) {
    columns[summary.item.id] = row.size();
    row.push_back(config::csv_text(summary.item.text));
  }
  std::string text = config::csv_row(row);
  std::string response, item, answer, current;
  int points = 0;
  long long submitted_s = 0;
  soci::statement select =
      (session.prepare << "SELECT r.id, r.submitted_s, a.item_id, a.points, a.text FROM responses r JOIN answers a ON"
                          " a.response_id = r.id WHERE r.form_id = :f ORDER BY r.submitted_s, r.id",
       soci::use(form_id), soci::into(response), soci::into(submitted_s), soci::into(item), soci::into(points),
       soci::into(answer));
  select.execute();
  while (select.fetch()) {
    if (response != current) {
      if (!current.empty()) text += config::csv_row(row);
      current = response;
      row.assign(items.size() + 1, "");
      row[0] = fmt::format("{:%FT%TZ}", fmt::gmtime(static_cast<std::time_t>(submitted_s)));
    }
    if (const auto column = columns.find(item); column != columns.end())
      row[column->second] = points > 0 ? std::to_string(points) : config::csv_text(answer);
  }
  if (!current.empty()) text += config::csv_row(row);
  return text;
}

}  // namespace trocar::results::detail
