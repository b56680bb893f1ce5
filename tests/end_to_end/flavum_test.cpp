// Behind the ligamentum flavum: an expert's hand stops before the dura, a novice's often does not (physics.md H1).
#include <gtest/gtest.h>

#include <optional>

#include "attempt.h"
#include "cases/prepare_case.h"
#include "io/patient/patient_cache.h"

namespace trocar::testing {
namespace {

std::optional<double> puncture_s(const Attempt& attempt, const std::string& layer) {
  for (const attempt::PunctureRecord& puncture : attempt.result.punctures)
    if (puncture.layer == layer) return puncture.time_s;
  return std::nullopt;
}

/// Time from the puncture of the flavum to that of the dura.
std::optional<double> to_dura_s(const Attempt& attempt) {
  const auto flavum = puncture_s(attempt, "ligamentum_flavum"), dura = puncture_s(attempt, "dura");
  if (!flavum || !dura) return std::nullopt;
  return *dura - *flavum;
}

TEST(BehindTheFlavum, ExpertStopsAndNovicePiercesTheDura) {
  auto patient = io::open_patient({"lumbar-1", 1, io::patient_cache_folder()});
  ASSERT_TRUE(patient) << patient.error().text();
  cases::CaseOptions options;
  options.task = "lumbar-puncture";
  auto prepared = cases::prepare_case(std::make_shared<const anatomy::VirtualPatient>(*std::move(patient)), options);
  ASSERT_TRUE(prepared) << prepared.error().text();
  const auto expert_s = to_dura_s(perform(*prepared, "expert"));
  ASSERT_TRUE(expert_s);
  EXPECT_GT(*expert_s, 1.0);  // looks for spinal fluid before it goes on
  int at_once = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    const auto novice_s = to_dura_s(perform(*prepared, "novice", seed));
    at_once += novice_s && *novice_s < 0.05 ? 1 : 0;
  }
  EXPECT_GE(at_once, 2);  // measured: 4
}

}  // namespace
}  // namespace trocar::testing
