// Embedded patients in the user's cache: the same results with it and without.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <vector>

#include "cli/program.h"
#include "core/files/atomic_file.h"

namespace trocar::cli_test {
namespace {
namespace fs = std::filesystem;

std::vector<std::string> cells(const std::string& csv) {
  std::vector<std::string> all;
  std::string text = read_file(csv).value_or("");
  std::replace(text.begin(), text.end(), '\n', ',');
  std::istringstream stream(text);
  for (std::string cell; std::getline(stream, cell, ',');) all.push_back(cell);
  return all;
}

/// The same text, or numbers as alike as the decimals of a header keep them.
bool is_alike(const std::string& a, const std::string& b) {
  constexpr double kRounding = 1e-9;
  if (a == b) return true;
  char *end_a = nullptr, *end_b = nullptr;
  const double x = std::strtod(a.c_str(), &end_a), y = std::strtod(b.c_str(), &end_b);
  const bool are_numbers = !a.empty() && !b.empty() && *end_a == '\0' && *end_b == '\0';
  return are_numbers && std::abs(x - y) <= kRounding * std::max(1.0, std::abs(x));
}

TEST(Cache, GivesTheSameSessionAsAGeneratedPatient) {
  const TemporaryFolder folder;
  const std::string cached = "XDG_CACHE_HOME='" + (folder / "cache") + "'";
  const auto run = [&](const std::string& name, const std::string& more) {
    const Outcome ran =
        trocar("run liver-biopsy --patient abdomen --patient-seed 3 --operator constant-velocity:40 --out '" +
                   (folder / name) + "' " + more,
               cached);
    EXPECT_EQ(ran.exit_status, 0) << ran.err;
    EXPECT_EQ(trocar("session export '" + (folder / name) + "' --csv '" + (folder / (name + ".csv")) + "'").exit_status,
              0);
  };
  run("plain", "--no-cache");
  EXPECT_FALSE(fs::exists(folder / "cache"));
  run("cold", "");
  const fs::path entries = fs::path(folder / "cache") / "trocar" / "patients";
  ASSERT_TRUE(fs::exists(entries));
  const auto entry = fs::directory_iterator(entries)->path();
  EXPECT_TRUE(entry.filename().string().starts_with("abdomen-3-")) << entry;
  run("warm", "");
  const std::vector<std::string> plain = cells(folder / "plain.csv");
  for (const char* name : {"cold", "warm"}) {
    const std::vector<std::string> other = cells(folder / (name + std::string(".csv")));
    ASSERT_EQ(other.size(), plain.size()) << name;
    for (std::size_t n = 0; n < plain.size(); ++n) EXPECT_TRUE(is_alike(plain[n], other[n])) << name << " cell " << n;
  }
  // A damaged entry is generated again.
  fs::resize_file(entry / "ct.nrrd", 100);
  run("mended", "");
  EXPECT_GT(fs::file_size(entry / "ct.nrrd"), 100u);
}

}  // namespace
}  // namespace trocar::cli_test
