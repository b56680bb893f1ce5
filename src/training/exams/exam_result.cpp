#include "exams/exam_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "anatomy/phantom/phantom.h"
#include "config/json.h"
#include "core/files/atomic_file.h"
#include "core/files/data_dir.h"
#include "core/files/input_file.h"
#include "core/files/list_folder.h"
#include "core/version.h"
#include "exams/exam_body.h"
#include "haptics/force_version.h"
#include "io/patient/patient_source.h"
#include "learning/history.h"
#include "signing/sha256.h"
#include "storage/score_json.h"
#include "storage/session_file.h"

namespace trocar::exams {
namespace fs = std::filesystem;
namespace {

using config::Json;

constexpr const char* kFormat = "trocar exam result 1";
constexpr const char* kAdvice = "name a .result.json file of an exam";

/// The one form of a result: any other text is a changed one.
std::string canonical_text(const Json& json) {
  return config::json_text(json) + "\n";
}

const anatomy::PhantomInfo* find_embedded(const std::string& name) {
  for (const anatomy::PhantomInfo& info : anatomy::embedded_patients())
    if (info.name == name) return &info;
  return nullptr;
}

/// Numbers of the tissue table and options that were changed, at the begin or during the attempt.
std::vector<std::string> changed_settings(const storage::Session& session) {
  std::vector<std::string> changes;
  for (const storage::SessionParameters& parameters : session.parameters)
    changes.insert(changes.end(), parameters.settings.begin(), parameters.settings.end());
  return changes;
}

bool was_known(const storage::SessionInfo& info, const learning::PastAttempt& exam,
               std::span<const learning::PastAttempt> history) {
  if (io::is_path(info.patient_source) || info.patient_seed == kPractisedNumber) return true;
  std::vector<learning::PastAttempt> earlier;
  std::copy_if(history.begin(), history.end(), std::back_inserter(earlier),
               [&](const learning::PastAttempt& attempt) { return attempt.when < exam.when; });
  return is_known_body(earlier, info.patient_source, info.patient_seed);
}

Json describe(const storage::Session& session, bool is_known) {
  const storage::SessionInfo& info = session.info;
  const scoring::Outcome& outcome = *session.outcome;
  const anatomy::PhantomInfo* embedded = find_embedded(info.patient_source);
  return {{"format", kFormat},
          {"program_version", info.program_version},
          {"force_version", info.force_version},
          {"task", info.task},
          {"patient", info.patient_source},
          {"patient_hash", info.patient_hash},
          {"exam_number", embedded != nullptr ? Json(info.patient_seed) : Json(nullptr)},
          {"difficulty", embedded != nullptr ? Json(embedded->difficulty) : Json(nullptr)},
          {"body_was_known", is_known},
          {"level", info.level},
          {"operator", info.operator_name},
          {"device", info.device},
          {"started_utc", info.started_utc},
          {"changed_settings", changed_settings(session)},
          {"score", outcome.is_scored() ? Json(outcome.score) : Json(nullptr)},
          {"not_scored", outcome.not_scored},
          {"passed", outcome.is_passed},
          {"fails", outcome.fails},
          {"parts", storage::parts_json(outcome.parts)}};
}

Status check_exam(const storage::Session& session, const fs::path& file) {
  if (session.info.level != learning::to_string(learning::Level::kExam))
    return fail_usage(session.info.level.empty()
                          ? "the session is no exam: it has no level of help"
                          : fmt::format("the session is no exam: its level is {}", session.info.level),
                      file.string(), "sign sessions of the trainer at the level exam");
  if (session.is_incomplete || !session.outcome)
    return fail("the exam was interrupted and has no result", file.string(), "repeat the exam with another number");
  return {};
}

std::string text_at(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

/// Empty: it is the signed one, or `note` says that it could not be checked.
std::string fault_of_session(const fs::path& result, const Json& json, std::string& note) {
  const std::string name = text_at(json, "session");
  if (name.empty() || fs::path(name).filename() != name) return "it names no session";
  const fs::path session = result.parent_path() / name;
  std::error_code error;
  if (!fs::exists(session, error)) {
    note = fmt::format("; the session {} is not beside it and was not checked", name);
    return {};
  }
  const auto digest = signing::sha256_of_session(session);
  if (!digest) return digest.error().text();
  return *digest == text_at(json, "session_sha256") ? std::string()
                                                    : fmt::format("the session {} is not the signed one", name);
}

/// What is not as in this program; empty: everything is.
std::string other_version(const Json& json) {
  const std::string version = text_at(json, "program_version");
  if (version != kVersion) return fmt::format("by program version {}, this is {}", version, kVersion);
  const auto forces = json.find("force_version");
  if (forces == json.end() || *forces != haptics::kForceVersion)
    return fmt::format("with version {} of the forces, this program has version {}",
                       forces == json.end() ? "1" : forces->dump(), haptics::kForceVersion);
  const auto digest = digest_of_data(data_dir());
  if (digest && *digest == text_at(json, "data_sha256")) return {};
  return "with other data tables than those of this program";
}

std::string summary(const Json& json) {
  const Json score = json.value("score", Json(nullptr));
  return fmt::format("{}, {} {}, {}, {}", text_at(json, "started_utc"), text_at(json, "task"), text_at(json, "patient"),
                     score.is_number() ? fmt::format("{:.0f} points", score.get<double>()) : "not scored",
                     json.value("passed", Json(false)) == Json(true) ? "passed" : "not passed");
}

}  // namespace

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

Result<fs::path> sign_exam(const fs::path& session_file, std::span<const learning::PastAttempt> history,
                           const signing::SigningKey& key) {
  const fs::path out = result_file_of(session_file);
  std::error_code error;
  if (fs::exists(fs::symlink_status(out, error)))
    return fail_usage("the exam is signed already", out.string(), "verify it with trocar exam verify");
  // The digest first: a session that changes meanwhile does not fit its signature.
  TROCAR_TRY(const std::string digest, signing::sha256_of_session(session_file));
  TROCAR_TRY(const storage::Session session, storage::load_session(session_file));
  TROCAR_TRY_STATUS(check_exam(session, session_file));
  TROCAR_TRY(const learning::PastAttempt exam, learning::attempt_of({session.info, session.outcome}));
  TROCAR_TRY(const std::string data, digest_of_data(data_dir()));
  Json json = describe(session, was_known(session.info, exam, history));
  json["data_sha256"] = data;
  json["session"] = session_file.filename().string();
  json["session_sha256"] = digest;
  json["public_key"] = signing::to_hex(key.public_key());
  json["signature"] = signing::to_hex(key.sign(canonical_text(json)));
  TROCAR_TRY_STATUS(write_file_atomically(out, canonical_text(json)));
  return out;
}

Result<Verification> verify_exam(const fs::path& result, const signing::PublicKey& key) {
  TROCAR_TRY(const std::string text, read_input(result, FileKind::kJson));
  const auto parsed = config::parse_json(text, result.string());
  if (!parsed || !parsed->is_object() || !parsed->contains("format"))
    return fail_usage("is no result of an exam", result.string(), kAdvice);
  if (text_at(*parsed, "format") != kFormat)
    return fail_usage("has a format that this program does not know", result.string(), kAdvice);
  if (text_at(*parsed, "public_key") != signing::to_hex(key))
    return Verification{Verdict::kOtherKey,
                        fmt::format("other key: it names the key {}", text_at(*parsed, "public_key"))};
  Json json = *parsed;
  const auto signature = signing::parse_signature(text_at(json, "signature"));
  const bool is_canonical = canonical_text(json) == text;
  json.erase("signature");
  if (!signature || !is_canonical || !signing::is_signed_by(key, canonical_text(json), *signature))
    return Verification{Verdict::kChanged, "changed: the text is not the signed one"};
  std::string note;
  if (const std::string fault = fault_of_session(result, json, note); !fault.empty())
    return Verification{Verdict::kChanged, "changed: " + fault};
  const std::string other = other_version(json);
  return Verification{other.empty() ? Verdict::kValid : Verdict::kOtherVersion,
                      fmt::format("valid{}: {}{}", other.empty() ? "" : ", signed " + other, summary(json), note)};
}

}  // namespace trocar::exams
