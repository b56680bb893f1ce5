#include "anatomy/tissue/tissue_table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <set>

#include "anatomy/testing/shipped_tissues.h"
#include "anatomy/tissue/tissue_fields.h"
#include "core/files/folders.h"
#include "core/random.h"

namespace trocar::anatomy {
namespace {

using testing::shipped_tissues;

const TissueParams& tissue(const TissueTable& table, std::string_view name) {
  return table.tissues.at(table.find_tissue(name).value());
}
const LayerParams& layer(const TissueTable& table, std::string_view name) {
  return table.layers.at(table.find_layer(name).value());
}

/// Paper A's pre-puncture law at rest, and its slope.
double static_force_n(const LayerParams& p, double x) {
  const double d = p.delta_x_mm;
  return x * (p.stiffness_n_per_mm * x * x + 3 * p.stiffness_n_per_mm * x * d + 2 * p.stiffness_n_per_mm * d * d) /
         (6 * d * d);
}
double static_slope_n_per_mm(const LayerParams& p, double x) {
  const double d = p.delta_x_mm;
  return p.stiffness_n_per_mm * (3 * x * x + 6 * x * d + 2 * d * d) / (6 * d * d);
}
double puncture_depth_mm(const LayerParams& p) {
  double low = 0.0;
  double high = 50.0;
  while (high - low > 1e-9) {
    const double middle = 0.5 * (low + high);
    (static_force_n(p, middle) < p.puncture_force_n ? low : high) = middle;
  }
  return low;
}

void expect_same_transfer(const HuTransfer& a, const HuTransfer& b) {
  ASSERT_EQ(a.knot_count, b.knot_count);
  EXPECT_EQ(a.hu, b.hu);
  for (std::size_t n = 0; n < a.knot_count; ++n) {
    for (const auto& field : kHuLawFields)
      EXPECT_EQ(a.laws[n].*field.member, b.laws[n].*field.member) << field.name << n;
  }
  for (const auto& field : kGradientFields) EXPECT_EQ(a.*field.member, b.*field.member) << field.name;
}

void expect_same(const TissueTable& a, const TissueTable& b) {
  EXPECT_EQ(a.profile, b.profile);
  EXPECT_EQ(a.skin_thickness_mm, b.skin_thickness_mm);
  EXPECT_EQ(a.skin, b.skin);
  for (const auto& field : kNeedleSizeFields)
    EXPECT_EQ(a.needle_size.*field.member, b.needle_size.*field.member) << field.name;
  ASSERT_EQ(a.layers.size(), b.layers.size());
  ASSERT_EQ(a.tissues.size(), b.tissues.size());
  for (std::size_t n = 0; n < a.layers.size(); ++n) {
    EXPECT_EQ(a.layers[n].name, b.layers[n].name);
    EXPECT_EQ(a.layers[n].stiffness_n_per_mm, b.layers[n].stiffness_n_per_mm);
    EXPECT_EQ(a.layers[n].viscosity_ns_per_mm, b.layers[n].viscosity_ns_per_mm);
    EXPECT_EQ(a.layers[n].delta_x_mm, b.layers[n].delta_x_mm);
    EXPECT_EQ(a.layers[n].puncture_force_n, b.layers[n].puncture_force_n);
    EXPECT_EQ(a.layers[n].is_wall, b.layers[n].is_wall);
    EXPECT_EQ(a.layers[n].for_diameter_mm, b.layers[n].for_diameter_mm);
    EXPECT_EQ(a.layers[n].load_spread_mm, b.layers[n].load_spread_mm);
    EXPECT_EQ(a.layers[n].pressed_young_kpa, b.layers[n].pressed_young_kpa);
  }
  for (std::size_t n = 0; n < a.tissues.size(); ++n) {
    EXPECT_EQ(a.tissues[n].name, b.tissues[n].name);
    EXPECT_EQ(a.tissues[n].viscosity_ns_per_mm, b.tissues[n].viscosity_ns_per_mm);
    EXPECT_EQ(a.tissues[n].friction_mu, b.tissues[n].friction_mu);
    EXPECT_EQ(a.tissues[n].roughness_n, b.tissues[n].roughness_n);
    EXPECT_EQ(a.tissues[n].stick_n_per_mm, b.tissues[n].stick_n_per_mm);
    EXPECT_EQ(a.tissues[n].cutting_n, b.tissues[n].cutting_n);
    EXPECT_EQ(a.tissues[n].young_kpa, b.tissues[n].young_kpa);
    EXPECT_EQ(a.tissues[n].layer, b.tissues[n].layer);
  }
  expect_same_transfer(a.transfer, b.transfer);
  ASSERT_EQ(a.provenance.size(), b.provenance.size());
  for (const auto& [key, value] : a.provenance) {
    const auto it = b.provenance.find(key);
    ASSERT_NE(it, b.provenance.end()) << key;
    EXPECT_EQ(it->second.source, value.source) << key;
    EXPECT_EQ(it->second.low, value.low) << key;
    EXPECT_EQ(it->second.high, value.high) << key;
  }
}

TEST(TissueTable, HoldsTable1OfPaperAAsPrinted) {
  const TissueTable table = shipped_tissues();
  struct Printed {
    std::string path;
    double actual, printed;
  };
  const auto& skin = layer(table, "skin");
  const auto& muscle = layer(table, "muscle");
  const auto& liver = layer(table, "liver_capsule");
  const std::vector<Printed> all = {
      {"layers.skin.stiffness_n_per_mm", skin.stiffness_n_per_mm, 0.46},
      {"layers.skin.viscosity_ns_per_mm", skin.viscosity_ns_per_mm, 0.02},
      {"layers.skin.delta_x_mm", skin.delta_x_mm, 0.1},
      {"tissues.skin.viscosity_ns_per_mm", tissue(table, "skin").viscosity_ns_per_mm, 0.02},
      {"tissues.skin.friction_mu", tissue(table, "skin").friction_mu, 0.18},
      {"tissues.adipose.viscosity_ns_per_mm", tissue(table, "adipose").viscosity_ns_per_mm, 0.01},
      {"tissues.adipose.friction_mu", tissue(table, "adipose").friction_mu, 0.1},
      {"layers.muscle.stiffness_n_per_mm", muscle.stiffness_n_per_mm, 0.19},
      {"layers.muscle.viscosity_ns_per_mm", muscle.viscosity_ns_per_mm, 0.03},
      {"layers.muscle.delta_x_mm", muscle.delta_x_mm, 0.11},
      {"tissues.muscle.viscosity_ns_per_mm", tissue(table, "muscle").viscosity_ns_per_mm, 0.03},
      {"tissues.muscle.friction_mu", tissue(table, "muscle").friction_mu, 0.15},
      {"layers.liver_capsule.stiffness_n_per_mm", liver.stiffness_n_per_mm, 0.42},
      {"layers.liver_capsule.viscosity_ns_per_mm", liver.viscosity_ns_per_mm, 0.02},
      {"layers.liver_capsule.delta_x_mm", liver.delta_x_mm, 0.12},
      {"tissues.liver.viscosity_ns_per_mm", tissue(table, "liver").viscosity_ns_per_mm, 0.02},
      {"tissues.liver.friction_mu", tissue(table, "liver").friction_mu, 0.58},
  };
  for (const Printed& number : all) {
    EXPECT_EQ(number.actual, number.printed) << number.path;
    EXPECT_EQ(table.provenance.at(number.path).source, "paper A, Table 1") << number.path;
  }
}

TEST(TissueTable, EveryNumberHasASourceAndAssumedOnesARange) {
  constexpr std::size_t kOptionalNumbers = 4;  // the needles of ligamentum flavum and dura, two of the skin
  for (const std::string_view profile : {"paper-a", "tented"}) {
    const TissueTable table = shipped_tissues(profile);
    EXPECT_EQ(table.provenance.size(),
              1 + kLayerFields.size() * table.layers.size() + kTissueFields.size() * (table.tissues.size() - 1) +
                  kHuLawFields.size() + kGradientFields.size() + kNeedleSizeFields.size() +
                  kOptionalNeedleSizeFields.size() + kFrictionFields.size() + kOptionalNumbers);
    for (const auto& [path, provenance] : table.provenance) {
      EXPECT_FALSE(provenance.source.empty()) << path;
      const bool is_never = path == "layers.bone.puncture_force_n";
      if (provenance.source.starts_with("assumed") && !is_never) {
        EXPECT_TRUE(provenance.low && provenance.high) << path;
      }
    }
  }
}

TEST(TissueTable, CoversTheVocabularyAndItsLayers) {
  const TissueTable table = shipped_tissues();
  const std::map<std::string, std::string> layer_of = {{"skin", "skin"},
                                                       {"muscle", "muscle"},
                                                       {"liver", "liver_capsule"},
                                                       {"liver_lesion", "liver_capsule"},
                                                       {"vessel", "vessel"},
                                                       {"bowel", "bowel"},
                                                       {"lung", "pleura"},
                                                       {"bone", "bone"},
                                                       {"cartilage", "cartilage"},
                                                       {"ligamentum_flavum", "ligamentum_flavum"},
                                                       {"csf", "dura"},
                                                       {"ascites", "peritoneum"},
                                                       {"peritoneum", "peritoneum"},
                                                       {"bile_duct", "bile_duct"},
                                                       {"pleura", "pleura"}};
  const std::set<std::string> vocabulary = {
      "air",       "skin",    "adipose",    "muscle",      "liver",  "liver_lesion", "bone",
      "cartilage", "vessel",  "bowel",      "lung",        "kidney", "spleen",       "gallbladder",
      "organ",     "nerve",   "fluid",      "soft_tissue", "gas",    "ligament",     "ligamentum_flavum",
      "csf",       "ascites", "peritoneum", "bile_duct",   "pleura"};
  std::set<std::string> names;
  for (const TissueParams& entry : table.tissues) {
    names.insert(entry.name);
    const auto it = layer_of.find(entry.name);
    EXPECT_EQ(entry.layer.has_value(), it != layer_of.end()) << entry.name;
    if (entry.layer && it != layer_of.end()) {
      EXPECT_EQ(table.layers[*entry.layer].name, it->second);
    }
  }
  EXPECT_EQ(names, vocabulary);
  EXPECT_EQ(table.tissues[0].name, "air");
  EXPECT_EQ(table.tissues[table.skin].name, "skin");
  EXPECT_TRUE(std::isinf(layer(table, "bone").puncture_force_n));
}

TEST(TissueTable, KeepsOriginAndPathConstraintOfAFittedTable) {
  TissueTable table = shipped_tissues("paper-a");
  EXPECT_FALSE(table.path_constraint.is_given);
  EXPECT_EQ(table.to_toml().find("path_constraint"), std::string::npos);
  table.origin = "fitted to six \"punctures\"";
  ASSERT_TRUE(apply_override(table, "path_constraint.m0=2.5"));
  ASSERT_TRUE(apply_override(table, "path_constraint.n0=60"));
  const auto read = parse_tissue_table(table.to_toml(), "test");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_EQ(read->origin, table.origin);
  EXPECT_TRUE(read->path_constraint.is_given);
  EXPECT_EQ(read->path_constraint.force_n, 2.5);
  EXPECT_EQ(read->path_constraint.torque_nmm, 60.0);
  EXPECT_EQ(read->to_toml(), table.to_toml());
}

TEST(TissueTable, RefusesAPathConstraintOutOfRange) {
  TissueTable table = shipped_tissues("paper-a");
  for (const char* bad : {"path_constraint.m0=21", "path_constraint.n0=-1", "path_constraint.d0=3"})
    EXPECT_FALSE(apply_override(table, bad)) << bad;
  EXPECT_FALSE(table.path_constraint.is_given);
  ASSERT_TRUE(apply_override(table, "path_constraint.m0=20"));
  std::string text = table.to_toml();
  const std::size_t number = text.find("20", text.find("[path_constraint]"));
  ASSERT_NE(number, std::string::npos);
  text.replace(number, 2, "25");
  const auto read = parse_tissue_table(text, "test");
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().text().find("path_constraint"), std::string::npos) << read.error().text();
}

// Depths and slopes that were computed from Table 1 outside of this program (static, 18 G).
TEST(TissueTable, PaperProfileMatchesTable1Stiffness) {
  const TissueTable table = shipped_tissues("paper-a");
  struct Expected {
    std::string_view name;
    double x_mm, slope;
  };
  for (const Expected& expected :
       {Expected{"skin", 0.62, 11.8}, Expected{"muscle", 0.88, 7.7}, Expected{"liver_capsule", 0.56, 6.7}}) {
    const double x = puncture_depth_mm(layer(table, expected.name));
    EXPECT_NEAR(x, expected.x_mm, 0.005) << expected.name;
    EXPECT_NEAR(static_slope_n_per_mm(layer(table, expected.name), x), expected.slope, 0.06) << expected.name;
  }
}

TEST(TissueTable, TentedProfileIndents4To5MmBelow1500NPerM) {
  const TissueTable table = shipped_tissues("tented");
  const TissueTable paper = shipped_tissues("paper-a");
  for (const std::string_view name : {"skin", "muscle", "liver_capsule"}) {
    const double x = puncture_depth_mm(layer(table, name));
    EXPECT_GE(x, 3.995) << name;  // the figures are rounded to half a hundredth of a millimetre
    EXPECT_LE(x, 5.005) << name;
    EXPECT_LE(static_slope_n_per_mm(layer(table, name), x), 1.5) << name;
    EXPECT_EQ(layer(table, name).stiffness_n_per_mm, layer(paper, name).stiffness_n_per_mm);
    EXPECT_TRUE(table.provenance.at(fmt::format("layers.{}.delta_x_mm", name)).source.starts_with("assumed"));
  }
}

TEST(TissueTable, UnknownProfileListsTheProfiles) {
  EXPECT_EQ(tissue_profiles(data_dir() / "tissues.toml"), (std::vector<std::string>{"paper-a", "tented"}));
  const auto table = load_tissue_table(data_dir() / "tissues.toml", "soft");
  ASSERT_FALSE(table);
  EXPECT_EQ(table.error().exit_status, 2);
  EXPECT_NE(table.error().text().find("paper-a, tented"), std::string::npos);
}

TEST(TissueTable, RoundTripsBitwiseThroughText) {
  Random random(5);
  for (const std::string_view profile : {"paper-a", "tented"}) {
    TissueTable table = shipped_tissues(profile);
    for (LayerParams& entry : table.layers) entry.delta_x_mm = random.uniform(0.01, 20.0);
    for (TissueParams& entry : table.tissues)
      if (entry.name != "air") entry.friction_mu = random.uniform(0.0, 2.0) * 1e-7;
    for (auto& [path, provenance] : table.provenance) provenance.low = provenance.high = std::nullopt;
    for (auto& [path, provenance] : table.provenance) provenance.source = "a \"quoted\" \\ source";
    const auto again = parse_tissue_table(table.to_toml(), "stored");
    ASSERT_TRUE(again) << again.error().text();
    expect_same(*again, table);
    EXPECT_EQ(again->to_toml(), table.to_toml());
  }
  const auto shipped_again = parse_tissue_table(shipped_tissues("tented").to_toml(), "stored", "tented");
  ASSERT_TRUE(shipped_again) << shipped_again.error().text();
  expect_same(*shipped_again, shipped_tissues("tented"));
  EXPECT_EQ(parse_tissue_table(shipped_tissues("tented").to_toml(), "stored", "paper-a").error().exit_status, 2);
}

TEST(TissueTable, OverrideReachesTissueLayerOrBoth) {
  TissueTable table = shipped_tissues();
  ASSERT_TRUE(apply_override(table, "liver.k=0.5"));
  EXPECT_EQ(layer(table, "liver_capsule").stiffness_n_per_mm, 0.5);
  ASSERT_TRUE(apply_override(table, "liver_capsule.fp=2"));
  EXPECT_EQ(layer(table, "liver_capsule").puncture_force_n, 2.0);
  ASSERT_TRUE(apply_override(table, "skin.nu=0.03"));
  EXPECT_EQ(layer(table, "skin").viscosity_ns_per_mm, 0.03);
  EXPECT_EQ(tissue(table, "skin").viscosity_ns_per_mm, 0.03);
  ASSERT_TRUE(apply_override(table, "liver.nu=0.04"));
  EXPECT_EQ(layer(table, "liver_capsule").viscosity_ns_per_mm, 0.04);
  ASSERT_TRUE(apply_override(table, "liver_lesion.nu=0.05"));
  EXPECT_EQ(tissue(table, "liver_lesion").viscosity_ns_per_mm, 0.05);
  EXPECT_EQ(layer(table, "liver_capsule").viscosity_ns_per_mm, 0.04) << "the capsule is the liver's";
  ASSERT_TRUE(apply_override(table, "adipose.friction_mu=0.2"));
  EXPECT_EQ(tissue(table, "adipose").friction_mu, 0.2);
  ASSERT_TRUE(apply_override(table, "muscle.fp=never"));
  EXPECT_TRUE(std::isinf(layer(table, "muscle").puncture_force_n));
  ASSERT_TRUE(apply_override(table, "skin.thickness_mm=3"));
  EXPECT_EQ(table.skin_thickness_mm, 3.0);
  EXPECT_EQ(table.provenance.at("layers.liver_capsule.stiffness_n_per_mm").source, "set by the user");
  const auto stored = parse_tissue_table(table.to_toml(), "stored");
  ASSERT_TRUE(stored) << stored.error().text();
  expect_same(*stored, table);
}

TEST(TissueTable, OverrideOfARowChangesOnlyThatRow) {
  TissueTable table = shipped_tissues();
  ASSERT_TRUE(apply_override(table, "layers.vessel.nu=0.03"));
  EXPECT_EQ(layer(table, "vessel").viscosity_ns_per_mm, 0.03);
  EXPECT_EQ(tissue(table, "vessel").viscosity_ns_per_mm, tissue(shipped_tissues(), "vessel").viscosity_ns_per_mm);
  ASSERT_TRUE(apply_override(table, "tissues.vessel.nu=0.01"));
  EXPECT_EQ(tissue(table, "vessel").viscosity_ns_per_mm, 0.01);
  EXPECT_EQ(layer(table, "vessel").viscosity_ns_per_mm, 0.03);
}

TEST(TissueTable, OverrideScalesACurveOverHu) {
  const TissueTable before = shipped_tissues();
  TissueTable table = before;
  ASSERT_TRUE(apply_override(table, "transfer.tn_factor=2"));
  ASSERT_TRUE(apply_override(table, "transfer.stiffness_n_per_mm_factor=10"));
  for (std::size_t n = 0; n < table.transfer.knot_count; ++n) {
    const HuLaw &was = before.transfer.laws[n], &is = table.transfer.laws[n];
    EXPECT_EQ(is.normal_n, 2.0 * was.normal_n);
    EXPECT_EQ(is.stiffness_n_per_mm, std::min(50.0, 10.0 * was.stiffness_n_per_mm)) << "kept in its range";
    EXPECT_EQ(is.resistance_n, was.resistance_n);
  }
  EXPECT_EQ(table.provenance.at("transfer.normal_n").source, "set by the user");
  const auto stored = parse_tissue_table(table.to_toml(), "stored");
  ASSERT_TRUE(stored) << stored.error().text();
  expect_same(*stored, table);
}

TEST(TissueTable, RefusesAnUnusableOverrideUnchanged) {
  const TissueTable before = shipped_tissues();
  for (const char* bad : {"",
                          "liver",
                          "liver.k",
                          "liver.k=",
                          "liver.k=x",
                          "liver.k=0.5x",
                          "liver.k=nan",
                          "liver.k=inf",
                          "liver.k=never",
                          "liver.k=-1",
                          "liver.k=51",
                          "liver.q=1",
                          "spleeen.k=1",
                          "air.mu=1",
                          "adipose.k=1",
                          "liver_capsule.mu=1",
                          "skin.thickness_mm=7",
                          "=1",
                          ".k=1",
                          "layers.liver.k=1",
                          "layers.liver_capsule.mu=1",
                          "tissues.air.mu=1",
                          "tissues.liver.k=1",
                          "layers..k=1",
                          "transfer.tn_factor=0.05",
                          "transfer.tn_factor=11",
                          "transfer.tn_factor=never",
                          "transfer.q_factor=1",
                          "transfer._factor=1",
                          "muscle.nu=1.01"}) {
    TissueTable table = before;
    const Status status = apply_override(table, bad);
    ASSERT_FALSE(status) << bad;
    EXPECT_EQ(status.error().exit_status, 2) << bad;
    expect_same(table, before);
  }
}

TEST(TissueTable, ListsLayerKeysOnlyForATissueWithALayer) {
  const auto advice_for = [](const char* text) {
    TissueTable table = shipped_tissues();
    const Status status = apply_override(table, text);
    return status ? std::string("no error") : status.error().advice;
  };
  EXPECT_EQ(advice_for("kidney.k=1"), "known are: nu, mu, delta, stick, fc, young");
  EXPECT_EQ(advice_for("liver.stiff=1"), "known are: nu, mu, delta, stick, fc, young, k, dx, fp");
}

TEST(TissueTable, ReadsTheTextOfOlderVersions) {
  // Every name in quotes, whole numbers without a fraction.
  const TissueTable table = shipped_tissues();
  std::string text = std::regex_replace(table.to_toml(), std::regex(R"(\[(layers|tissues)\.(\w+)\])"), "[$1.\"$2\"]");
  text = std::regex_replace(text, std::regex(R"(value = (\d+)\.0,)"), "value = $1,");
  EXPECT_NE(text.find("[tissues.\"liver\"]"), std::string::npos);
  const auto read = parse_tissue_table(text, "an older session");
  ASSERT_TRUE(read) << read.error().text();
  expect_same(*read, table);
}

TEST(TissueTable, RefusesADamagedTableWithItsLocation) {
  const std::string good = shipped_tissues().to_toml();
  const auto refused = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    text.replace(at, from.size(), to);
    const auto table = parse_tissue_table(text, "mine.toml");
    EXPECT_FALSE(table) << to;
    if (!table) {
      EXPECT_NE(table.error().text().find("mine.toml"), std::string::npos);
    }
  };
  refused("value = 0.46", "value = 460");
  refused("value = 0.46", "value = nan");
  refused("layer = \"muscle\"", "layer = \"mussle\"");
  refused("friction_mu", "friction");
  refused("[tissues.skin]", "[tissues.hide]");
  refused("[tissues.liver]", "[tissues.air]");
  refused("source = \"paper A, Table 1\"", "note = \"\"");
  refused("never = true", "never = false");
  refused("[skin]", "[skin2]");
}

