// docs/metrics.md has one row for each metric of the catalogue, with its title, unit and a test that exists.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>

#include "core/testing/source_dir.h"
#include "metrics/metric.h"

namespace trocar::metrics {
namespace {

namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

/// Cells of the rows "| `name` | title | formula | unit | better | source | test |", by name.
std::map<std::string, std::vector<std::string>> rows_of(const std::string& page) {
  std::map<std::string, std::vector<std::string>> rows;
  std::istringstream lines(page);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| `")) continue;
    std::vector<std::string> cells;
    std::istringstream parts(line.substr(1));
    for (std::string cell; std::getline(parts, cell, '|');) {
      const auto first = cell.find_first_not_of(' '), last = cell.find_last_not_of(' ');
      cells.push_back(first == std::string::npos ? "" : cell.substr(first, last - first + 1));
    }
    const std::string name = cells.front().substr(1, cells.front().size() - 2);
    EXPECT_TRUE(rows.emplace(name, cells).second) << name << " has two rows";
  }
  return rows;
}

const char* text_of(Better better) {
  return better == Better::kLower ? "lower" : better == Better::kHigher ? "higher" : "–";
}

TEST(MetricsPage, ListsExactlyTheMetricsOfTheCatalogue) {
  const fs::path source = testing::source_dir();
  auto rows = rows_of(text_of(source / "docs" / "metrics.md"));
  std::string tests;
  for (const auto& entry : fs::directory_iterator(source / "src" / "training" / "metrics" / "test"))
    if (entry.path().filename() != fs::path(__FILE__).filename()) tests += text_of(entry.path());
  for (const MetricDescription& metric : metric_catalogue()) {
    ASSERT_TRUE(rows.contains(metric.name)) << "docs/metrics.md has no row `" << metric.name << "`";
    const std::vector<std::string> cells = rows[metric.name];
    rows.erase(metric.name);
    ASSERT_EQ(cells.size(), 7u) << metric.name;
    EXPECT_EQ(cells[1], metric.title) << metric.name;
    EXPECT_FALSE(cells[2].empty()) << metric.name;
    EXPECT_EQ(cells[3], metric.unit) << metric.name;
    EXPECT_EQ(cells[4], text_of(metric.better)) << metric.name;
    EXPECT_EQ(cells[5], metric.source) << metric.name;
    // The test is "Suite.Name".
    const auto dot = cells[6].find('.');
    ASSERT_NE(dot, std::string::npos) << metric.name;
    const std::string wanted =
        "TEST(" + cells[6].substr(1, dot - 1) + ", " + cells[6].substr(dot + 1, cells[6].size() - dot - 2) + ")";
    EXPECT_NE(tests.find(wanted), std::string::npos) << metric.name << ": no test " << wanted;
    EXPECT_NE(tests.find('"' + std::string(metric.name) + '"'), std::string::npos) << metric.name << " is not tested";
  }
  for (const auto& [name, cells] : rows) ADD_FAILURE() << "docs/metrics.md: no metric " << name;
}

}  // namespace
}  // namespace trocar::metrics
