#include <gtest/gtest.h>

#include "anatomy/tissue/hounsfield.h"

namespace trocar::anatomy {
namespace {

/// A patient of labels of one tissue each and what was measured in them.
std::vector<std::string> findings_of(const std::vector<std::pair<std::string, double>>& tissue_hu,
                                     double volume_ml = 50.0) {
  VirtualPatient patient;
  std::vector<LabelStatistics> statistics;
  for (const auto& [tissue, hu] : tissue_hu) {
    const auto id = static_cast<std::uint8_t>(patient.label_table.labels.size() + 1);
    patient.label_table.labels.push_back({id, tissue + std::to_string(id), tissue});
    LabelStatistics s;
    s.id = id;
    s.volume_ml = volume_ml;
    s.mean_hu = hu;
    statistics.push_back(s);
  }
  std::vector<std::string> texts;
  for (const Finding& finding : find_implausible_hu(patient, statistics)) texts.push_back(finding.text);
  return texts;
}

TEST(ImplausibleHu, AcceptsAnOrdinaryPatient) {
  EXPECT_TRUE(findings_of({{"bone", 350}, {"liver", 105}, {"lung", -840}, {"kidney", 180}, {"bowel", -200}}).empty());
}

TEST(ImplausibleHu, NamesAnImplausibleLabel) {
  const auto findings = findings_of({{"bone", 20}, {"liver", 105}});
  ASSERT_EQ(findings.size(), 1u);
  EXPECT_NE(findings[0].find("bone1"), std::string::npos);
}

TEST(ImplausibleHu, NamesEachImplausibleLabel) {
  const auto findings = findings_of({{"bone", 20}, {"liver", -300}, {"lung", 40}, {"spleen", -100}, {"kidney", 30}});
  EXPECT_EQ(findings.size(), 4u);
}

TEST(ImplausibleHu, IgnoresTinyLabels) {
  EXPECT_TRUE(findings_of({{"bone", 20}}, 0.2).empty());
}

}  // namespace
}  // namespace trocar::anatomy
