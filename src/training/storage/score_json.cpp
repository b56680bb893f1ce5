#include "storage/score_json.h"

#include <cmath>
#include <limits>

#include "config/json.h"

namespace trocar::storage {
namespace {

config::Json vector_json(const Vec3& v) {
  return config::Json::array({v.x(), v.y(), v.z()});
}

config::Json parts_json(const std::vector<scoring::ScorePart>& parts) {
  config::Json all = config::Json::array();
  for (const scoring::ScorePart& part : parts) {
    all.push_back({{"name", part.name},
                   {"title", part.title},
                   {"value", part.value},
                   {"unit", part.unit},
                   {"points", part.points},
                   {"max_points", part.max_points}});
    if (!part.is_judged) all.back()["judged"] = false;
  }
  return all;
}

config::Json harms_json(const std::vector<metrics::HarmEvent>& harms) {
  config::Json all = config::Json::array();
  for (const metrics::HarmEvent& event : harms)
    all.push_back({{"label", event.label},
                   {"grade", to_string(event.grade)},
                   {"graze", event.is_graze},
                   {"by_stylet", event.is_by_stylet},
                   {"by_notch", event.is_by_notch},
                   {"stayed", event.has_stayed},
                   {"inside_mm", event.inside_mm},
                   {"depth_mm", event.depth_mm},
                   {"begin_s", event.begin_s},
                   {"worst_s", event.worst_s},
                   {"stayed_s", event.stayed_s},
                   {"reason", event.reason}});
  return all;
}

config::Json bleeding_json(const scoring::Bleeding& bleeding) {
  return {{"risk", to_string(bleeding.risk)}, {"reasons", bleeding.reasons}, {"passes", bleeding.passes}};
}

}  // namespace

config::Json core_json(const scoring::BiopsyCore& core) {
  config::Json pieces = config::Json::array();
  for (const scoring::CorePiece& piece : core.pieces)
    pieces.push_back(
        {{"label", piece.label}, {"tissue", piece.tissue}, {"from_mm", piece.from_mm}, {"to_mm", piece.to_mm}});
  return {{"tip_P", vector_json(core.tip_P)},
          {"axis_P", vector_json(core.axis_P)},
          {"pieces", std::move(pieces)},
          {"target_mm", core.target_mm},
          {"organ_mm", core.organ_mm},
          {"vessel_mm", core.vessel_mm},
          {"other_mm", core.other_mm},
          {"risks_in_throw", core.risks_in_throw},
          {"time_s", core.time_s}};
}

config::Json outcome_json(const scoring::Outcome& outcome) {
  config::Json cores = config::Json::array();
  for (const scoring::BiopsyCore& core : outcome.cores) cores.push_back(core_json(core));
  return {{"score", outcome.is_scored() ? config::Json(outcome.score) : config::Json(nullptr)},
          {"not_scored", config::or_null(outcome.not_scored)},
          {"target_reached", outcome.target_reached},
          {"passed", outcome.is_passed},
          {"fails", outcome.fails},
          {"parts", parts_json(outcome.parts)},
          {"harms", harms_json(outcome.harms)},
          {"risks_touched", outcome.risks_touched},
          {"cores", std::move(cores)},
          {"bleeding", outcome.bleeding ? bleeding_json(*outcome.bleeding) : config::Json(nullptr)}};
}

}  // namespace trocar::storage

namespace trocar::storage::detail {
namespace {

/// Reads the members of one object; a missing member or a wrong type makes the whole reading fail.
class Reader {
 public:
  explicit Reader(const config::Json& object, bool& is_valid) : object_(object), is_valid_(is_valid) {}

