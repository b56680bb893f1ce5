#include "exams/exam_seal.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>

#include "config/json.h"
#include "core/files/folders.h"
#include "core/files/input_file.h"
#include "core/files/output_file.h"
#include "learning/history.h"
#include "phantom/phantom.h"
#include "signing/token.h"
#include "storage/score_json.h"

namespace trocar::exams {
namespace fs = std::filesystem;
namespace {

using config::Json;

constexpr const char* kAnotherExam = "repeat the exam with another number";

/// Numbers of the tissue table and options that were changed, at the begin or during the attempt.
std::vector<std::string> changed_settings(const storage::Session& session) {
  std::vector<std::string> changes;
  for (const storage::SessionParameters& parameters : session.parameters)
    changes.insert(changes.end(), parameters.settings.begin(), parameters.settings.end());
  return changes;
}

Json outcome_json(const scoring::Outcome& outcome) {
  Json all = storage::outcome_json(outcome);
  return {{"score", std::move(all["score"])},
          {"not_scored", outcome.not_scored},
          {"passed", std::move(all["passed"])},
          {"fails", std::move(all["fails"])},
          {"parts", std::move(all["parts"])}};
}

Json describe(const storage::Session& session, const ExamEnd& end) {
  const storage::SessionInfo& info = session.info;
  const std::optional<phantom::PhantomInfo> embedded = phantom::find_embedded_patient(info.patient_source);
  const char* const checked_by = end.person.has_given_pin ? "PIN" : "nothing";
  Json json = {{"format", kSealFormat},
               {"attempt_id", info.attempt_id},
               {"person", config::or_null(end.person.name)},
               {"person_id", config::or_null(end.person.id)},
               {"person_checked_by", end.person.id.empty() ? Json(nullptr) : Json(checked_by)},
               {"program_version", info.program_version},
               {"force_version", info.force_version},
               {"data_sha256", end.data_sha256},
               {"task", info.task},
               {"patient", info.patient_source},
               {"patient_seed", info.patient_seed},
               {"patient_hash", info.patient_hash},
               {"exam_number", embedded.has_value() ? Json(info.patient_seed) : Json(nullptr)},
               {"difficulty", embedded.has_value() ? Json(embedded->difficulty) : Json(nullptr)},
               {"level", info.level},
               {"operator", info.operator_name},
               {"device", info.device},
               {"started_utc", info.started_utc},
               {"sealed_utc", fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::chrono::system_clock::now()))},
               {"changed_settings", changed_settings(session)}};
  json.update(outcome_json(end.outcome));
  json["ticks_hash"] = session.ticks_hash;
  return json;
}

/// What the file says differently than the memory of the program that wrote it; empty: nothing.
std::string difference(const storage::Session& session, const ExamEnd& end) {
  const storage::SessionInfo &file = session.info, &own = end.info;
  if (file.attempt_id != own.attempt_id) return "the attempt";
  if (file.person_id != end.person.id) return "the person";
  if (file.task != own.task) return "the task";
  if (file.patient_source != own.patient_source || file.patient_seed != own.patient_seed ||
      file.patient_hash != own.patient_hash)
    return "the body";
  if (file.level != own.level) return "the level";
  if (file.program_version != own.program_version) return "the program version";
  if (session.ticks_hash.empty() || session.ticks_hash != end.ticks_hash) return "the motion";
  // As texts: a number that is none equals itself there.
  if (canonical_text(outcome_json(*session.outcome)) != canonical_text(outcome_json(end.outcome))) return "the outcome";
  return {};
}

/// The digest is that of the whole recording only if nothing is beside the file.
Status check_single(const fs::path& file) {
  const std::vector<fs::path> files = storage::session_files(file);
  std::error_code error;
  for (std::size_t n = 1; n < files.size(); ++n)
    if (fs::exists(files[n], error))
      return fail("the session is in use by another program and cannot be sealed", files[n].string(),
                  "close the other program; " + std::string(kAnotherExam));
  return {};
}

Status check_tables(const std::string& at_begin) {
  TROCAR_TRY(const std::string now, digest_of_data(data_dir()));
  if (now != at_begin)
    return fail("the data tables were changed during the exam", data_dir().string(),
                "leave them alone while exams run; " + std::string(kAnotherExam));
  return {};
}

}  // namespace

fs::path seal_file_of(const fs::path& session) {
  return fs::path(session).replace_extension(".seal.json");
}

fs::path result_file_of(const fs::path& session) {
  return fs::path(session).replace_extension(".result.json");
}

