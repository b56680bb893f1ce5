#include <gtest/gtest.h>

#include "core/files/folders.h"
#include "core/testing/changed_file.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::ultrasound {
namespace {

const std::filesystem::path kOutputsFile = data_dir() / "transducers.toml";

TEST(AcousticOutput, MechanicalIndexIsPressureOverRootFrequency) {
  // At the face there is no tissue to derate for.
  EXPECT_DOUBLE_EQ(acoustic_indices({1.0, 1.0}, 1.0, 0.0).mechanical, 1.0);
  EXPECT_DOUBLE_EQ(acoustic_indices({2.0, 1.0}, 4.0, 0.0).mechanical, 1.0);
  EXPECT_DOUBLE_EQ(acoustic_indices({1.5, 1.0}, 9.0, 0.0).mechanical, 0.5);
}

TEST(AcousticOutput, DeratesTissueBy03DbPerCmAndMhz) {
  // 4 MHz through 5 cm: 6 dB, a factor of 10^(-0.3) = 0.501187.
  EXPECT_NEAR(acoustic_indices({2.0, 1.0}, 4.0, 50.0).mechanical, 0.501187, 1e-6);
  // Twice the way is twice the decibels.
  EXPECT_NEAR(acoustic_indices({2.0, 1.0}, 4.0, 100.0).mechanical, 0.501187 * 0.501187, 1e-6);
}

TEST(AcousticOutput, ThermalIndexIsOneAt210MwAndOneMhz) {
  EXPECT_DOUBLE_EQ(acoustic_indices({0.1, 210.0}, 1.0, 40.0).thermal, 1.0);
  EXPECT_DOUBLE_EQ(acoustic_indices({0.1, 42.0}, 5.0, 40.0).thermal, 1.0);
}

TEST(AcousticOutput, LimitLowersPowerWithPressureSquared) {
  // 3.8 at 1 MHz is twice the limit: half the pressure, a quarter of the power.
  const AcousticIndices indices = acoustic_indices({3.8, 84.0}, 1.0, 0.0);
  EXPECT_DOUBLE_EQ(indices.mechanical, 1.9);
  EXPECT_NEAR(indices.thermal, 0.1, 1e-12);
}

TEST(AcousticOutput, ShippedTransducersStayWithinTheLimits) {
  const auto transducers = load_transducers(kOutputsFile);
  ASSERT_TRUE(transducers) << transducers.error().text();
  for (const Transducer& t : *transducers) {
    const auto output = load_acoustic_output(kOutputsFile, t.name);
    ASSERT_TRUE(output) << output.error().text();
    for (double mhz = t.lowest_mhz; mhz <= t.highest_mhz; mhz += 0.25) {
      double last = kMostMechanicalIndex;
      for (double focus_mm = 5.0; focus_mm <= t.greatest_depth_mm; focus_mm += 5.0) {
        const AcousticIndices indices = acoustic_indices(*output, mhz, focus_mm);
        EXPECT_GT(indices.mechanical, 0.0) << t.name;
        EXPECT_LE(indices.mechanical, last) << t.name << ": deeper is never louder";
        EXPECT_LE(indices.thermal, 6.0) << t.name;  // the largest TI of FDA, track 3
        last = indices.mechanical;
      }
    }
    const AcousticIndices usual = acoustic_indices(*output, t.frequency_mhz, t.focus_mm);
    EXPECT_GT(usual.mechanical, 0.3) << t.name;
  }
}

TEST(AcousticOutput, WrongEntryNamesTransducerAndKey) {
  const auto load = [](const std::filesystem::path& file) { return load_acoustic_output(file, "C5-2"); };
  for (const auto& [from, to] : {std::pair{"pressure_mpa = {value = 4.5,", "pressure_mpa = {value = 45,"},
                                 std::pair{"pressure_mpa = {value = 4.5,", "pressure_kpa = {value = 4.5,"}}) {
    const auto wrong = testing::load_changed(kOutputsFile, from, to, load);
    ASSERT_FALSE(wrong) << to;
    EXPECT_NE(wrong.error().text().find("C5-2"), std::string::npos) << wrong.error().text();
    EXPECT_NE(wrong.error().text().find("pressure_"), std::string::npos) << wrong.error().text();
  }
  EXPECT_FALSE(load_acoustic_output(kOutputsFile, "no-such"));
}

}  // namespace
}  // namespace trocar::ultrasound