  double number(const char* key) {
    const config::Json* member = find(key);
    return member != nullptr ? number_of(*member) : 0.0;
  }
  /// A whole number from 0 to `most`.
  std::size_t count(const char* key, double most) {
    const double value = number(key);
    if (!(value >= 0.0 && value <= most && value == std::floor(value))) return is_valid_ = false, 0;
    return static_cast<std::size_t>(value);
  }
  bool boolean(const char* key) {
    const config::Json* member = find(key);
    return is_kind(member, config::Json::value_t::boolean) && member->get<bool>();
  }
  std::string text(const char* key) {
    const config::Json* member = find(key);
    return is_kind(member, config::Json::value_t::string) ? member->get<std::string>() : std::string();
  }
  std::vector<std::string> texts(const char* key) {
    std::vector<std::string> list;
    for (const config::Json& item : array(key))
      if (is_kind(&item, config::Json::value_t::string)) list.push_back(item.get<std::string>());
    return list;
  }
  Vec3 vector(const char* key) {
    const config::Json& items = array(key);
    if (items.size() != 3) return is_valid_ = false, Vec3::Zero();
    return {number_of(items[0]), number_of(items[1]), number_of(items[2])};
  }
  const config::Json& array(const char* key) {
    static const config::Json kEmpty = config::Json::array();
    const config::Json* member = find(key);
    return is_kind(member, config::Json::value_t::array) ? *member : kEmpty;
  }

 private:
  const config::Json* find(const char* key) {
    const auto found = object_.find(key);
    if (found == object_.end()) return is_valid_ = false, nullptr;
    return &*found;
  }
  bool is_kind(const config::Json* value, config::Json::value_t kind) {
    if (value == nullptr || value->type() != kind) is_valid_ = false;
    return is_valid_;
  }
  double number_of(const config::Json& value) {
    if (value.is_null()) return std::numeric_limits<double>::quiet_NaN();
    if (!value.is_number()) return is_valid_ = false, 0.0;
    return value.get<double>();
  }

