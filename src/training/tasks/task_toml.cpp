#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "config/toml.h"
#include "config/toml_writer.h"
#include "core/files/folders.h"
#include "tasks/detail/task_rules.h"
#include "tasks/task.h"

namespace trocar::tasks {
namespace fs = std::filesystem;
namespace {

constexpr std::array kGuidances{ImagingModality::kUltrasound, ImagingModality::kXray, ImagingModality::kPalpation};

/// Reads the keys of a task file. A complete task must have them all; one with a base has the differing ones.
class TaskReader {
 public:
  TaskReader(const config::TomlTable& document, bool is_whole) : document_(document), is_whole_(is_whole) {}

  Status read(Task& task) const {
    TROCAR_TRY_STATUS(document_.check_keys(
        {"base",  "title",         "organ",   "target_tissues", "needle",       "force_model", "ultrasound_engine",
         "path",  "parenchymal",   "scoring", "risks",          "target",       "entry_zone",  "expert_path",
         "exam",  "breathing_mm",  "needles", "guidance",       "confirmed_by", "phases",      "pain",
         "bevel", "highest_entry", "levels",  "level",          "cores",        "posture",     "harms"}));
    if (!is_whole_) TROCAR_TRY_STATUS(detail::read_level_of(document_, task));  // before keys that replace its numbers
    TROCAR_TRY_STATUS(text(document_, "title", task.title));
    TROCAR_TRY_STATUS(text(document_, "organ", task.organ));
    TROCAR_TRY_STATUS(text(document_, "needle", task.needle));
    TROCAR_TRY(task.force_model, document_.string_or("force_model", task.force_model));
    TROCAR_TRY(task.ultrasound_engine, document_.string_or("ultrasound_engine", task.ultrasound_engine));
    if (task.ultrasound_engine != "raycast" && task.ultrasound_engine != "panorama")
      return fail(fmt::format("there is no ultrasound engine \"{}\"", task.ultrasound_engine), document_.where(),
                  "write raycast or panorama");
    if (document_.has("posture")) {
      TROCAR_TRY(const std::string posture, document_.string("posture"));
      TROCAR_TRY(task.posture, detail::read_posture(posture, document_.where()));
    }
    TROCAR_TRY(task.expert_path, document_.string_or("expert_path", task.expert_path));
    if (is_whole_ || document_.has("target_tissues")) {
      TROCAR_TRY(task.target_tissues, document_.strings("target_tissues"));
    }
    TROCAR_TRY_STATUS(read_path(task));
    TROCAR_TRY_STATUS(read_scoring(task));
    TROCAR_TRY_STATUS(read_risks(task));
    TROCAR_TRY(std::vector<HarmRule> harms, read_harm_rules(document_));
    const std::size_t harm_count = harms.size();
    task.harms.insert(task.harms.begin(), std::make_move_iterator(harms.begin()), std::make_move_iterator(harms.end()));
    TROCAR_TRY_STATUS(read_target(task));
    TROCAR_TRY_STATUS(read_exam(task));
    TROCAR_TRY_STATUS(read_procedure(task));
    TROCAR_TRY_STATUS(detail::read_rules(document_, task));
    if (task.weights.contains("bevel") && !task.bevel)
      return fail("the bevel has a weight and no rule", document_.where(), "give [bevel], or omit the weight");
    TROCAR_TRY_STATUS(check_harms(task, harm_count));
    return is_whole_ ? detail::read_level_of(document_, task) : Status();
  }

