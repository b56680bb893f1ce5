#include "results/detail/form_tables.h"

#include "results/detail/rows.h"

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

}  // namespace trocar::results::detail
