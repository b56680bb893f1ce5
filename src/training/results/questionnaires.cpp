#include "results/questionnaires.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "results/detail/attempt_query.h"
#include "results/detail/form_tables.h"
#include "results/names.h"
#include "results/repository.h"
#include "signing/token.h"

namespace trocar::results {
using namespace detail;
namespace {

constexpr const char* kCannotReadForms = "the questionnaires cannot be read";
constexpr const char* kCannotWriteForm = "the questionnaire cannot be written";
constexpr std::size_t kMaxTitle = 200, kMaxItemText = 500;
constexpr int kTokenBits = 128;

Status no_such_form(std::string_view id) {
  return fail_usage("no such questionnaire", std::string(id), "see the list of questionnaires");
}

Result<std::string> clean_required(std::string_view text, std::size_t max_characters, const char* kind) {
  TROCAR_TRY(std::string clean, clean_text(text, max_characters, kind));
  if (clean.empty()) return fail_usage(fmt::format("{} is empty", kind), {}, "write it");
  return clean;
}

/// The texts of a form, checked and without blanks at their ends.
Result<Form> clean_form(Form form) {
  TROCAR_TRY(form.title, clean_required(form.title, kMaxTitle, "the title"));
  TROCAR_TRY(form.intro, clean_text(form.intro, kMaxIntroCharacters, "the introduction"));
  if (form.items.empty()) return fail_usage("the questionnaire has no item", form.title, "add one");
  if (form.items.size() > kMaxItems)
    return fail_usage(fmt::format("the questionnaire has {} items", form.items.size()), form.title,
                      fmt::format("use at most {}", kMaxItems));
  std::set<std::string> ids;
  for (Item& item : form.items) {
    TROCAR_TRY(item.text, clean_required(item.text, kMaxItemText, "the text of an item"));
    if (!item.id.empty() && !ids.insert(item.id).second)
      return fail_usage("an item occurs twice", item.text, "remove one");
  }
  return form;
}

/// An answer of a person, checked; without one, an empty one.
Result<Answer> clean_answer(const Item& item, const Answer* given) {
  const Answer answer = given != nullptr ? *given : Answer{};
  if (item.kind == ItemKind::kText) {
    TROCAR_TRY(std::string text, clean_text(answer.text, kMaxAnswerCharacters, "the answer"));
    return Answer{0, std::move(text)};
  }
  if (!answer.text.empty() || answer.points < 0 || answer.points > kScalePoints)
    return fail_usage(fmt::format("the answer is not 1 to {}", kScalePoints), item.text, "choose one");
  return Answer{answer.points, {}};
}

Result<std::map<std::string, Answer>> clean_answers(const Form& form,
                                                    const std::map<std::string, Answer, std::less<>>& answers) {
  std::map<std::string, Answer> clean;
  for (const Item& item : form.items) {
    const auto found = answers.find(item.id);
    TROCAR_TRY(Answer answer, clean_answer(item, found != answers.end() ? &found->second : nullptr));
    const bool is_given = answer.points > 0 || !answer.text.empty();
    if (item.is_required && !is_given) return fail_usage("an answer is missing", item.text, "answer it");
    if (is_given) clean[item.id] = std::move(answer);
  }
  for (const auto& [id, answer] : answers)
    if (std::none_of(form.items.begin(), form.items.end(), [&](const Item& item) { return item.id == id; }))
      return fail_usage("the questionnaire has no such item", id, "load the page again: it was changed");
  return clean;
}

}  // namespace

const char* to_string(ItemKind kind) noexcept {
  return kind == ItemKind::kText ? "text" : "scale";
}

std::optional<ItemKind> find_item_kind(std::string_view name) noexcept {
  for (const ItemKind kind : {ItemKind::kScale, ItemKind::kText})
    if (name == to_string(kind)) return kind;
  return std::nullopt;
}

Form default_form() {
  Form form;
  form.title = "Your opinion of the puncture simulator";
  form.intro = "Please say how far you agree with each statement. Your answers are anonymous.";
  form.items = {
      {{}, ItemKind::kScale, "Training with such a simulator is useful.", true},
      {{}, ItemKind::kScale, "The anatomical structures look realistic.", true},
      {{}, ItemKind::kScale, "The forces at the needle feel realistic.", true},
      {{}, ItemKind::kScale, "After this training I feel more confident about my first puncture.", true},
      {{}, ItemKind::kText, "What did you like, and what should be better?", false},
  };
  return form;
}

Result<Form> add_form(Repository& repository, const Form& given, Seconds now) {
  TROCAR_TRY(Form form, clean_form(given));
  TROCAR_TRY(form.token, signing::make_token(kTokenBits));
  form.id = make_id();
  form.changed = now;
  return repository.database().transaction(kCannotWriteForm, [&](soci::session& session) {
    insert_form(session, form);
    int position = 0;
    for (Item& item : form.items) {
      item.id = make_id();
      insert_item(session, form.id, item, position++);
    }
    return form;
  });
}

Result<Form> change_form(Repository& repository, const Form& given, Seconds now) {
  TROCAR_TRY(Form form, clean_form(given));
  form.changed = now;
  return repository.database().transaction(kCannotWriteForm, [&](soci::session& session) -> Result<Form> {
    const std::optional<Form> before = read_form(session, "f.id = :k", form.id);
    if (!before) return tl::unexpected(no_such_form(form.id).error());
    update_form(session, form);
    std::set<std::string> kept;
    int position = 0;
    for (Item& item : form.items) {
      const auto same = std::find_if(before->items.begin(), before->items.end(), [&](const Item& old) {
        return old.id == item.id && (!has_answers(session, old.id) || (old.text == item.text && old.kind == item.kind));
      });
      if (same == before->items.end()) {
        item.id = make_id();
        insert_item(session, form.id, item, position++);
      } else {
        update_item(session, item, position++);
      }
      kept.insert(item.id);
    }
    for (const Item& old : before->items)
      if (!kept.contains(old.id)) remove_or_retire(session, old.id);
    form.token = before->token;
    form.responses = before->responses;
    return form;
  });
}

Result<std::vector<Form>> list_forms(Repository& repository) {
  return repository.database().run(kCannotReadForms, [](soci::session& session) { return read_forms(session); });
}

Result<std::optional<Form>> find_form(Repository& repository, std::string_view id) {
  return repository.database().run(
      kCannotReadForms, [&](soci::session& session) { return read_form(session, "f.id = :k", std::string(id)); });
}

Result<std::optional<Form>> find_open_form(Repository& repository, std::string_view token) {
  return repository.database().run(kCannotReadForms, [&](soci::session& session) {
    return read_form(session, "f.token = :k AND f.is_open = 1", std::string(token));
  });
}

Status delete_form(Repository& repository, std::string_view id) {
  const auto deleted =
      repository.database().transaction("the questionnaire cannot be deleted", [&](soci::session& session) -> Status {
        const std::string key(id);
        soci::statement remove = (session.prepare << "DELETE FROM forms WHERE id = :i", soci::use(key));
        remove.execute(true);
        if (remove.get_affected_rows() != 1) return no_such_form(id);
        note_deletion(session);
        return {};
      });
  if (deleted) static_cast<void>(erase_deleted(repository));
  return deleted;
}

Status add_response(Repository& repository, std::string_view token, std::string_view response_id,
                    const std::map<std::string, Answer, std::less<>>& answers, std::string_view person_id,
                    Seconds now) {
  return repository.database().transaction("the answers cannot be written", [&](soci::session& session) -> Status {
    const std::optional<Form> form = read_form(session, "f.token = :k AND f.is_open = 1", std::string(token));
    if (!form) return fail("the questionnaire is closed", {}, "ask your instructor");
    TROCAR_TRY(const auto clean, clean_answers(*form, answers));
    if (clean.empty()) return fail_usage("nothing was answered", form->title, "answer at least one item");
    const std::string id = response_id.empty() ? make_id() : std::string(response_id);
    if (!insert_response(session, id, form->id, std::string(person_id), now)) return {};
    for (const auto& [item, answer] : clean) insert_answer(session, id, item, answer);
    return {};
  });
}

Result<std::optional<FormSummary>> summarise_form(Repository& repository, std::string_view id) {
  return repository.database().run(kCannotReadForms, [&](soci::session& session) -> std::optional<FormSummary> {
    std::optional<Form> form = read_form(session, "f.id = :k", std::string(id));
    if (!form) return std::nullopt;
    FormSummary summary;
    summary.items = summarise_items(session, form->id);
    summary.form = *std::move(form);
    return summary;
  });
}

Result<std::string> answers_csv(Repository& repository, std::string_view id) {
  return repository.database().run(kCannotReadForms, [&](soci::session& session) -> Result<std::string> {
    const std::string key(id);
    if (!read_form(session, "f.id = :k", key)) return tl::unexpected(no_such_form(id).error());
    return write_answers(session, key);
  });
}

}  // namespace trocar::results
