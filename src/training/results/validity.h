#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "cohort/validity.h"
#include "results/repository.h"

namespace trocar::results {

/// Which attempts are evidence: those that count (learning::counts) at one task.
struct EvidenceFilter {
  std::string task;
  std::string course = {};  ///< Only people of this course; empty: all.
  /// Of each person, counted over the attempts of this filter. The first three [assumed]: later a trainee is no novice
  /// any more. It also bounds the work by the number of people.
  cohort::AttemptRange attempts = {1, 3};
  std::string patient = {};  ///< Only this case: "biopsy-2"; empty: all.
  std::string level = {};    ///< Only this level of help: "exam"; empty: all.
};

/// The people with such attempts, and of each the mean of score, metrics and points of the parts, and the share of
/// passed attempts. An attempt without a score counts as not passed and has no part in the mean score. Trainees are
/// novices.
/// Simulated people are left out where there are real experts and real trainees.
/// Titles and directions of the metrics are those of the catalogue (metrics/metric.h), in its order.
Result<cohort::CohortData> cohort_data(Repository& repository, const EvidenceFilter& filter);

/// The cases and levels of the attempts at a task, by name.
struct EvidenceChoices {
  std::vector<std::string> patients, levels;
};
Result<EvidenceChoices> evidence_choices(Repository& repository, std::string_view task);

/// cohort::validity_of of these data.
Result<cohort::Validity> validity_of(Repository& repository, const EvidenceFilter& filter,
                                     const cohort::ValidityRules& rules = {});

}  // namespace trocar::results