 private:
  /// The organ and the target of a task are no harm in it: a row for them would never act.
  Status check_harms(const Task& task, std::size_t count) const {
    for (const HarmRule& rule : std::span(task.harms).first(count)) {
      const auto is_wanted = [&](const std::string& name) {
        return name == task.organ || std::ranges::find(task.target_tissues, name) != task.target_tissues.end();
      };
      const bool is_for_them = rule.name_texts.empty() ? std::ranges::all_of(rule.tissues, is_wanted)
                                                       : std::ranges::all_of(rule.name_texts, is_wanted);
      if (is_for_them)
        return fail("a row of [[harms]] is for the task's organ or target, which are no harm in it", document_.where(),
                    "take the row out, or give a label of it a harm in [[risks]]");
    }
    return {};
  }
  Status text(const config::TomlTable& table, const char* key, std::string& value) const {
    if (!is_whole_ && !table.has(key)) return {};
    TROCAR_TRY(value, table.string(key));
    return {};
  }
  Status number(const config::TomlTable& table, const char* key, config::Range range, double& value) const {
    if (!is_whole_ && !table.has(key)) return {};
    TROCAR_TRY(value, table.number(key, range));
    return {};
  }
  bool lacks(const char* key) const { return !is_whole_ && !document_.has(key); }

  Status read_path(Task& task) const {
    if (!lacks("path")) {
      TROCAR_TRY(const config::TomlTable path, document_.table("path"));
      TROCAR_TRY_STATUS(path.check_keys({"min_organ_path_mm", "max_path_mm", "max_entry_angle_deg", "max_posterior_deg",
                                         "passes", "postures", "least_target_ml", "target_step_mm", "target_below",
                                         "target_away_from", "target_away_mm"}));
      if (path.has("passes")) {
        TROCAR_TRY(task.passes, path.strings("passes"));
      }
      if (path.has("postures")) {
        TROCAR_TRY(task.postures, detail::read_postures(path));
      }
      TROCAR_TRY(task.least_target_ml, path.number_or("least_target_ml", {0.0, 1000.0}, task.least_target_ml));
      TROCAR_TRY(task.target_step_mm, path.number_or("target_step_mm", {0.0, 100.0}, task.target_step_mm));
      TROCAR_TRY(task.target_below, path.string_or("target_below", task.target_below));
      TROCAR_TRY(task.target_away_from, path.string_or("target_away_from", task.target_away_from));
      TROCAR_TRY(task.target_away_mm, path.number_or("target_away_mm", {0.0, 200.0}, task.target_away_mm));
      if (task.target_away_from.empty() != (task.target_away_mm <= 0.0))
        return fail("target_away_from and target_away_mm belong together", path.where(), "give both, or none");
      TROCAR_TRY_STATUS(number(path, "min_organ_path_mm", {0.0, 50.0}, task.min_organ_path_mm));
      TROCAR_TRY_STATUS(number(path, "max_path_mm", {10.0, 300.0}, task.max_path_mm));
      TROCAR_TRY_STATUS(number(path, "max_entry_angle_deg", {5.0, 85.0}, task.max_entry_angle_deg));
      TROCAR_TRY_STATUS(number(path, "max_posterior_deg", {0.0, 90.0}, task.max_posterior_deg));
    }
    if (lacks("parenchymal")) return {};
    TROCAR_TRY(const config::TomlTable parenchymal, document_.table("parenchymal"));
    TROCAR_TRY_STATUS(parenchymal.check_keys({"depth_mm", "vessel_mm"}));
    TROCAR_TRY_STATUS(number(parenchymal, "depth_mm", {0.0, 100.0}, task.parenchymal_depth_mm));
    return number(parenchymal, "vessel_mm", {0.0, 50.0}, task.parenchymal_vessel_mm);
  }

  Status read_scoring(Task& task) const {
    if (lacks("scoring")) return {};
    TROCAR_TRY(const config::TomlTable scoring, document_.table("scoring"));
    TROCAR_TRY_STATUS(
        scoring.check_keys({"target_tolerance_mm", "entry_tolerance_mm", "angle_tolerance_deg", "time_limit_s",
                            "dose_limit_gycm2", "margin_tolerance_mm", "pass_mark", "weights"}));
    TROCAR_TRY(task.margin_tolerance_mm,
               scoring.number_or("margin_tolerance_mm", {0.1, 50.0}, task.margin_tolerance_mm));
    TROCAR_TRY(task.pass_mark, scoring.number_or("pass_mark", {0.0, 100.0}, task.pass_mark));
    TROCAR_TRY_STATUS(number(scoring, "target_tolerance_mm", {0.1, 100.0}, task.target_tolerance_mm));
    TROCAR_TRY_STATUS(number(scoring, "entry_tolerance_mm", {0.1, 200.0}, task.entry_tolerance_mm));
    TROCAR_TRY_STATUS(number(scoring, "angle_tolerance_deg", {0.1, 90.0}, task.angle_tolerance_deg));
    TROCAR_TRY(task.dose_limit_gycm2, scoring.number_or("dose_limit_gycm2", {0.0, 1000.0}, task.dose_limit_gycm2));
    TROCAR_TRY_STATUS(number(scoring, "time_limit_s", {1.0, 3600.0}, task.time_limit_s));
    return read_weights(scoring, task);
  }

