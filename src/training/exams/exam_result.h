#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/result.h"
#include "exams/exam_body.h"
#include "exams/exam_seal.h"

namespace trocar::exams {

/// Writes the signed result of a sealed exam beside its session, never over another file: what the seal says, and
/// whether the body was known to the person by the attempts before it. Returns the file. Errors: those of
/// load_exam and of check_seal; the result exists; it cannot be written.
Result<std::filesystem::path> sign_exam(const std::filesystem::path& session, std::span<const SeenBody> history,
                                        const signing::SigningKey& key);

enum class Verdict : std::uint8_t {
  kValid,         ///< Signed with the key, by this version of the program with these tables.
  kOtherVersion,  ///< The same, by another version of the program or with other tables.
  kChanged,       ///< The text differs from the signed one, or the session beside it from the signed one.
  kOtherKey,      ///< It names another key.
};
struct Verification {
  Verdict verdict = Verdict::kChanged;
  std::string text;  ///< One line.
  /// Of a valid result, a line each: person, body, what the signature proves and what not.
  std::vector<std::string> details{};

  bool is_valid() const noexcept { return verdict == Verdict::kValid || verdict == Verdict::kOtherVersion; }
};
/// Checks a result with the public key that is trusted, and the session if it lies beside it. Results of older programs
/// (format 1, signed at any time after the attempt) stay verifiable; the details say that they prove less. Errors: the
/// file cannot be read, or is no result of an exam at all (exit status 2).
Result<Verification> verify_exam(const std::filesystem::path& result, const signing::PublicKey& key);

}  // namespace trocar::exams