  const config::Json& object_;
  bool& is_valid_;
};

scoring::BiopsyCore read_core(const config::Json& object, bool& is_valid) {
  Reader reader(object, is_valid);
  scoring::BiopsyCore core;
  core.tip_P = reader.vector("tip_P");
  core.axis_P = reader.vector("axis_P");
  for (const config::Json& item : reader.array("pieces")) {
    Reader piece(item, is_valid);
    core.pieces.push_back({piece.text("label"), piece.text("tissue"), piece.number("from_mm"), piece.number("to_mm")});
  }
  core.target_mm = reader.number("target_mm");
  core.organ_mm = reader.number("organ_mm");
  core.vessel_mm = reader.number("vessel_mm");
  core.other_mm = reader.number("other_mm");
  core.risks_in_throw = reader.texts("risks_in_throw");
  if (object.contains("time_s")) core.time_s = reader.number("time_s");
  return core;
}

scoring::Bleeding read_bleeding(const config::Json& object, bool& is_valid) {
  Reader reader(object, is_valid);
  scoring::Bleeding bleeding;
  const auto risk = scoring::find_bleeding_risk(reader.text("risk"));
  if (!risk) is_valid = false;
  bleeding.risk = risk.value_or(scoring::BleedingRisk::kUsual);
  bleeding.reasons = reader.texts("reasons");
  bleeding.passes = reader.count("passes", 1e9);
  return bleeding;
}

metrics::HarmEvent read_harm(const config::Json& object, bool& is_valid) {
  Reader reader(object, is_valid);
  metrics::HarmEvent event;
  event.label = reader.text("label");
  const auto grade = tasks::find_harm_grade(reader.text("grade"));
  if (!grade) is_valid = false;
  event.grade = grade.value_or(tasks::Harm::kMinor);
  event.is_graze = reader.boolean("graze");
  event.is_by_stylet = reader.boolean("by_stylet");
  event.is_by_notch = reader.boolean("by_notch");
  event.has_stayed = reader.boolean("stayed");
  event.inside_mm = reader.number("inside_mm");
  event.depth_mm = reader.number("depth_mm");
  event.begin_s = reader.number("begin_s");
  event.worst_s = reader.number("worst_s");
  event.stayed_s = reader.number("stayed_s");
  event.reason = reader.text("reason");
  return event;
}

/// The metrics that have a value.
config::Json metrics_json(const std::vector<metrics::MetricValue>& values) {
  config::Json all = config::Json::array();
  for (const metrics::MetricValue& value : values)
    if (value.value) all.push_back({{"name", value.name}, {"value", *value.value}, {"unit", value.unit}});
  return all;
}

/// What sessions of older programs lack.
void read_judgement(const config::Json& object, scoring::Outcome& outcome, bool& is_valid) {
  Reader reader(object, is_valid);
  outcome.is_passed = reader.boolean("passed");
  outcome.fails = reader.texts("fails");
  outcome.expert = reader.count("expert", 1e6);
  for (const config::Json& item : reader.array("metrics")) {
    Reader metric(item, is_valid);
    outcome.measures.push_back({metric.text("name"), metric.number("value"), metric.text("unit"), {}, {}, {}});
  }
  outcome.pain_events = reader.count("pain_events", 1e9);
  const config::Json& times = reader.array("hint_times_s");
  if (times.size() != outcome.hints.size()) is_valid = false;
  for (std::size_t n = 0; n < std::min(times.size(), outcome.hints.size()); ++n) {
    if (times[n].is_number()) outcome.hints[n].at_s = times[n].get<double>();
    if (!times[n].is_number() && !times[n].is_null()) is_valid = false;
  }
}

}  // namespace

std::string outcome_to_json(const scoring::Outcome& outcome) {
  config::Json hints = config::Json::array(), hint_times = config::Json::array();
  for (const scoring::Hint& hint : outcome.hints) {
    hints.push_back(hint.text);
    hint_times.push_back(hint.at_s ? config::Json(*hint.at_s) : config::Json(nullptr));
  }
  config::Json object = storage::outcome_json(outcome);
  object["score"] = outcome.score;
  for (const char* member : {"not_scored", "bleeding", "cores"})
    if (object[member].is_null() || object[member].empty()) object.erase(member);
  object["hints"] = std::move(hints);
  object["hint_times_s"] = std::move(hint_times);
  object["expert"] = outcome.expert;
  object["pain_events"] = outcome.pain_events;
  object["metrics"] = metrics_json(outcome.measures);
  return object.dump(-1, ' ', false, config::Json::error_handler_t::replace);
}

Result<scoring::Outcome> outcome_from_json(std::string_view text, const std::string& where) {
  TROCAR_TRY(const config::Json object, config::parse_json(text, where));
  bool is_valid = true;
  Reader reader(object, is_valid);
  scoring::Outcome outcome;
  outcome.score = reader.number("score");
  outcome.target_reached = reader.boolean("target_reached");
  for (const config::Json& item : reader.array("parts")) {
    Reader part(item, is_valid);
    outcome.parts.push_back({part.text("name"), part.text("title"), part.number("value"), part.text("unit"),
                             part.number("points"), part.number("max_points"),
                             !item.contains("judged") || part.boolean("judged")});
  }
  for (std::string& hint : reader.texts("hints")) outcome.hints.push_back({std::move(hint), {}});
  if (object.contains("passed")) read_judgement(object, outcome, is_valid);
  outcome.risks_touched = reader.texts("risks_touched");
  if (object.contains("harms"))
    for (const config::Json& harm : reader.array("harms")) outcome.harms.push_back(read_harm(harm, is_valid));
  if (object.contains("not_scored")) outcome.not_scored = reader.text("not_scored");
  if (object.contains("cores"))
    for (const config::Json& core : reader.array("cores")) outcome.cores.push_back(read_core(core, is_valid));
  if (const auto core = object.find("core"); core != object.end())  // of an older program
    outcome.cores.push_back(read_core(*core, is_valid));
  if (const auto bleeding = object.find("bleeding"); bleeding != object.end())
    outcome.bleeding = read_bleeding(*bleeding, is_valid);
  if (!is_valid) return fail("the session's outcome is damaged", where, "record the session again");
  return outcome;
}

}  // namespace trocar::storage::detail
