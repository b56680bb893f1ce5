#pragma once

#include <string>

#include "cohort/validity.h"
#include "results/repository.h"

namespace trocar::results {

/// Which attempts are evidence: scored ones at one task.
struct EvidenceFilter {
  std::string task;
  std::string course = {};  ///< Only people of this course; empty: all.
  /// Of each person, counted over the scored attempts at the task. The first three [assumed]: later a trainee is no
  /// novice any more. It also bounds the work by the number of people.
  cohort::AttemptRange attempts = {1, 3};
};

/// The people with such attempts, and of each the mean of score, metrics and points of the parts. Trainees are novices.
/// Simulated people are left out where there are real experts and real trainees.
/// Titles and directions of the metrics are those of the catalogue (metrics/metric.h), in its order.
Result<cohort::CohortData> cohort_data(Repository& repository, const EvidenceFilter& filter);

/// cohort::validity_of of these data.
Result<cohort::Validity> validity_of(Repository& repository, const EvidenceFilter& filter,
                                     const cohort::ValidityRules& rules = {});

}  // namespace trocar::results
