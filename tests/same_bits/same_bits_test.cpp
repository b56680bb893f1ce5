// The same attempt gives the same ticks to the bit: in a Release and a Debug build, and with and without the
// processor's wide vector instructions.
//
// reference.txt has the hashes of some attempts, which every build must give. A change that is meant to change forces
// or motion changes them: TROCAR_WRITE_REFERENCE=1 runs this test and writes the file anew.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>
#include <vector>

#include "attempt/offline/run_session.h"
#include "cases/testing/phantom_case.h"
#include "core/content_hash.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "core/testing/source_dir.h"
#include "volume/testing/simd_targets.h"

namespace trocar::testing {
namespace {

struct Scenario {
  const char* name;
  const char* patient;
  const char* operator_name;
  const char* force_model;
};
constexpr std::array kScenarios{Scenario{"expert-insertion", "layers-liver", "expert", "insertion"},
                                Scenario{"novice-combined", "layers-liver", "novice", "combined"},
                                Scenario{"constant-proxy", "layers-liver", "constant-velocity:20", "proxy"}};

std::string hash_of(const Scenario& scenario) {
  const auto the_case = phantom_case(scenario.patient);
  if (!the_case) return the_case.error().text();
  const TemporaryFolder folder;
  attempt::RunOptions options;
  options.operator_name = scenario.operator_name;
  options.force_model = scenario.force_model;
  options.seed = 7;
  options.patient_source = scenario.patient;
  options.session = folder / "attempt.trocar";
  const auto result = attempt::run_session(*the_case, options);
  return result ? result->ticks_hash : result.error().text();
}

/// Hash of some values of the C library's functions: they differ by a bit between processors with and without fused
/// multiply-add, and ticks then differ, too.
std::string math_library() {
  ContentHash hash;
  for (int i = 1; i < 2000; ++i) {
    const double x = 0.00731 * i;
    const std::array values{std::exp(-x), std::log(x), std::sin(x), std::cos(x), std::atan2(x, 1.7), std::pow(x, 1.3)};
    hash.add(std::as_bytes(std::span(values)));
  }
  return hash.digest();
}

std::filesystem::path reference_file() {
  return source_dir() / "tests/same_bits/reference.txt";
}

/// Hashes by name; the mathematical functions' under "math".
std::map<std::string, std::string> read_reference() {
  std::map<std::string, std::string> hashes;
  std::istringstream text(read_file(reference_file()).value_or(""));
  for (std::string name, hash; text >> name >> hash;) hashes[name] = hash;
  return hashes;
}

TEST(SameBits, MatchTheReferenceInEveryBuild) {
  if (std::getenv("TROCAR_WRITE_REFERENCE") != nullptr) {
    std::string text = fmt::format("math {}\n", math_library());
    for (const Scenario& scenario : kScenarios) text += fmt::format("{} {}\n", scenario.name, hash_of(scenario));
    ASSERT_TRUE(write_file_atomically(reference_file(), text));
  }
  auto reference = read_reference();
  ASSERT_EQ(reference.size(), kScenarios.size() + 1) << "write it with TROCAR_WRITE_REFERENCE=1";
  if (reference["math"] != math_library())
    GTEST_SKIP() << "the C library's functions give other bits on this processor than on the reference's";
  for (const Scenario& scenario : kScenarios) EXPECT_EQ(hash_of(scenario), reference[scenario.name]) << scenario.name;
}

TEST(SameBits, AreEqualWithAndWithoutWideVectors) {
  for (const Scenario& scenario : kScenarios) {
    const std::string wide = hash_of(scenario);
    const volume::testing::BaselineSimd baseline;
    EXPECT_EQ(hash_of(scenario), wide) << scenario.name;
  }
}

}  // namespace
}  // namespace trocar::testing
