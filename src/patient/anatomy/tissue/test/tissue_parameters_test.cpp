#include "anatomy/tissue/tissue_parameters.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "anatomy/testing/shipped_tissues.h"

namespace trocar::anatomy {
namespace {

using testing::shipped_tissues;

const TissueParameter* find(const std::vector<TissueParameterGroup>& groups, std::string_view group,
                            std::string_view key) {
  for (const auto& g : groups)
    for (const auto& p : g.parameters)
      if (g.name == group && p.key == key) return &p;
  return nullptr;
}

TEST(TissueParameters, RoundTripThroughTheirOverrides) {
  const TissueTable table = shipped_tissues();
  for (const auto& group : tissue_parameters(table)) {
    std::set<std::string_view> keys;
    for (const TissueParameter& parameter : group.parameters) {
      EXPECT_TRUE(keys.insert(parameter.key).second) << group.name << "." << parameter.key;
      EXPECT_FALSE(parameter.provenance.source.empty()) << parameter.setting;
      const double wanted = std::isinf(parameter.value) ? 7.0 : 0.9 * parameter.value + 0.1 * parameter.low + 1e-3;
      TissueTable changed = table;
      const auto status = apply_override(changed, fmt::format("{}={}", parameter.setting, wanted));
      ASSERT_TRUE(status) << status.error().text();
      int differ = 0;
      const auto after = tissue_parameters(changed);
      for (const auto& group_before : tissue_parameters(table))
        for (const auto& was : group_before.parameters) {
          const TissueParameter* is = find(after, group_before.name, was.key);
          ASSERT_NE(is, nullptr) << group_before.name << "." << was.key << " after " << parameter.setting;
          if (was.setting == parameter.setting && !was.setting.ends_with("_factor")) {
            EXPECT_EQ(is->value, wanted) << was.setting;
          }
          if (was.setting != parameter.setting && is->value != was.value) ++differ;
        }
      EXPECT_EQ(differ, 0) << parameter.setting << " changes others";
      for (const double beyond : {parameter.low - 0.001, parameter.high * 1.01}) {
        EXPECT_FALSE(apply_override(changed, fmt::format("{}={}", parameter.setting, beyond))) << parameter.setting;
      }
      EXPECT_EQ(apply_override(changed, parameter.setting + "=never").has_value(), parameter.may_be_never);
    }
  }
}

TEST(TissueParameters, MatchTable1OfPaperA) {
  const auto groups = tissue_parameters(shipped_tissues());
  const std::tuple<const char*, const char*, double> table_1[] = {
      {"skin", "k", 0.46},     {"skin", "nu", 0.02},   {"skin", "mu", 0.18},  {"skin", "dx", 0.1},
      {"adipose", "nu", 0.01}, {"adipose", "mu", 0.1}, {"muscle", "k", 0.19}, {"muscle", "nu", 0.03},
      {"muscle", "mu", 0.15},  {"muscle", "dx", 0.11}, {"liver", "k", 0.42},  {"liver", "nu", 0.02},
      {"liver", "mu", 0.58},   {"liver", "dx", 0.12},
  };
  for (const auto& [tissue, key, value] : table_1) {
    const TissueParameter* parameter = find(groups, tissue, key);
    ASSERT_NE(parameter, nullptr) << tissue << "." << key;
    EXPECT_EQ(parameter->value, value);
    EXPECT_EQ(parameter->setting, fmt::format("{}.{}", tissue, key));
    EXPECT_EQ(parameter->provenance.source, "paper A, Table 1");
  }
}

TEST(TissueParameters, TissuesUnderOneSurfaceShareItsNumbers) {
  const auto groups = tissue_parameters(shipped_tissues());
  const TissueParameter* parameter = find(groups, "liver_lesion", "k");
  ASSERT_NE(parameter, nullptr);
  EXPECT_EQ(parameter->setting, "liver.k");
  EXPECT_EQ(parameter->owner, "liver");
  EXPECT_EQ(find(groups, "liver_lesion", "nu")->setting, "liver_lesion.nu");
  EXPECT_EQ(find(groups, "liver", "k")->owner, "");
}

TEST(TissueParameters, ScalesBeginAtOrBelowEveryNumber) {
  for (const auto& group : tissue_parameters(shipped_tissues()))
    for (const auto& parameter : group.parameters) {
      if (parameter.log_from > 0.0 && parameter.value > 0.0) {
        EXPECT_LE(parameter.log_from, parameter.value) << parameter.setting;
        EXPECT_LT(parameter.log_from, parameter.high) << parameter.setting;
      }
    }
}

}  // namespace
}  // namespace trocar::anatomy