TEST(TissueTable, FrictionIsReadChangedAndStored) {
  TissueTable table = shipped_tissues("paper-a");
  EXPECT_EQ(table.friction.tip, 2.0);
  EXPECT_EQ(table.friction.grows_to_mm_per_s, 9.0);
  ASSERT_TRUE(apply_override(table, "friction.grows_to=never"));
  ASSERT_TRUE(apply_override(table, "friction.tip=1.5"));
  const auto read = parse_tissue_table(table.to_toml(), "stored");
  ASSERT_TRUE(read) << read.error().text();
  EXPECT_TRUE(std::isinf(read->friction.grows_to_mm_per_s));
  EXPECT_EQ(read->friction.tip, 1.5);
  EXPECT_EQ(read->needle_size.bevel_power, 0.5);
  for (const char* bad : {"friction.tip=never", "friction.grows_to=0", "friction.grows_to=nan", "friction.mu=1"})
    EXPECT_FALSE(apply_override(table, bad)) << bad;
  // A table stored before there was such a section keeps paper A's law.
  std::string old = shipped_tissues("paper-a").to_toml();
  const std::size_t at = old.find("[friction]");
  old.erase(at, old.find('[', at + 1) == std::string::npos ? std::string::npos : old.find("\n[", at) - at);
  const auto before = parse_tissue_table(old, "stored");
  ASSERT_TRUE(before) << before.error().text();
  EXPECT_TRUE(std::isinf(before->friction.grows_to_mm_per_s));
}

}  // namespace
}  // namespace trocar::anatomy
