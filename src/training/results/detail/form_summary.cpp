#include <fmt/chrono.h>
#include <fmt/format.h>

#include <cmath>
#include <map>

#include "results/csv_text.h"
#include "results/detail/form_tables.h"

namespace trocar::results::detail {
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
    row.push_back(csv_text(summary.item.text));
  }
  std::string text = csv_row(row);
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
      if (!current.empty()) text += csv_row(row);
      current = response;
      row.assign(items.size() + 1, "");
      row[0] = fmt::format("{:%FT%TZ}", fmt::gmtime(static_cast<std::time_t>(submitted_s)));
    }
    if (const auto column = columns.find(item); column != columns.end())
      row[column->second] = points > 0 ? std::to_string(points) : csv_text(answer);
  }
  if (!current.empty()) text += csv_row(row);
  return text;
}

}  // namespace trocar::results::detail
