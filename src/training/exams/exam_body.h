#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "exams/seen_bodies.h"

namespace trocar::exams {

inline constexpr std::uint64_t kPractisedNumber = 1;  ///< Seed of the body on which trainees practise.
inline constexpr std::uint64_t kMostNumber = 999'999;

/// The body of an exam on an embedded patient.
struct ExamBody {
  /// The exam's number: the patient's seed. The same number is the same body on every station of this version.
  std::uint64_t number = 0;
  bool is_known = false;               ///< An earlier attempt was on this body.
  std::vector<std::uint64_t> unfit{};  ///< Numbers that were drawn before and cannot serve the task.
};

/// Status of a body: an error says why it cannot serve the task.
using FitCheck = std::function<Result<std::string>(std::uint64_t number)>;

/// Draws numbers of four digits by `random_seed` until one is not in the history, of anybody, and passes the check.
/// Error: none of kMostTries; the reason of the last one.
inline constexpr int kMostTries = 8;
Result<ExamBody> draw_body(const std::string& patient, std::span<const SeenBody> history, std::uint64_t random_seed,
                           const FitCheck& check);
/// The body of a given number; it may be known to the person (empty: to anybody). Errors: 2..kMostNumber (exit status
/// 2); it does not pass the check.
Result<ExamBody> find_body(const ExaminedBody& body, std::span<const SeenBody> history, std::string_view person_id,
                           const FitCheck& check);

/// The check of a task on an embedded patient: all structures are there and a safe path is found. Bodies are kept in
/// the cache folder, from which they then open.
FitCheck fit_check(const std::string& task, const std::string& patient, const std::filesystem::path& cache_folder,
                   const Progress& progress = {});

/// The embedded patient for a task with a difficulty, 1 to 5. Error: there is none (exit status 2).
Result<std::string> patient_of_difficulty(const std::string& task, int difficulty);

}  // namespace trocar::exams
