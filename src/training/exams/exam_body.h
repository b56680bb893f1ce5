#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/progress.h"
#include "core/result.h"
#include "results/repository.h"

namespace trocar::exams {

/// An attempt as far as an exam has to know it: on which body, by whom, when. What counts is what was recorded, never
/// the date of a file.
struct SeenBody {
  std::string attempt_id;  ///< Empty: an older program.
  std::string person_id;   ///< Empty: nobody was chosen.
  std::string patient;     ///< Embedded patient, or a folder.
  std::uint64_t seed = 1;
  std::chrono::sys_seconds begin{};        ///< As recorded, UTC.
  std::optional<std::int64_t> sequence{};  ///< Order of recording in the database of results; empty: a session file.
  std::string hash{};                      ///< Of the body's content; empty: not known (a database of results).
};

struct SeenBodies {
  std::vector<SeenBody> attempts;
  std::vector<std::string> damaged;  ///< One line for each session that cannot be read.
};

/// The session files of a folder; a folder that does not exist has none. Error: it cannot be read.
Result<SeenBodies> seen_on_station(const std::filesystem::path& folder);
/// The attempts of a person in a database of results, from every station; nobody (empty) has none.
Result<std::vector<SeenBody>> seen_by_person(results::Repository& repository, std::string_view person_id);

/// The body of an exam.
struct ExaminedBody {
  std::string patient;
  std::uint64_t seed = 1;
  std::string hash{};  ///< Of its content; empty: not known yet.
};
/// True if an attempt was on the body, of any task and level, finished or not. A patient folder has one body, whatever
/// the seed; the same content is the same body, whatever its name. `person_id`: of this person; empty: of anybody.
bool is_known_body(std::span<const SeenBody> attempts, const ExaminedBody& body, std::string_view person_id = {});

/// An exam in the history.
struct ExamInHistory {
  std::string attempt_id, person_id;
  std::chrono::sys_seconds begin{};
};
/// The attempts before an exam: those that were recorded before it or begun before it, without itself. Both count,
/// because a database gets sessions later, and a clock can be changed.
std::vector<SeenBody> before(std::span<const SeenBody> attempts, const ExamInHistory& exam);

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
