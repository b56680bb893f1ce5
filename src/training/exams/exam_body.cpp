#include "exams/exam_body.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <set>

#include "anatomy/phantom/phantom.h"
#include "cases/prepare_case.h"
#include "core/random.h"
#include "io/patient/open_patient.h"

namespace trocar::exams {
namespace {

constexpr std::uint64_t kFirstDrawn = 1000, kLastDrawn = 9999;

}  // namespace

Result<ExamBody> draw_body(const std::string& patient, std::span<const SeenBody> history, std::uint64_t random_seed,
                           const FitCheck& check) {
  std::set<std::uint64_t> known;
  for (const SeenBody& seen : history)
    if (seen.patient == patient) known.insert(seen.seed);
  Random random(random_seed);
  ExamBody body;
  Result<std::string> fit = fail("all bodies are known", patient, "choose another patient");
  constexpr std::uint64_t kNumbers = kLastDrawn - kFirstDrawn + 1;
  std::uint64_t number = kFirstDrawn + random.next() % kNumbers;
  // One after the other, so that every number is tried at most once.
  for (std::uint64_t n = 0; n < kNumbers && body.unfit.size() < kMostTries; ++n, ++number) {
    if (number > kLastDrawn) number = kFirstDrawn;
    if (known.contains(number)) continue;
    fit = check(number);
    if (fit && !is_known_body(history, {patient, number, *fit})) {
      body.number = number;
      return body;
    }
    if (fit)
      fit = fail("the body is known by another name", fmt::format("{}, number {}", patient, number),
                 "choose another patient");
    body.unfit.push_back(number);
  }
  return tl::unexpected(std::move(fit).error());
}

Result<ExamBody> find_body(const ExaminedBody& body, std::span<const SeenBody> history, std::string_view person_id,
                           const FitCheck& check) {
  const std::uint64_t number = body.seed;
  if (number <= kPractisedNumber || number > kMostNumber)
    return fail_usage(fmt::format("there is no exam {}", number), "exam number",
                      fmt::format("choose {} to {}", kPractisedNumber + 1, kMostNumber));
  const Result<std::string> fit = check(number);
  if (!fit)
    return fail(fmt::format("exam {} cannot be held: {}", number, fit.error().what), body.patient,
                "choose another number, or let one be drawn");
  return ExamBody{number, is_known_body(history, {body.patient, number, *fit}, person_id)};
}

FitCheck fit_check(const std::string& task, const std::string& patient, const std::filesystem::path& cache_folder,
                   const Progress& progress) {
  return [=](std::uint64_t number) -> Result<std::string> {
    TROCAR_TRY(anatomy::VirtualPatient body, io::open_patient({patient, number, cache_folder}, progress));
    std::string hash = body.content_hash;
    cases::CaseOptions options;
    options.task = task;
    options.patient_folder = patient;
    TROCAR_TRY_STATUS(
        cases::prepare_case(std::make_shared<const anatomy::VirtualPatient>(std::move(body)), options, progress));
    return hash;
  };
}

Result<std::string> patient_of_difficulty(const std::string& task, int difficulty) {
  for (const anatomy::PhantomInfo& info : anatomy::embedded_patients())
    if (info.difficulty == difficulty && std::find(info.tasks.begin(), info.tasks.end(), task) != info.tasks.end())
      return info.name;
  return fail_usage(fmt::format("there is no patient of difficulty {} for {}", difficulty, task), "--difficulty",
                    "see trocar patient list");
}

}  // namespace trocar::exams