  Status read_weights(const config::TomlTable& scoring, Task& task) const {
    if (!is_whole_ && !scoring.has("weights")) return {};
    TROCAR_TRY(const config::TomlTable table, scoring.table("weights"));
    TROCAR_TRY_STATUS(table.check_keys({kScoreParts.begin(), kScoreParts.end()}));
    task.weights.clear();
    double sum = 0.0;
    for (const std::string& part : table.keys()) {
      TROCAR_TRY(const double weight, table.number(part, {0.0, 100.0}));
      sum += weight;
      if (weight > 0.0) task.weights[part] = weight;
    }
    if (std::abs(sum - 100.0) > 1e-6)
      return fail(fmt::format("the weights add up to {:g}", sum), table.where(), "let them add up to 100");
    if (task.weights.contains("dose") && task.dose_limit_gycm2 <= 0.0)
      return fail("the dose has a weight and no limit", scoring.where(), "give dose_limit_gycm2");
    return {};
  }

  Status read_procedure(Task& task) const {
    if (document_.has("cores")) {
      TROCAR_TRY(const std::int64_t cores, document_.integer("cores", {1.0, 10.0}));
      task.cores = static_cast<std::size_t>(cores);
    }
    if (document_.has("needles")) {
      TROCAR_TRY(task.needles, document_.strings("needles"));
    }
    if (document_.has("guidance")) {
      TROCAR_TRY(const std::string name, document_.string("guidance"));
      const auto found = std::find_if(kGuidances.begin(), kGuidances.end(),
                                      [&](ImagingModality guidance) { return name == to_string(guidance); });
      if (found == kGuidances.end())
        return fail(fmt::format("there is no guidance \"{}\"", name), document_.where(),
                    "write ultrasound, xray or palpation");
      task.guidance = *found;
    }
    if (document_.has("confirmed_by")) {
      TROCAR_TRY(const std::string name, document_.string("confirmed_by"));
      const auto substance = find_substance(name);
      if (!substance)
        return fail(fmt::format("there is no substance \"{}\"", name), document_.where(),
                    "write one of data/substances.toml: csf, bile, ascites …");
      task.confirmed_by = *substance;
    }
    if (document_.has("phases")) {
      TROCAR_TRY(task.phases, read_phases(document_));
    }
    if (task.weights.contains("confirmation") && task.confirmed_by == Substance::kNothing)
      return fail("the confirmation has a weight and nothing confirms the target", document_.where(),
                  "give confirmed_by, or omit the weight");
    TROCAR_TRY(task.breathing_mm, document_.number_or("breathing_mm", {0.0, 40.0}, task.breathing_mm));
    return read_pain(task);
  }

  Status read_pain(Task& task) const {
    if (!document_.has("pain")) return {};
    TROCAR_TRY(const config::TomlTable pain, document_.table("pain"));
    TROCAR_TRY_STATUS(pain.check_keys({"tissues", "needs_anaesthesia"}));
    if (pain.has("tissues")) {
      TROCAR_TRY(task.pain.tissues, pain.strings("tissues"));
    }
    TROCAR_TRY(task.pain.needs_anaesthesia, pain.boolean_or("needs_anaesthesia", task.pain.needs_anaesthesia));
    return {};
  }

