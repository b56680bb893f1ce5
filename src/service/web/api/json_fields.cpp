#include "web/api/json_fields.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/text.h"
#include "learning/curriculum.h"
#include "tasks/task.h"

namespace trocar::web {

Result<std::string> text_field(const Json& body, const char* name, std::size_t most_bytes) {
  if (!body.is_object() || !body.contains(name)) return fail_usage("a field is missing", name, "send it as a text");
  const Json& field = body.at(name);
  if (!field.is_string()) return fail_usage("a field is not a text", name, "send it as a text");
  const auto& text = field.get_ref<const std::string&>();
  if (text.size() > most_bytes) return fail_usage("a text is too long", name, "shorten it");
  if (valid_utf8(text) != text) return fail_usage("a text is not UTF-8", name, "write it again");
  return text;
}

Result<std::string> text_field_or_empty(const Json& body, const char* name, std::size_t most_bytes) {
  if (body.is_object() && (!body.contains(name) || body.at(name).is_null())) return std::string();
  return text_field(body, name, most_bytes);
}

Status check_fields(const Json& body, std::span<const std::string_view> names) {
  if (!body.is_object()) return fail_usage("it is not an object", {}, "send an object of JSON");
  for (const auto& [name, value] : body.items())
    if (std::ranges::find(names, name) == names.end())
      return fail_usage("there is no such field", name,
                        names.empty() ? "send an empty object" : fmt::format("send {}", fmt::join(names, ", ")));
  return {};
}

double rounded(double value) noexcept {
  constexpr double kThousand = 1000.0;
  return std::round(value * kThousand) / kThousand;
}

std::int64_t seconds_of(results::Seconds time) noexcept {
  return time.time_since_epoch().count();
}

namespace {

Json numbers(const std::vector<double>& values) {
  Json list = Json::array();
  for (const double value : values) list.push_back(std::isfinite(value) ? Json(rounded(value)) : Json(nullptr));
  return list;
}

}  // namespace

Json note_json(const results::Note& note) {
  return {{"id", note.id}, {"author", note.author}, {"text", note.text}, {"written_s", seconds_of(note.written)}};
}

Json trace_json(const results::Trace& trace) {
  Json events = Json::array();
  for (const results::Trace::Event& event : trace.events)
    events.push_back({{"time_s", rounded(event.time_s)}, {"text", event.text}});
  return {{"rate_hz", trace.rate_hz},
          {"time_s", numbers(trace.time_s)},
          {"tip_x_mm", numbers(trace.tip_mm[0])},
          {"tip_y_mm", numbers(trace.tip_mm[1])},
          {"tip_z_mm", numbers(trace.tip_mm[2])},
          {"depth_mm", numbers(trace.depth_mm)},
          {"force_n", numbers(trace.force_n)},
          {"tissue", trace.tissue},
          {"tissues", trace.tissues},
          {"plan", {{"entry", trace.plan_entry_mm}, {"target", trace.plan_target_mm}}},
          {"events", std::move(events)}};
}

Result<Titles> Titles::load(const std::filesystem::path& data_folder) {
  Titles titles;
  TROCAR_TRY(const std::vector<tasks::Task> tasks, tasks::load_tasks(data_folder / "tasks"));
  for (const tasks::Task& task : tasks) titles.tasks_.push_back({task.name, task.title});
  for (const metrics::MetricDescription& metric : metrics::metric_catalogue()) {
    titles.position_.emplace(metric.name, titles.metrics_.size());
    titles.metrics_.push_back({metric.name, metric.title, metric.unit, metric.better});
  }
  TROCAR_TRY(const learning::LearningRules rules, learning::load_rules(data_folder / learning::kRulesFile));
  titles.proficiency_ = {rules.mastery_score, rules.passes_in_a_row};
  return titles;
}

std::string Titles::task_title(std::string_view id) const {
  for (const Task& task : tasks_)
    if (task.id == id) return task.title;
  return std::string(id);
}

Titles::Metric Titles::metric(std::string_view name, std::string_view unit) const {
  if (name == score_.name) return score_;
  const auto found = position_.find(name);
  if (found != position_.end()) return metrics_[found->second];
  return {std::string(name), std::string(name), std::string(unit), metrics::Better::kNeither};
}

std::size_t Titles::order_of(std::string_view name) const {
  const auto found = position_.find(name);
  return found == position_.end() ? metrics_.size() : found->second;
}

const char* to_string(metrics::Better better) noexcept {
  switch (better) {
    case metrics::Better::kLower:
      return "lower";
    case metrics::Better::kHigher:
      return "higher";
    case metrics::Better::kNeither:
      break;
  }
  return "neither";
}

}  // namespace trocar::web
