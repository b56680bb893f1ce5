#include "exams/exam_result.h"

#include <fmt/format.h>

#include <algorithm>

#include "config/json.h"
#include "core/files/folders.h"
#include "core/files/input_file.h"
#include "core/files/output_file.h"
#include "core/version.h"
#include "exams/exam_body.h"
#include "haptics/force_version.h"
#include "io/patient/patient_folder.h"
#include "learning/history.h"
#include "signing/token.h"
#include "storage/session_file.h"

namespace trocar::exams {
namespace fs = std::filesystem;
namespace {

using config::Json;

constexpr const char* kFormat = "trocar exam result 2";
constexpr const char* kOldFormat = "trocar exam result 1";  ///< Signed at any time after the attempt; names no person.
constexpr const char* kAdvice = "name a .result.json file of an exam";

/// What told whether the body was known.
constexpr const char *kBySessions = "sessions of the station",
                     *kBySessionsAndDatabase = "sessions of the station, database of results";

/// By the earlier attempts: whether the person, and whether somebody who is not named, has seen the body.
struct KnownBody {
  bool to_person = false, to_unnamed = false;
};

Result<KnownBody> known_body(const Json& seal, std::span<const SeenBody> history) {
  const std::string person = text_at(seal, "person_id");
  const ExaminedBody body{text_at(seal, "patient"), seal.value("patient_seed", std::uint64_t{0}),
                          text_at(seal, "patient_hash")};
  const auto begin = learning::parse_utc(text_at(seal, "started_utc"));
  if (!begin) return fail("the seal has no time of the begin", {}, "repeat the exam");
  const std::vector<SeenBody> earlier = before(history, {text_at(seal, "attempt_id"), person, *begin});
  KnownBody known;
  known.to_person = io::is_path(body.patient) || body.seed == kPractisedNumber || is_known_body(earlier, body, person);
  for (const SeenBody& seen : earlier)
    if (seen.person_id.empty()) known.to_unnamed = known.to_unnamed || is_known_body({&seen, 1}, body);
  return known;
}

/// Empty: it is the signed one, or `note` says that it could not be checked.
std::string fault_of_session(const fs::path& result, const Json& json, std::string& note) {
  const std::string name = text_at(json, "session");
  if (name.empty() || fs::path(name).filename() != name) return "it names no session";
  const fs::path session = result.parent_path() / name;
  std::error_code error;
  if (!fs::exists(fs::symlink_status(session, error))) {
    note = fmt::format("; the session {} is not beside it and was not checked", name);
    return {};
  }
  const std::vector<fs::path> files = storage::session_files(session);
  for (std::size_t n = 1; n < files.size(); ++n)  // a reader would see what stands in it
    if (fs::exists(fs::symlink_status(files[n], error)))
      return fmt::format("a journal lies beside the session, {}", files[n].filename().string());
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

bool is_true(const Json& json, const char* key) {
  return json.value(key, Json(false)) == Json(true);
}

std::string summary(const Json& json) {
  const Json score = json.value("score", Json(nullptr));
  return fmt::format("{}, {} {}, {}, {}", text_at(json, "started_utc"), text_at(json, "task"), text_at(json, "patient"),
                     score.is_number() ? fmt::format("{:.0f} points", score.get<double>()) : "not scored",
                     is_true(json, "passed") ? "passed" : "not passed");
}

std::string person_line(const Json& json) {
  const std::string name = text_at(json, "person");
  if (text_at(json, "person_id").empty()) return "person: nobody was chosen on the start page";
  const bool has_given_pin = text_at(json, "person_checked_by") == "PIN";
  return fmt::format("person: {} ({}), {}", name.empty() ? "without a name" : name, text_at(json, "person_id"),
                     has_given_pin ? "who gave the PIN" : "chosen without a PIN");
}

std::string body_line(const Json& json) {
  std::string line = fmt::format("body: {} {}, hash {}, ", text_at(json, "patient"),
                                 json.value("patient_seed", Json(nullptr)).dump(), text_at(json, "patient_hash"));
  line += is_true(json, "body_was_known") ? "known from an earlier attempt" : "in no earlier attempt of the person";
  line += fmt::format(" ({})", text_at(json, "known_by"));
  if (is_true(json, "body_was_seen_unnamed")) line += "; an earlier attempt on it names nobody and may be theirs";
  return line;
}

std::vector<std::string> details_of(const Json& json) {
  if (text_at(json, "format") == kOldFormat)
    return {
        "proves: this text and the session beside it have not changed since a program with this station's key signed "
        "them",
        "does not prove: that the session was as recorded when it was signed (an older program signed at any time "
        "after the attempt), or who was examined (it names no person)"};
  return {
      person_line(json), body_line(json), fmt::format("sealed when the attempt ended: {}", text_at(json, "sealed_utc")),
      "proves: a program with this station's key wrote this for this recording when the attempt ended, and neither "
      "has changed since",
      "does not prove: who held the needle, that nobody helped, or that who can read the station's key has not made "
      "it"};
}

}  // namespace

Result<fs::path> sign_exam(const fs::path& session, std::span<const SeenBody> history, const signing::SigningKey& key) {
  const fs::path out = result_file_of(session);
  std::error_code error;
  if (fs::exists(fs::symlink_status(out, error)))
    return fail_usage("the exam is signed already", out.string(), "verify it with trocar exam verify");
  TROCAR_TRY_STATUS(load_exam(session));
  TROCAR_TRY(Json json, check_seal(session, key.public_key()));
  auto known = known_body(json, history);
  if (!known) {
    known.error().where = seal_file_of(session).string();
    return tl::unexpected(std::move(known).error());
  }
  json["format"] = kFormat;
  json["body_was_known"] = known->to_person;
  json["body_was_seen_unnamed"] = known->to_unnamed;
  const bool has_database =
      std::ranges::any_of(history, [](const SeenBody& seen) { return seen.sequence.has_value(); });
  json["known_by"] = has_database ? kBySessionsAndDatabase : kBySessions;
  json["session"] = session.filename().string();
  json.erase("public_key");
  sign_json(json, key);
  TROCAR_TRY_STATUS(write_file_atomically(out, canonical_text(json)));
  return out;
}

Result<Verification> verify_exam(const fs::path& result, const signing::PublicKey& key) {
  TROCAR_TRY(const std::string text, read_input(result, FileKind::kJson));
  const auto json = config::parse_json(text, result.string());
  if (!json || !json->is_object() || !json->contains("format"))
    return fail_usage("is no result of an exam", result.string(), kAdvice);
  const std::string format = text_at(*json, "format");
  if (format == kSealFormat)
    return fail_usage("is the seal of an exam, not its result", result.string(), "make it with trocar exam sign");
  if (format != kFormat && format != kOldFormat)
    return fail_usage("has a format that this program does not know", result.string(), kAdvice);
  if (text_at(*json, "public_key") != signing::to_hex(key))
    return Verification{Verdict::kOtherKey,
                        fmt::format("other key: it names the key {}", text_at(*json, "public_key"))};
  if (!is_signed_text(text, *json, key))
    return Verification{Verdict::kChanged, "changed: the text is not the signed one"};
  std::string note;
  if (const std::string fault = fault_of_session(result, *json, note); !fault.empty())
    return Verification{Verdict::kChanged, "changed: " + fault};
  const std::string other = other_version(*json);
  if (format == kOldFormat) note += "; a result of an older program, which proves less";
  return Verification{other.empty() ? Verdict::kValid : Verdict::kOtherVersion,
                      fmt::format("valid{}: {}{}", other.empty() ? "" : ", signed " + other, summary(*json), note),
                      details_of(*json)};
}

}  // namespace trocar::exams