  Status read_risks(Task& task) const {
    if (!document_.has("risks")) return {};
    TROCAR_TRY(const std::vector<config::TomlTable> rows, document_.tables("risks"));
    task.risks.clear();
    for (const config::TomlTable& row : rows) {
      TROCAR_TRY_STATUS(row.check_keys({"tissue", "label", "margin_mm", "penalty", "optional", "critical", "harm"}));
      RiskStructure risk;
      TROCAR_TRY(risk.tissue, row.string_or("tissue", ""));
      TROCAR_TRY(risk.label, row.string_or("label", ""));
      if (risk.tissue.empty() == risk.label.empty())
        return fail("a risk structure is named by its tissue or its label", row.where(), "give one of the two");
      TROCAR_TRY(risk.margin_mm, row.number("margin_mm", {0.0, 50.0}));
      TROCAR_TRY(risk.is_optional, row.boolean_or("optional", false));
      TROCAR_TRY_STATUS(read_harm_of(row, risk));
      task.risks.push_back(std::move(risk));
    }
    return {};
  }

  /// `critical` and `penalty` are those of files of older programs: the first is a harm, the second is not used any
  /// more.
  Status read_harm_of(const config::TomlTable& row, RiskStructure& risk) const {
    TROCAR_TRY(const bool is_critical, row.boolean_or("critical", false));
    if (is_critical) risk.harm = Harm::kCritical;
    TROCAR_TRY_STATUS(row.number_or("penalty", {0.0, 100.0}, 0.0));
    if (!row.has("harm")) return {};
    if (is_critical) return fail("harm and critical contradict each other", row.where(), "write harm alone");
    TROCAR_TRY(const std::string name, row.string("harm"));
    risk.harm = find_harm_grade(name);
    if (!risk.harm)
      return fail(fmt::format("harm = \"{}\" is no grade of harm", name), row.where(),
                  "write none, minor, major or critical");
    return {};
  }

  Status read_target(Task& task) const {
    if (!document_.has("target")) return {};
    TROCAR_TRY(const config::TomlTable target, document_.table("target"));
    TROCAR_TRY_STATUS(target.check_keys({"label", "point_mm"}));
    TROCAR_TRY(task.target_label, target.string_or("label", ""));
    if (target.has("point_mm")) {
      TROCAR_TRY(task.target_P, detail::read_point(target, "point_mm"));
    }
    return {};
  }

  Status read_exam(Task& task) const {
    if (!document_.has("exam")) return {};
    TROCAR_TRY(const config::TomlTable exam, document_.table("exam"));
    TROCAR_TRY_STATUS(exam.check_keys({"shows_needle"}));
    TROCAR_TRY(task.exam_shows_needle, exam.boolean_or("shows_needle", task.exam_shows_needle));
    return {};
  }

  const config::TomlTable& document_;
  bool is_whole_;
};

Result<Task> read_whole_task(const config::TomlTable& document, const std::string& name, const fs::path& tasks_folder) {
  Task task;
  task.name = name;
  TROCAR_TRY(task.harms, load_harm_table(tasks_folder.parent_path() / kHarmFile));
  TROCAR_TRY_STATUS(TaskReader(document, true).read(task));
  return task;
}

Result<Task> read_whole_task(const fs::path& path) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(path));
  if (document.has("base"))
    return fail("a task of this folder has no base", path.string(),
                "write the complete task, or move the file to a patient folder");
  return read_whole_task(document, path.stem().string(), path.parent_path());
}

Result<Task> read_task(const config::TomlTable& document, const std::string& name, const fs::path& tasks_folder) {
  if (!document.has("base")) return read_whole_task(document, name, tasks_folder);
  TROCAR_TRY(const std::string base, document.string("base"));
  TROCAR_TRY(Task task, load_task(tasks_folder, base));
  TROCAR_TRY_STATUS(TaskReader(document, false).read(task));
  return task;
}

Result<std::vector<fs::path>> task_files(const fs::path& folder) {
  auto files = list_folder(folder);
  if (!files)
    return fail("the tasks cannot be listed: " + files.error().what, folder.string(),
                "set TROCAR_DATA_DIR to the folder data");
  std::erase_if(*files, [](const fs::path& file) { return file.extension() != ".toml"; });
  return files;
}

