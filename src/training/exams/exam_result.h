#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "core/result.h"
#include "learning/past_attempt.h"
#include "signing/signing_key.h"

namespace trocar::exams {

/// Name of the station's key in the folder for state (`user_state_folder()`, --state).
inline constexpr const char* kStationKeyFile = "station.key";

/// File of the signed result beside a session: "a.trocar" -> "a.result.json".
std::filesystem::path result_file_of(const std::filesystem::path& session);

/// SHA-256 over names and bytes of all tables (*.toml) of a data folder: other tasks, tissues or weights give another
/// one.
Result<std::string> digest_of_data(const std::filesystem::path& data_folder);

/// Signs the session of an exam and writes the result beside it, never over another file. `history` tells if the body
/// was known: an earlier attempt on it. Returns the file. Errors: the session is damaged, incomplete or no exam; the
/// result exists; it cannot be written.
Result<std::filesystem::path> sign_exam(const std::filesystem::path& session,
                                        std::span<const learning::PastAttempt> history, const signing::SigningKey& key);

enum class Verdict : std::uint8_t {
  kValid,         ///< Signed with the key, by this version of the program with these tables.
  kOtherVersion,  ///< The same, by another version of the program or with other tables.
  kChanged,       ///< The text differs from the signed one, or the session beside it from the signed one.
  kOtherKey,      ///< It names another key.
};
struct Verification {
  Verdict verdict = Verdict::kChanged;
  std::string text;  ///< One line.

  bool is_valid() const noexcept { return verdict == Verdict::kValid || verdict == Verdict::kOtherVersion; }
};
/// Checks a result with the public key that is trusted, and the session if it lies beside it. Errors: the file cannot
/// be read, or is no result of an exam at all (exit status 2).
Result<Verification> verify_exam(const std::filesystem::path& result, const signing::PublicKey& key);

}  // namespace trocar::exams
