#include "cases/prepare_case.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "anatomy/known_structures.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/log.h"
#include "core/random.h"
#include "motion/breathing_choice.h"
#include "motion/patient_motion.h"
#include "phantom/phantom.h"
#include "tasks/assess_path.h"
#include "tasks/fit_to_patient.h"

namespace trocar::cases {
namespace {
namespace fs = std::filesystem;

Status read_task_file(Case& made, const fs::path& file, const fs::path& tasks_folder) {
  TROCAR_TRY(made.task, tasks::load_task_file(file, tasks_folder));
  TROCAR_TRY(made.task_toml, read_file(file));
  return {};
}

Status find_task(Case& made, const CaseOptions& options, const fs::path& tasks_folder) {
  if (options.task.ends_with(".toml")) return read_task_file(made, options.task, tasks_folder);
  if (!options.task.empty()) {
    TROCAR_TRY(made.task, tasks::load_task(tasks_folder, options.task));
    return {};
  }
  if (has_own_task(options.patient_folder))
    return read_task_file(made, fs::path(options.patient_folder) / tasks::kOwnTaskFile, tasks_folder);
  std::error_code ignored;
  const bool is_known = options.patient_folder.empty() || fs::exists(options.patient_folder, ignored) ||
                        phantom::find_embedded_patient(options.patient_folder).has_value();
  if (!is_known)
    return fail_usage("no such patient", options.patient_folder, "name a patient folder, or see trocar patient list");
  return fail_usage("the patient has no task of its own", options.patient_folder, "name a task, see trocar task list");
}

/// Applies the level of the options, and notes it in the text from which a replay makes the task again.
Status apply_level(Case& made, const std::string& level) {
  if (level.empty()) return {};
  TROCAR_TRY(made.task, tasks::at_level(std::move(made.task), level));
  if (made.task_toml.empty()) made.task_toml = fmt::format("base = \"{}\"\n", made.task.name);
  made.task_toml = fmt::format("level = \"{}\"\n", made.task.level) + made.task_toml;
  return {};
}

/// Notes the posture in the text from which a replay makes the task again.
void note_posture(Case& made, anatomy::Posture posture) {
  made.task.posture = posture;
  if (made.task_toml.empty()) made.task_toml = fmt::format("base = \"{}\"\n", made.task.name);
  made.task_toml = fmt::format("posture = \"{}\"\n", anatomy::posture_name(posture)) + made.task_toml;
}

/// The posture of the options.
Status apply_posture(Case& made, const std::string& name) {
  if (name.empty()) return {};
  const auto posture = anatomy::find_posture(name);
  if (!posture)
    return fail_usage("there is no such posture", name, "give supine, prone, left-lateral, right-lateral or sitting");
  const std::vector<anatomy::Posture>& allowed = made.task.postures;
  if (!allowed.empty() && std::ranges::find(allowed, *posture) == allowed.end()) {
    std::vector<std::string_view> names;
    for (const anatomy::Posture one : allowed) names.push_back(anatomy::posture_name(one));
    return fail_usage(
        fmt::format("the task {} is not done with the patient {}", made.task.name, anatomy::posture_words(*posture)),
        name, fmt::format("choose one of: {}", fmt::join(names, ", ")));
  }
  if (made.task.posture == posture) return {};
  if (made.task.posture)
    return fail_usage(fmt::format("the task {} has a posture of its own: {}", made.task.name,
                                  anatomy::posture_name(*made.task.posture)),
                      name, "omit --posture");
  note_posture(made, *posture);
  return {};
}

bool advances_wire(const tasks::Task& task) {
  return std::ranges::any_of(task.phases, [](const tasks::Phase& phase) {
    return std::ranges::any_of(phase.done, [](const auto& done) { return done.kind == tasks::ConditionKind::kWire; });
  });
}

/// The needle of the options, if the task allows it.
Result<tasks::Needle> find_needle(const tasks::Task& task, const std::string& wanted, const fs::path& file) {
  TROCAR_TRY(tasks::Needle needle, tasks::load_needle(file, wanted.empty() ? task.needle : wanted));
  if (wanted.empty() || wanted == task.needle) return needle;
  TROCAR_TRY(const std::vector<tasks::Needle> all, tasks::load_needles(file));
  const std::vector<std::string> allowed = tasks::allowed_needles(task, all);
  if (std::ranges::find(allowed, wanted) != allowed.end()) return needle;
  return fail_usage(fmt::format("the task {} is not done with the needle {}", task.name, wanted), "needle",
                    fmt::format("choose one of: {}", fmt::join(allowed, ", ")));
}

/// Tissues that a task names have to exist: a misspelt one would be a rule that never acts.
Status check_tissues(const Case& made, const fs::path& usual_tissues) {
  std::vector<std::string> named = made.task.target_tissues;
  named.insert(named.end(), made.task.passes.begin(), made.task.passes.end());
  named.insert(named.end(), made.task.pain.tissues.begin(), made.task.pain.tissues.end());
  for (const tasks::RiskStructure& risk : made.task.risks)
    if (!risk.tissue.empty()) named.push_back(risk.tissue);
  for (const tasks::HarmRule& rule : made.task.harms)
    named.insert(named.end(), rule.tissues.begin(), rule.tissues.end());
  for (const std::string& tissue : named) {
    if (made.tissues.find_tissue(tissue)) continue;
    TROCAR_TRY(const anatomy::TissueTable usual, anatomy::load_tissue_table(usual_tissues, {}));
    if (usual.find_tissue(tissue)) continue;  // a table of an older patient lacks it
    std::vector<std::string> known;
    for (const anatomy::TissueParams& one : usual.tissues) known.push_back(one.name);
    return fail(fmt::format("there is no tissue \"{}\"", tissue), "task " + made.task.name,
                fmt::format("write one of: {}", fmt::join(known, ", ")));
  }
  return {};
}

/// A structure that neither the patient nor structures.toml has may be of other patients, or misspelt: then its rule
/// never acts.
Status warn_of_unknown_names(const tasks::Task& task, const anatomy::VirtualPatient& patient) {
  TROCAR_TRY(const fs::path data, checked_data_dir());
  TROCAR_TRY(const anatomy::KnownStructures known, anatomy::KnownStructures::load(data));
  std::vector<std::string> named;
  for (const tasks::RiskStructure& risk : task.risks)
    if (!risk.label.empty()) named.push_back(risk.label);
  for (const tasks::HarmRule& rule : task.harms)
    for (const std::string& name : rule.name_texts)
      if (!name.ends_with('*') && !name.ends_with('#')) named.push_back(name);
  const auto lacks_tissue = [&](const std::string& tissue) {
    return std::ranges::none_of(patient.label_table.labels, [&](const auto& label) { return label.tissue == tissue; });
  };
  const auto tell = [&](const std::string& tissue) {
    if (lacks_tissue(tissue))
      log_warning("task {}: no structure of this patient is of the tissue {}: its harm has no effect", task.name,
                  tissue);
  };
  for (const tasks::RiskStructure& risk : task.risks)
    if (risk.harm && !risk.tissue.empty()) tell(risk.tissue);
  for (const tasks::HarmRule& rule : task.harms)
    if (rule.is_own) std::ranges::for_each(rule.tissues, tell);
  for (const std::string& name : named) {
    const auto is_it = [&](const anatomy::Label& label) {
      return anatomy::plain_name(label.name) == anatomy::plain_name(name);
    };
    if (known.find(name) != nullptr || std::ranges::any_of(patient.label_table.labels, is_it)) continue;
    const std::vector<std::string> similar = known.similar_names(name, 1);
    log_warning("task {}: no structure is known as {}: its risk or harm has no effect in this patient{}", task.name,
                name, similar.empty() ? "" : fmt::format("; perhaps {} is meant", similar.front()));
  }
  return {};
}

/// Of the options, else of the task. An attempt begins anywhere in a breath.
Result<motion::MotionDrive> breathing_in(const tasks::Task& task, const anatomy::VirtualPatient& patient,
                                         const CaseOptions& options) {
  constexpr std::uint64_t kOfBegin = 0x62656769;
  const bool is_of_task = options.breathing.empty() && !options.held_phase;
  if (is_of_task && task.breathing_mm > 0.0 && patient.motion == nullptr)
    log_info("{} has no motion model and does not breathe; trocar patient motion makes one", patient.name);
  std::string text = options.breathing;
  if (is_of_task && task.breathing_mm > 0.0 && patient.motion != nullptr) text = fmt::format("{}", task.breathing_mm);
  TROCAR_TRY(motion::MotionDrive drive, breathing_of(patient, text, options.held_phase, options.seed));
  if (motion::moves(drive)) drive.begins_s = -uniform01(options.seed, kOfBegin) * drive.period_s;
  return drive;
}

/// The path named by the task, measured like a planned one. Its faults are reported, but do not prevent the attempt.
Result<tasks::PlannedPath> find_expert_path(const Case& the_case, const anatomy::VirtualPatient& patient) {
  const std::string& name = the_case.task.expert_path;
  for (const anatomy::NeedlePath& path : patient.paths) {
    if (path.name != name) continue;
    const tasks::PathAssessment assessment = tasks::assess_path(the_case.task, patient, the_case.needle, path.line_P);
    for (const tasks::PathFinding& finding : assessment.findings) log_warning("expert path {}: {}", name, finding.text);
    return assessment.path;
  }
  return fail(fmt::format("the expert path \"{}\" is not among the patient's paths", name), patient.name,
              "draw it again in the case builder, or take expert_path out of the task");
}

/// Behind a thick abdominal wall: the shortest needle of the task that reaches the end of its expert path. The case's
/// own if it reaches, or none does.
Result<tasks::Needle> find_reaching_needle(const Case& the_case, const anatomy::VirtualPatient& patient) {
  const auto path = std::ranges::find(patient.paths, the_case.task.expert_path, &anatomy::NeedlePath::name);
  if (path == patient.paths.end() || the_case.needle.is_biopsy) return the_case.needle;
  TROCAR_TRY(const fs::path data, checked_data_dir());
  TROCAR_TRY(std::vector<tasks::Needle> needles, tasks::load_needles(data / "needles.toml"));
  const std::vector<std::string> allowed = tasks::allowed_needles(the_case.task, needles);
  std::erase_if(needles, [&](const tasks::Needle& n) { return std::ranges::find(allowed, n.name) == allowed.end(); });
  std::ranges::sort(needles, {}, &tasks::Needle::length_mm);
  needles.insert(needles.begin(), the_case.needle);
  const auto reaches = [&](const tasks::Needle& needle) {
    const auto findings = tasks::assess_path(the_case.task, patient, needle, path->line_P).findings;
    return std::ranges::none_of(findings, [](const auto& f) { return f.fault == tasks::PathFault::kTooLong; });
  };
  const auto found = std::ranges::find_if(needles, reaches);
  return found == needles.end() ? the_case.needle : *found;
}

/// The first path that the patient brings for the task (NeedlePath::name); nullptr: none. A biopsy needle is fired
/// before the target, so that its path is planned for the needle.
const anatomy::NeedlePath* path_for(const Case& the_case, const anatomy::VirtualPatient& patient) {
  if (the_case.needle.is_biopsy) return nullptr;
  for (const anatomy::NeedlePath& path : patient.paths)
    if (tasks::is_path_for(the_case.task, path)) return &path;
  return nullptr;
}

}  // namespace

std::vector<tasks::PlannedPath> find_experts(const Case& the_case, const anatomy::VirtualPatient& patient) {
  std::vector<tasks::PlannedPath> experts{the_case.plan};
  if (the_case.needle.is_biopsy) return experts;
  for (const anatomy::NeedlePath& path : patient.paths) {
    const bool is_ours = tasks::is_path_for(the_case.task, path) && path.name != the_case.task.expert_path;
    if (is_ours) experts.push_back(tasks::assess_path(the_case.task, patient, the_case.needle, path.line_P).path);
  }
  return experts;
}

std::string with_body(const std::string& patient, const tasks::Tier& level) {
  std::string source = patient;
  for (const auto& [key, factor] : level.body)
    source += fmt::format("{}{}={}", source.size() == patient.size() ? phantom::kBodySign : ',', key, factor);
  return source;
}

bool has_own_task(const std::string& patient_folder) {
  std::error_code ignored;
  return !patient_folder.empty() && fs::is_regular_file(fs::path(patient_folder) / tasks::kOwnTaskFile, ignored);
}

bool has_own_tissues(const std::string& patient_folder) {
  std::error_code ignored;
  return !patient_folder.empty() && fs::is_regular_file(fs::path(patient_folder) / kOwnTissueFile, ignored);
}

Result<anatomy::TissueTable> load_own_tissues(const std::string& patient_folder) {
  TROCAR_TRY(anatomy::TissueTable table, anatomy::load_tissue_table(fs::path(patient_folder) / kOwnTissueFile));
  table.origin = table.origin.empty() ? "the patient's own table" : "the patient's own table: " + table.origin;
  return table;
}

Result<motion::MotionDrive> breathing_of(const anatomy::VirtualPatient& patient, const std::string& text,
                                         const std::optional<double>& held_phase, std::uint64_t seed) {
  if (text.empty() && !held_phase) return motion::MotionDrive();
  TROCAR_TRY(motion::BreathingChoice choice, motion::parse_breathing(text.empty() ? "quiet" : text));
  if (!choice.seed) choice.seed = static_cast<std::uint32_t>(seed);
  if (choice.liver_mm == 0.0 && held_phase)
    return fail_usage("a patient who does not breathe has no phase", "--phase", "choose a breath with --breathing");
  if (choice.liver_mm == 0.0) return motion::MotionDrive();
  if (patient.motion == nullptr)
    return fail_usage("the patient has no breathing model", patient.name,
                      "make one with trocar patient motion DIR, or let the patient rest: --breathing none");
  TROCAR_TRY(motion::MotionDrive drive, motion::drive_of(choice, *patient.motion));
  drive.is_held = held_phase.has_value();
  drive.held_phase = held_phase.value_or(0.0);
  return drive;
}

Result<Case> load_tables(const CaseOptions& options) {
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  Case made;
  TROCAR_TRY_STATUS(find_task(made, options, data / "tasks"));
  TROCAR_TRY_STATUS(apply_level(made, options.level));
  TROCAR_TRY_STATUS(apply_posture(made, options.posture));
  TROCAR_TRY(made.needle, find_needle(made.task, options.needle, data / "needles.toml"));
  if (made.needle.is_biopsy && made.task.confirmed_by != tasks::Substance::kNothing)
    return fail(fmt::format("the task {} is confirmed by {}, and the needle {} takes cores", made.task.name,
                            tasks::substance_words(made.task.confirmed_by), made.needle.name),
                "task " + made.task.name, "take confirmed_by out, or choose a needle with a stylet");
  TROCAR_TRY(made.substances, tasks::load_substances(data / "substances.toml"));
  const bool is_own = options.tissue_file.empty() && options.profile.empty() && has_own_tissues(options.patient_folder);
  const fs::path tissues = options.tissue_file.empty() ? data / "tissues.toml" : fs::path(options.tissue_file);
  TROCAR_TRY(made.tissues,
             is_own ? load_own_tissues(options.patient_folder) : anatomy::load_tissue_table(tissues, options.profile));
  for (const std::string& assignment : options.overrides)
    TROCAR_TRY_STATUS(anatomy::apply_override(made.tissues, assignment));
  TROCAR_TRY_STATUS(check_tissues(made, data / "tissues.toml"));
  return made;
}

Result<Case> prepare_case(std::shared_ptr<const anatomy::VirtualPatient> patient, const CaseOptions& options,
                          const Progress& progress) {
  TROCAR_TRY(Case made, load_tables(options));
  TROCAR_TRY(made.breathing, breathing_in(made.task, *patient, options));
  made.task = tasks::fit_to_patient(std::move(made.task), *patient);
  const tasks::TaskReadiness readiness = tasks::check_task(made.task, *patient);
  if (!readiness.is_possible)
    return fail(
        fmt::format("the patient does not support the task {}: {}", made.task.name, fmt::join(readiness.reasons, "; ")),
        patient->name, "see trocar patient check");
  TROCAR_TRY_STATUS(warn_of_unknown_names(made.task, *patient));
  for (const std::string& rule : tasks::unserved_rules(made.task, *patient))
    log_warning("task {}, patient {}: {}", made.task.name, patient->name, rule);
  made.is_parenchymal = readiness.is_parenchymal;
  const anatomy::NeedlePath* brought = path_for(made, *patient);
  if (made.task.expert_path.empty() && brought != nullptr) made.task.expert_path = brought->name;
  if (!made.task.expert_path.empty()) {
    if (options.needle.empty()) {
      TROCAR_TRY(made.needle, find_reaching_needle(made, *patient));
    }
    TROCAR_TRY(made.plan, find_expert_path(made, *patient));
  } else {
    TROCAR_TRY(const auto paths, tasks::plan_paths(made.task, *patient, made.needle, {1, options.seed}, progress));
    made.plan = paths.front();
    if (made.plan.posture != patient->posture && !made.task.posture) note_posture(made, made.plan.posture);
  }
  made.experts = find_experts(made, *patient);
  log_info("expert path: {:.1f} mm, {:.1f} mm of it in the organ, {:.1f} mm to spare from {}", made.plan.length_mm,
           made.plan.organ_path_mm, made.plan.spare_margin_mm, made.plan.nearest_risk);
  if (advances_wire(made.task)) made.ducts = std::make_shared<const xray::DuctTree>(xray::make_duct_tree(*patient));
  made.patient = std::move(patient);
  return made;
}

}  // namespace trocar::cases
