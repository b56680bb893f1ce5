#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "attempt/offline/run_session.h"
#include "core/files/folders.h"

namespace trocar::testing {

/// A finished attempt: its result and its recorded session.
struct Attempt {
  attempt::RunResult result;
  storage::Session session;
};

/// Performs an attempt and reads its session back; a failure is a failed test with its message.
inline Attempt perform(const cases::Case& the_case, const std::string& operator_name, std::uint64_t seed = 1,
                       const std::string& force_model = "") {
  const TemporaryFolder folder;
  attempt::RunOptions options;
  options.operator_name = operator_name;
  options.seed = seed;
  options.force_model = force_model;
  options.patient_source = the_case.patient->name;
  options.session = folder.path() / "attempt.trocar";
  Attempt attempt;
  auto result = attempt::run_session(the_case, options);
  EXPECT_TRUE(result.has_value()) << (result ? "" : result.error().text());
  if (!result) return attempt;
  attempt.result = *std::move(result);
  auto session = storage::load_session(options.session);
  EXPECT_TRUE(session.has_value()) << (session ? "" : session.error().text());
  if (session) attempt.session = *std::move(session);
  return attempt;
}

inline std::vector<std::string> layers_of(const Attempt& attempt) {
  std::vector<std::string> layers;
  for (const attempt::PunctureRecord& puncture : attempt.result.punctures) layers.push_back(puncture.layer);
  return layers;
}

/// Mean resistance while the needle advances, from one puncture (by number) to the next loading.
inline double mean_resistance_after_n(const Attempt& attempt, std::size_t puncture) {
  const double from_s = attempt.result.punctures.at(puncture).time_s + 0.1;  // the coupling spring has relaxed
  double sum = 0.0;
  int count = 0;
  for (const telemetry::TickSample& sample : attempt.session.samples) {
    if (sample.time_s < from_s || sample.axial_velocity_mm_s < 1.0) continue;
    if (sample.phase != telemetry::InsertionPhase::kInserted) break;
    sum += axial_resistance_n(sample);
    ++count;
  }
  return count > 0 ? sum / count : 0.0;
}

/// The paper's observations on one expert attempt: three peaks in order, a drop after each, a larger force behind the
/// capsule than behind the skin. A patient from a CT has a peritoneum as well, just in front of the capsule.
inline void expect_three_peaks(const Attempt& attempt) {
  const auto is_peritoneum = [](const auto& layer) { return layer == "peritoneum"; };
  std::vector<std::string> layers = layers_of(attempt);
  std::erase_if(layers, is_peritoneum);
  ASSERT_EQ(layers, (std::vector<std::string>{"skin", "muscle", "liver_capsule"}));
  const auto& samples = attempt.session.samples;
  for (const attempt::PunctureRecord& puncture : attempt.result.punctures) {
    if (is_peritoneum(puncture.layer)) continue;  // the capsule behind it is loaded at once
    const auto at = static_cast<std::size_t>(puncture.time_s * attempt.session.info.rate_hz + 0.5);
    constexpr std::size_t kSoon = 150;  // ms
    constexpr double kLeft = 0.8;       // of the peak: behind a wall of 45 mm the shaft's friction stays
    ASSERT_LT(at + kSoon, samples.size());
    EXPECT_LT(axial_resistance_n(samples[at + kSoon]), kLeft * axial_resistance_n(samples[at])) << puncture.layer;
  }
  EXPECT_GT(mean_resistance_after_n(attempt, attempt.result.punctures.size() - 1), mean_resistance_after_n(attempt, 0));
}

}  // namespace trocar::testing
