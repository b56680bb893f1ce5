#include "cli/session/run_results.h"

#include "cli/results/commands.h"
#include "core/log.h"
#include "core/version.h"
#include "io/patient/patient_folder.h"
#include "results/sessions.h"

namespace trocar::cli {
namespace {

Result<learning::Curriculum> curriculum() {
  TROCAR_TRY(const std::filesystem::path tasks, find_data("tasks"));
  return learning::load_curriculum(tasks.parent_path());
}

}  // namespace

Result<results::Repository> open_for_person(const std::string& person, const std::string& url,
                                            attempt::RunOptions& run) {
  TROCAR_TRY(results::Repository repository, open_results(url, database::Missing::kRefuse));
  TROCAR_TRY(const results::Person found, results::get_person_named(repository, person));
  if (!found.is_simulated)
    log_warning(
        "{} is not marked as simulated: the scripted operator's attempt counts as if {} had made it. People whose "
        "attempts are scripted are added with trocar results add --simulated",
        found.name, found.name);
  run.person_id = found.id;
  run.attempt_id = results::make_id();
  return repository;
}

Status record_begin(results::Repository& repository, const cases::Case& the_case, const attempt::RunOptions& run) {
  storage::SessionInfo info;
  info.attempt_id = run.attempt_id;
  info.person_id = run.person_id;
  info.task = the_case.task.name;
  info.patient_name = the_case.patient->name;
  info.patient_source = io::absolute_source(run.patient_source);
  info.patient_hash = the_case.patient->content_hash;
  info.patient_seed = run.patient_seed;
  info.operator_name = run.operator_name;
  info.program_version = kVersion;
  TROCAR_TRY(const learning::Curriculum known, curriculum());
  results::Attempt attempt = results::begun_attempt(info, known);
  attempt.started = now_s();
  return results::begin_attempt(repository, attempt);
}

Status record_end(results::Repository& repository, const attempt::RunOptions& run) {
  TROCAR_TRY(const learning::Curriculum known, curriculum());
  TROCAR_TRY_STATUS(results::import_session(repository, run.session, run.person_id, known));
  return {};
}

}  // namespace trocar::cli