Result<std::string> digest_of_data(const fs::path& data_folder) {
  std::map<std::string, std::string> digests;  // by name
  const auto files = list_tree(data_folder);
  if (!files) return fail("cannot be read: " + files.error().what, data_folder.string(), "set TROCAR_DATA_DIR");
  for (const fs::path& file : *files) {
    if (file.extension() != ".toml") continue;
    TROCAR_TRY(const std::string text, read_input(file, FileKind::kToml));
    digests[file.lexically_relative(data_folder).generic_string()] = signing::sha256(text);
  }
  std::string list;
  for (const auto& [name, digest] : digests) list += digest + "  " + name + "\n";
  return signing::sha256(list);
}

Result<storage::SessionSummary> load_exam(const fs::path& session) {
  TROCAR_TRY(storage::SessionSummary summary, storage::load_summary(session));
  const std::string& level = summary.info.level;
  if (level != learning::to_string(learning::TrainingMode::kExam))
    return fail_usage(level.empty() ? "the session is no exam: it has no level of help"
                                    : fmt::format("the session is no exam: its level is {}", level),
                      session.string(), "name a session of the trainer at the level exam");
  if (summary.is_incomplete())
    return fail("the exam was interrupted and has no result", session.string(), kAnotherExam);
  return summary;
}

Result<fs::path> seal_exam(const fs::path& session_file, const ExamEnd& end, const signing::SigningKey& key) {
  const fs::path out = seal_file_of(session_file);
  std::error_code error;
  if (fs::exists(fs::symlink_status(out, error)))
    return fail_usage("the exam is sealed already", out.string(), "make its result with trocar exam sign");
  TROCAR_TRY_STATUS(check_single(session_file));
  // The digest first: a session that changes meanwhile does not fit its seal.
  TROCAR_TRY(const std::string digest, signing::sha256_of_session(session_file));
  TROCAR_TRY_STATUS(load_exam(session_file));
  TROCAR_TRY(const storage::Session session, storage::load_session(session_file));
  if (const std::string other = difference(session, end); !other.empty())
    return fail(fmt::format("the session was changed while it was recorded: {} differs", other), session_file.string(),
                kAnotherExam);
  TROCAR_TRY_STATUS(check_tables(end.data_sha256));
  Json json = describe(session, end);
  json["session_sha256"] = digest;
  sign_json(json, key);
  TROCAR_TRY_STATUS(write_file_atomically(out, canonical_text(json)));
  return out;
}

Result<Json> check_seal(const fs::path& session, const signing::PublicKey& key) {
  const fs::path file = seal_file_of(session);
  std::error_code error;
  if (!fs::exists(file, error))
    return fail("the exam has no seal", file.string(),
                "only the trainer seals an exam, when the attempt ends; put the seal back beside the session, or "
                "repeat the exam");
  TROCAR_TRY(const std::string text, read_input(file, FileKind::kJson));
  auto json = config::parse_json(text, file.string());
  if (!json || !json->is_object() || text_at(*json, "format") != kSealFormat)
    return fail("is no seal of an exam that this program knows", file.string(), "restore the seal of the trainer");
  if (text_at(*json, "public_key") != signing::to_hex(key))
    return fail("the exam was sealed by another station", file.string(), "sign it on the station of the exam");
  if (!is_signed_text(text, *json, key))
    return fail("the seal was changed", file.string(), "restore the seal of the trainer, or repeat the exam");
  TROCAR_TRY_STATUS(check_single(session));
  TROCAR_TRY(const std::string digest, signing::sha256_of_session(session));
  if (digest != text_at(*json, "session_sha256"))
    return fail("the session is not the sealed one: it was changed or replaced after the attempt", session.string(),
                "restore the session that the trainer wrote, or repeat the exam");
  return json;
}

std::string canonical_text(const Json& json) {
  return config::json_text(json) + "\n";
}

void sign_json(Json& json, const signing::SigningKey& key) {
  json.erase("signature");
  json["public_key"] = signing::to_hex(key.public_key());
  json["signature"] = signing::to_hex(key.sign(canonical_text(json)));
}

bool is_signed_text(const std::string& text, const Json& json, const signing::PublicKey& key) {
  const auto signature = signing::parse_signature(text_at(json, "signature"));
  if (!signature || canonical_text(json) != text) return false;
  Json content = json;
  content.erase("signature");
  return signing::is_signed_by(key, canonical_text(content), *signature);
}

std::string text_at(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

}  // namespace trocar::exams