/// Writes the keys with different values in two tasks; a table only if it has such keys.
class DifferenceWriter {
 public:
  void begin_table(std::string_view name) { table_ = name; }
  void set(std::string_view key, const config::TomlValue& value) {
    if (!table_.empty()) writer_.begin_table({table_});
    table_ = {};
    writer_.set(key, value);
  }
  template <class T>
  void set_changed(std::string_view key, const T& value, const T& base) {
    if (value != base) set(key, value);
  }
  void set_point(std::string_view key, const Vec3& p) { set(key, std::vector<double>(p.begin(), p.end())); }
  config::TomlWriter& writer() { return writer_; }

 private:
  config::TomlWriter writer_;
  std::string_view table_;  ///< Not yet written.
};

void write_risk(config::TomlWriter& writer, const RiskStructure& risk) {
  writer.begin_row("risks");
  writer.set(risk.tissue.empty() ? "label" : "tissue", risk.tissue.empty() ? risk.label : risk.tissue);
  writer.set("margin_mm", risk.margin_mm);
  if (risk.is_optional) writer.set("optional", true);
  if (risk.harm) writer.set("harm", to_string(*risk.harm));
}

void write_harm(config::TomlWriter& writer, const HarmRule& rule) {
  writer.begin_row("harms");
  if (!rule.name_texts.empty()) writer.set("names", rule.name_texts);
  if (!rule.tissues.empty()) writer.set("tissues", rule.tissues);
  writer.set("grade", to_string(rule.grade));
  if (rule.notch) writer.set("notch", to_string(*rule.notch));
  if (rule.stay) {
    writer.set("stay", to_string(*rule.stay));
    writer.set("stay_s", rule.stay_s);
  }
  writer.set("reason", rule.reason);
  if (!rule.source.empty()) writer.set("source", rule.source);
}

}  // namespace

Result<std::vector<Task>> load_tasks(const fs::path& tasks_folder) {
  TROCAR_TRY(const std::vector<fs::path> files, task_files(tasks_folder));
  std::vector<Task> tasks;
  for (const fs::path& file : files) {
    TROCAR_TRY(Task task, read_whole_task(file));
    tasks.push_back(std::move(task));
  }
  return tasks;
}

Result<Task> load_task(const fs::path& tasks_folder, std::string_view name) {
  TROCAR_TRY(const std::vector<fs::path> files, task_files(tasks_folder));
  std::vector<std::string> names;
  for (const fs::path& file : files) {
    if (file.stem().string() == name) return read_whole_task(file);
    names.push_back(file.stem().string());
  }
  return fail_usage(fmt::format("there is no task \"{}\"", name), tasks_folder.string(),
                    fmt::format("known are: {}", fmt::join(names, ", ")));
}

Result<Task> load_task_file(const fs::path& file, const fs::path& tasks_folder) {
  TROCAR_TRY(const config::TomlTable document, config::load_toml(file));
  return read_task(document, file.stem().string(), tasks_folder);
}

Result<Task> parse_task(std::string_view text, const std::string& name, const std::string& where,
                        const fs::path& tasks_folder) {
  TROCAR_TRY(const config::TomlTable document, config::parse_toml(text, where));
  return read_task(document, name, tasks_folder);
}

