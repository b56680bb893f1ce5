#include "bench/training/simulated_results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "metrics/metric.h"
#include "results/attempts.h"

namespace trocar::bench {
namespace {

constexpr std::size_t kPeople = 200, kExperts = 10;
constexpr const char* kTasks[] = {"liver-biopsy", "ptcd", "lumbar-puncture", "ascites-puncture", "own-task"};
constexpr std::size_t kBatch = 2000;  ///< Attempts of a transaction.
constexpr std::size_t kSamples = 1500;
constexpr double kPassMark = 70.0;
const results::Seconds kStart{std::chrono::seconds(1'780'000'000)};

results::Trace trace_of(std::mt19937_64& random) {
  std::normal_distribution<double> noise(0.0, 0.3);
  results::Trace trace;
  for (std::size_t n = 0; n < kSamples; ++n) {
    const double share = static_cast<double>(n) / kSamples;
    trace.time_s.push_back(static_cast<double>(n) / trace.rate_hz);
    for (std::vector<double>& axis : trace.tip_mm) axis.push_back(100.0 * share + noise(random));
    trace.depth_mm.push_back(80.0 * share);
    trace.force_n.push_back(-2.0 * share + noise(random));
    trace.tissue.push_back(static_cast<int>(3.0 * share));
  }
  trace.tissues = {"skin", "fat", "liver"};
  trace.events = {{1.0, "puncture:skin"}, {20.0, "puncture:liver"}};
  return trace;
}

/// The n-th attempt of a person; `skill` 0..1.
results::AttemptRecord attempt_of(const std::string& person, std::size_t n, double skill, std::mt19937_64& random) {
  std::normal_distribution<double> noise(0.0, 8.0);
  const std::size_t task = n % std::size(kTasks);
  const double learned = 1.0 - std::exp(-static_cast<double>(n / std::size(kTasks)) / 8.0);
  const double score = std::clamp(100.0 * skill * (0.5 + 0.5 * learned) + noise(random), 0.0, 100.0);
  results::AttemptRecord record;
  record.attempt.id = results::make_id();
  record.attempt.person_id = person;
  const int difficulty = 1 + static_cast<int>(n % 4);
  record.attempt.the_case = {kTasks[task], fmt::format("case-{}", difficulty), 1, "simulated", difficulty};
  record.attempt.level = "guided";
  record.attempt.operator_name = "simulated";
  record.attempt.station = fmt::format("station-{}", n % 2);
  record.attempt.started = kStart + std::chrono::hours(n);
  record.attempt.state = results::State::kFinished;
  record.attempt.score = score;
  record.attempt.is_passed = score >= kPassMark;
  record.attempt.duration_s = 60.0;
  record.parts = {{"target", 0.4 * score, 40.0}, {"risk", 0.3 * score, 30.0}, {"time", 0.3 * score, 30.0}};
  double factor = 1.0;
  for (const metrics::MetricDescription& metric : metrics::metric_catalogue())
    record.measures.push_back({metric.name, metric.unit, (factor += 0.1) * (120.0 - score) + noise(random)});
  return record;
}

}  // namespace

Result<SimulatedResults> fill_with_simulated_results(const database::DatabaseUrl& url, std::size_t attempts) {
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> skill(0.6, 0.95);
  TROCAR_TRY(results::Repository repository, results::Repository::open(url));
  SimulatedResults filled;
  filled.tasks.assign(std::begin(kTasks), std::end(kTasks));
  std::vector<double> skills;
  for (std::size_t n = 0; n < kPeople; ++n) {
    results::NewPerson person{fmt::format("Simulated person {:03}", n),
                              n < kExperts ? results::Group::kExpert : results::Group::kTrainee,
                              fmt::format("Course {}", n % 5),
                              true,
                              {}};
    TROCAR_TRY(const results::Person added, results::add_person(repository, person, kStart));
    filled.people.push_back(added.id);
    skills.push_back(n < kExperts ? 1.0 : skill(random));
  }
  std::vector<results::AttemptRecord> batch;
  for (std::size_t n = 0; n < attempts; ++n) {
    const std::size_t person = n % kPeople;
    batch.push_back(attempt_of(filled.people[person], n / kPeople, skills[person], random));
    if (n + kPeople >= attempts) {
      batch.back().trace = trace_of(random);
      filled.attempts.push_back(batch.back().attempt.id);
    }
    if (batch.size() < kBatch && n + 1 < attempts) continue;
    TROCAR_TRY_STATUS(results::record_attempts(repository, batch));
    batch.clear();
  }
  return filled;
}

}  // namespace trocar::bench
