#include "results/detail/details_json.h"

#include <algorithm>
#include <cmath>

#include "config/json.h"

namespace trocar::results::detail {
namespace {

constexpr double kPerMm = 100.0, kPerN = 1000.0, kPerSecond = 1000.0;
constexpr const char* kImportAgain = "import the session file again";

std::string dump(const config::Json& json) {
  return json.dump(-1, ' ', false, config::Json::error_handler_t::replace);
}

/// NaN becomes null.
config::Json scaled(const std::vector<double>& values, double factor) {
  config::Json list = config::Json::array();
  for (const double value : values)
    if (std::isfinite(value)) {
      list.push_back(std::llround(value * factor));
    } else {
      list.push_back(nullptr);
    }
  return list;
}

bool read_scaled(const config::Json& json, const char* key, double factor, std::vector<double>& values) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_array()) return false;
  for (const config::Json& value : *found) {
    if (!value.is_number() && !value.is_null()) return false;
    values.push_back(value.is_null() ? std::nan("") : value.get<double>() / factor);
  }
  return true;
}

bool read_point(const config::Json& json, const char* key, std::array<double, 3>& point) {
  std::vector<double> values;
  if (!read_scaled(json, key, kPerMm, values) || values.size() != point.size()) return false;
  std::copy(values.begin(), values.end(), point.begin());
  return true;
}

bool read_texts(const config::Json& json, const char* key, std::vector<std::string>& texts) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_array()) return false;
  for (const config::Json& text : *found) {
    if (!text.is_string()) return false;
    texts.push_back(text.get<std::string>());
  }
  return true;
}

bool read_tissues(const config::Json& json, Trace& trace) {
  std::vector<double> indices;
  if (!read_scaled(json, "tissue", 1.0, indices) || !read_texts(json, "tissues", trace.tissues)) return false;
  for (const double index : indices) {
    if (!(index >= 0.0 && index < static_cast<double>(trace.tissues.size()))) return false;
    trace.tissue.push_back(static_cast<int>(index));
  }
  return true;
}

bool read_events(const config::Json& json, Trace& trace) {
  std::vector<double> times;
  std::vector<std::string> texts;
  if (!read_scaled(json, "event_time", kPerSecond, times) || !read_texts(json, "events", texts)) return false;
  if (times.size() != texts.size()) return false;
  for (std::size_t n = 0; n < times.size(); ++n) trace.events.push_back({times[n], texts[n]});
  return true;
}

}  // namespace

std::string verdict_json(const AttemptRecord& record) {
  config::Json hints = config::Json::array();
  for (const Hint& hint : record.hints)
    hints.push_back({{"text", hint.text}, {"at_s", hint.at_s ? config::Json(*hint.at_s) : config::Json(nullptr)}});
  return dump({{"not_scored", record.not_scored}, {"fails", record.fails}, {"hints", std::move(hints)}});
}

Status read_verdict(std::string_view text, AttemptRecord& record) {
  TROCAR_TRY(const config::Json json, config::parse_json(text, record.attempt.id));
  const auto hints = json.find("hints"), reason = json.find("not_scored");
  if (!read_texts(json, "fails", record.fails) || hints == json.end() || !hints->is_array() || reason == json.end() ||
      !reason->is_string())
    return fail("the verdict of the attempt is damaged", record.attempt.id, kImportAgain);
  record.not_scored = reason->get<std::string>();
  for (const config::Json& hint : *hints) {
    const auto hint_text = hint.find("text"), at = hint.find("at_s");
    if (hint_text == hint.end() || !hint_text->is_string())
      return fail("a hint of the attempt is damaged", record.attempt.id, kImportAgain);
    const bool has_time = at != hint.end() && at->is_number();
    record.hints.push_back({hint_text->get<std::string>(), has_time ? std::optional(at->get<double>()) : std::nullopt});
  }
  return {};
}

std::string trace_json(const Trace& trace) {
  std::vector<double> event_times;
  config::Json events = config::Json::array();
  for (const Trace::Event& event : trace.events) {
    event_times.push_back(event.time_s);
    events.push_back(event.text);
  }
  const auto point = [](const std::array<double, 3>& p) { return scaled({p[0], p[1], p[2]}, kPerMm); };
  return dump({{"rate_hz", trace.rate_hz},
               {"time", scaled(trace.time_s, kPerSecond)},
               {"x", scaled(trace.tip_mm[0], kPerMm)},
               {"y", scaled(trace.tip_mm[1], kPerMm)},
               {"z", scaled(trace.tip_mm[2], kPerMm)},
               {"depth", scaled(trace.depth_mm, kPerMm)},
               {"force", scaled(trace.force_n, kPerN)},
               {"tissue", trace.tissue},
               {"tissues", trace.tissues},
               {"entry", point(trace.plan_entry_mm)},
               {"target", point(trace.plan_target_mm)},
               {"event_time", scaled(event_times, kPerSecond)},
               {"events", std::move(events)}});
}

Result<Trace> read_trace(std::string_view text) {
  TROCAR_TRY(const config::Json json, config::parse_json(text, "trace"));
  Trace trace;
  const auto rate = json.find("rate_hz");
  const bool is_read =
      rate != json.end() && rate->is_number() && read_scaled(json, "time", kPerSecond, trace.time_s) &&
      read_scaled(json, "x", kPerMm, trace.tip_mm[0]) && read_scaled(json, "y", kPerMm, trace.tip_mm[1]) &&
      read_scaled(json, "z", kPerMm, trace.tip_mm[2]) && read_scaled(json, "depth", kPerMm, trace.depth_mm) &&
      read_scaled(json, "force", kPerN, trace.force_n) && read_tissues(json, trace) &&
      read_point(json, "entry", trace.plan_entry_mm) && read_point(json, "target", trace.plan_target_mm) &&
      read_events(json, trace);
  const std::size_t size = trace.time_s.size();
  const bool is_even = trace.tip_mm[0].size() == size && trace.tip_mm[1].size() == size &&
                       trace.tip_mm[2].size() == size && trace.depth_mm.size() == size &&
                       trace.force_n.size() == size && trace.tissue.size() == size;
  if (!is_read || !is_even) return fail("the path of the attempt is damaged", {}, kImportAgain);
  trace.rate_hz = rate->get<double>();
  return trace;
}

}  // namespace trocar::results::detail