std::string task_to_toml(const Task& task, const Task& base) {
  DifferenceWriter keys;
  keys.writer().comment("A task made for one patient: what differs from its base.");
  keys.set("base", base.name);
  keys.set_changed("title", task.title, base.title);
  keys.set_changed("organ", task.organ, base.organ);
  keys.set_changed("needle", task.needle, base.needle);
  keys.set_changed("force_model", task.force_model, base.force_model);
  keys.set_changed("breathing_mm", task.breathing_mm, base.breathing_mm);
  keys.set_changed("ultrasound_engine", task.ultrasound_engine, base.ultrasound_engine);
  keys.set_changed("expert_path", task.expert_path, base.expert_path);
  keys.set_changed("target_tissues", task.target_tissues, base.target_tissues);
  keys.set_changed("needles", task.needles, base.needles);
  if (task.cores != base.cores) keys.set("cores", static_cast<std::int64_t>(task.cores));
  keys.set_changed("level", task.level, base.level);
  if (task.posture && task.posture != base.posture) keys.set("posture", std::string(posture_name(*task.posture)));
  if (task.guidance != base.guidance) keys.set("guidance", to_string(task.guidance));
  if (task.confirmed_by != base.confirmed_by) keys.set("confirmed_by", to_string(task.confirmed_by));
  if (task.phases.empty() && !base.phases.empty()) keys.set("phases", std::vector<std::string>());
  const bool has_same_risks = task.risks == base.risks;
  if (!has_same_risks && task.risks.empty()) keys.set("risks", std::vector<std::string>());
  keys.begin_table("path");
  keys.set_changed("min_organ_path_mm", task.min_organ_path_mm, base.min_organ_path_mm);
  keys.set_changed("max_path_mm", task.max_path_mm, base.max_path_mm);
  keys.set_changed("max_entry_angle_deg", task.max_entry_angle_deg, base.max_entry_angle_deg);
  keys.set_changed("max_posterior_deg", task.max_posterior_deg, base.max_posterior_deg);
  keys.set_changed("passes", task.passes, base.passes);
  keys.set_changed("postures", detail::names_of(task.postures), detail::names_of(base.postures));
  keys.set_changed("least_target_ml", task.least_target_ml, base.least_target_ml);
  keys.set_changed("target_step_mm", task.target_step_mm, base.target_step_mm);
  keys.set_changed("target_below", task.target_below, base.target_below);
  keys.set_changed("target_away_from", task.target_away_from, base.target_away_from);
  keys.set_changed("target_away_mm", task.target_away_mm, base.target_away_mm);
  keys.begin_table("parenchymal");
  keys.set_changed("depth_mm", task.parenchymal_depth_mm, base.parenchymal_depth_mm);
  keys.set_changed("vessel_mm", task.parenchymal_vessel_mm, base.parenchymal_vessel_mm);
  keys.begin_table("scoring");
  keys.set_changed("target_tolerance_mm", task.target_tolerance_mm, base.target_tolerance_mm);
  keys.set_changed("entry_tolerance_mm", task.entry_tolerance_mm, base.entry_tolerance_mm);
  keys.set_changed("angle_tolerance_deg", task.angle_tolerance_deg, base.angle_tolerance_deg);
  keys.set_changed("time_limit_s", task.time_limit_s, base.time_limit_s);
  keys.set_changed("dose_limit_gycm2", task.dose_limit_gycm2, base.dose_limit_gycm2);
  keys.set_changed("margin_tolerance_mm", task.margin_tolerance_mm, base.margin_tolerance_mm);
  keys.set_changed("pass_mark", task.pass_mark, base.pass_mark);
  if (task.weights != base.weights) {
    std::vector<config::TomlValue::Entry> weights;
    for (const auto& [part, weight] : task.weights) weights.push_back({part, weight});
    keys.set("weights", config::TomlValue(weights));
  }
  keys.begin_table("pain");
  keys.set_changed("tissues", task.pain.tissues, base.pain.tissues);
  keys.set_changed("needs_anaesthesia", task.pain.needs_anaesthesia, base.pain.needs_anaesthesia);
  keys.begin_table("exam");
  keys.set_changed("shows_needle", task.exam_shows_needle, base.exam_shows_needle);
  keys.begin_table("target");
  keys.set_changed("label", task.target_label, base.target_label);
  if (task.target_P) keys.set_point("point_mm", *task.target_P);
  detail::write_rules(keys.writer(), task, base);
  if (task.phases != base.phases) write_phases(keys.writer(), task.phases);
  if (!has_same_risks)
    for (const RiskStructure& risk : task.risks) write_risk(keys.writer(), risk);
  // The task's own rows stand before those of the base.
  for (std::size_t n = 0; n + base.harms.size() < task.harms.size(); ++n) write_harm(keys.writer(), task.harms[n]);
  return keys.writer().text();
}

}  // namespace trocar::tasks
