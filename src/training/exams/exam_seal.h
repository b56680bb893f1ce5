#pragma once

#include <filesystem>
#include <string>

#include "config/json_fwd.h"
#include "core/result.h"
#include "signing/signing_key.h"
#include "storage/session_file.h"

namespace trocar::exams {

/// Name of the station's key in the folder for state (`user_state_folder()`, --state).
inline constexpr const char* kStationKeyFile = "station.key";

inline constexpr const char* kSealFormat = "trocar exam seal 1";

/// Files beside the session of an exam: "a.trocar" -> "a.seal.json", "a.result.json".
std::filesystem::path seal_file_of(const std::filesystem::path& session);
std::filesystem::path result_file_of(const std::filesystem::path& session);

/// SHA-256 over names and bytes of all tables (*.toml) of a data folder: other tasks, tissues or weights give another
/// one.
Result<std::string> digest_of_data(const std::filesystem::path& data_folder);

/// Who is examined, as chosen on the start page.
struct Examinee {
  std::string id, name;  ///< Empty: nobody was chosen.
  bool has_given_pin = false;
};

/// What the program that records an exam holds in memory when the attempt ends; the session file has to say the same.
struct ExamEnd {
  /// attempt_id, task, patient_source, patient_hash, patient_seed, level, program_version; others are not compared.
  storage::SessionInfo info;
  scoring::Outcome outcome;
  std::string ticks_hash;
  Examinee person;
  std::string data_sha256;  ///< Of the tables when the case was opened.
};

/// Info and outcome of the session of an exam. Errors: those of storage::load_summary; it is no exam (exit status 2),
/// or was interrupted.
Result<storage::SessionSummary> load_exam(const std::filesystem::path& session);

/// Seals the session of an exam: the station's signature over person, task, body, level, versions, tables, outcome and
/// the SHA-256 of the session file. Only the program that recorded the attempt calls it, as soon as the attempt has
/// ended. Returns the file, which is beside the session and never replaces another one. Errors: the session is no exam,
/// incomplete, damaged, still in use, or says other things than `end`; the tables changed; it cannot be written.
Result<std::filesystem::path> seal_exam(const std::filesystem::path& session, const ExamEnd& end,
                                        const signing::SigningKey& key);

/// The content of the seal of a session, if the session is the sealed one. Errors: no seal, a changed one, one of
/// another station, a session that differs from the sealed one.
Result<config::Json> check_seal(const std::filesystem::path& session, const signing::PublicKey& key);

/// The one form of seals and results: any other text, even with the same values, is a changed one.
std::string canonical_text(const config::Json& json);
/// Adds the members public_key and signature, the latter over the canonical text without it.
void sign_json(config::Json& json, const signing::SigningKey& key);
/// True if a text is canonical and signed with the key.
bool is_signed_text(const std::string& text, const config::Json& json, const signing::PublicKey& key);
/// A member of the kind text; empty: there is none.
std::string text_at(const config::Json& json, const char* key);

}  // namespace trocar::exams
