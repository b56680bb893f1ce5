#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "results/repository.h"

namespace trocar::results {

/// Six points, 1 = strongly agree … 6 = strongly disagree (paper B, section 4).
inline constexpr int kScalePoints = 6;
inline constexpr std::size_t kMaxAnswerCharacters = 2000, kMaxIntroCharacters = 2000;
inline constexpr std::size_t kMaxItems = 50;

enum class ItemKind : std::uint8_t { kScale, kText };
const char* to_string(ItemKind kind) noexcept;  ///< "scale", "text".
std::optional<ItemKind> find_item_kind(std::string_view name) noexcept;

struct Item {
  std::string id;  ///< Empty in a new item.
  ItemKind kind = ItemKind::kScale;
  std::string text;
  bool is_required = false;
};

struct Form {
  std::string id;
  std::string token;  ///< Unguessable part of its public address.
  std::string title, intro;
  bool is_open = false;
  std::vector<Item> items;     ///< In order, without retired ones.
  std::int64_t responses = 0;  ///< Filled-in questionnaires.
  Seconds changed{};
};

/// The statements of paper B, section 4, in our words, and a free text; closed, without id.
Form default_form();

/// Error (exit status 2): an empty or too long text, no item, too many.
Result<Form> add_form(Repository& repository, const Form& form, Seconds now);
/// Replaces title, intro, state and items. An item with answers whose text or kind changes, or that is left out, is
/// retired with its answers; its successor begins without any.
Result<Form> change_form(Repository& repository, const Form& form, Seconds now);
Result<std::vector<Form>> list_forms(Repository& repository);  ///< The newest first.
Result<std::optional<Form>> find_form(Repository& repository, std::string_view id);
Result<std::optional<Form>> find_open_form(Repository& repository, std::string_view token);
/// With all its answers.
Status delete_form(Repository& repository, std::string_view id);

struct Answer {
  int points = 0;    ///< 1..6 of a scale; 0: none.
  std::string text;  ///< Of a free text.
};
/// Answers by item id; items without an answer are left out. `person_id` empty: anonymous. `response_id`: repeating the
/// same one changes nothing, so that a page may send it again. Errors (exit status 2) name the item: unknown, out of
/// range, required, too long. Error: the form is closed or unknown.
Status add_response(Repository& repository, std::string_view token, std::string_view response_id,
                    const std::map<std::string, Answer, std::less<>>& answers, std::string_view person_id, Seconds now);

struct Comment {
  std::string text;
  Seconds submitted{};
};
struct ItemSummary {
  Item item;
  bool is_retired = false;
  std::int64_t n = 0;
  std::optional<double> mean, sd;  ///< Of a scale; sd with n - 1.
  std::array<std::int64_t, kScalePoints> counts{};
  std::vector<Comment> comments;
};
struct FormSummary {
  Form form;
  std::vector<ItemSummary> items;
};
Result<std::optional<FormSummary>> summarise_form(Repository& repository, std::string_view id);
/// One row a response, one column an item; safe for spreadsheets.
Result<std::string> answers_csv(Repository& repository, std::string_view id);

}  // namespace trocar::results
