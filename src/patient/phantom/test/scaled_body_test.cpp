// Factors on the numbers of an embedded case's body, after its name.
#include <gtest/gtest.h>

#include <algorithm>

#include "phantom/cases.h"
#include "phantom/phantom.h"

namespace trocar::phantom {
namespace {

TEST(ScaledBody, MultipliesWithinTheRanges) {
  BodyParameters body;
  body.weight_kg = 80.0;
  body.lesion_diameter_mm = 20.0;
  ASSERT_TRUE(scale_body(body, "weight_kg=1.25,lesion_diameter_mm=0.5"));
  EXPECT_DOUBLE_EQ(body.weight_kg, 100.0);
  EXPECT_DOUBLE_EQ(body.lesion_diameter_mm, 10.0);
  ASSERT_TRUE(scale_body(body, "weight_kg=3"));
  EXPECT_DOUBLE_EQ(body.weight_kg, 160.0) << "the largest";
  ASSERT_TRUE(scale_body(body, ""));
  EXPECT_DOUBLE_EQ(body.weight_kg, 160.0);
}

TEST(ScaledBody, RefusesMalformedFactors) {
  const auto error_of = [](const char* factors) {
    BodyParameters body;
    const Status status = scale_body(body, factors);
    return status ? std::string("no error") : status.error().text();
  };
  EXPECT_NE(error_of("beauty=2").find("weight_kg"), std::string::npos) << "lists the keys";
  for (const char* wrong : {"weight_kg", "weight_kg=", "weight_kg=fat", "weight_kg=9", "weight_kg=0", "weight_kg=nan",
                            "weight_kg=1.1x", ",", "=2"})
    EXPECT_NE(error_of(wrong), "no error") << wrong;
}

TEST(ScaledBody, HasANewHashForTheSameCase) {
  PhantomResolution coarse;
  coarse.voxel_mm = 3.0;
  const auto skin_ml = [](const anatomy::VirtualPatient& patient) {
    return static_cast<double>(
               std::ranges::count_if(patient.skin_distance_mm.voxels, [](float d) { return d < 0.0F; })) *
           patient.skin_distance_mm.geometry.voxel_volume_mm3() / 1000.0;
  };
  const auto usual = generate_phantom("lumbar-1", 1, coarse);
  const auto heavy = generate_phantom("lumbar-1@weight_kg=1.4", 1, coarse);
  ASSERT_TRUE(usual && heavy);
  EXPECT_EQ(heavy->name, "lumbar-1@weight_kg=1.4");
  EXPECT_NE(heavy->content_hash, usual->content_hash);
  EXPECT_GT(skin_ml(*heavy), 1.15 * skin_ml(*usual));
  EXPECT_EQ(generate_phantom("lumbar-1@", 1, coarse)->content_hash, usual->content_hash);
}

TEST(ScaledBody, IsAvailableForCasesOnly) {
  EXPECT_TRUE(has_body("biopsy-3"));
  EXPECT_TRUE(has_body("biopsy-3@weight_kg=1.1"));
  EXPECT_TRUE(has_body(kVariantPatient));
  EXPECT_FALSE(has_body("abdomen"));
  EXPECT_FALSE(has_body("layers-liver"));
  EXPECT_FALSE(has_body("nobody"));
  const auto abdomen = generate_phantom("abdomen@weight_kg=1.2");
  ASSERT_FALSE(abdomen);
  EXPECT_NE(abdomen.error().text().find("has no body"), std::string::npos) << abdomen.error().text();
  const auto nobody = generate_phantom("nobody@weight_kg=1.2");
  ASSERT_FALSE(nobody);
  EXPECT_NE(nobody.error().text().find("there are"), std::string::npos) << nobody.error().text();
}

}  // namespace
}  // namespace trocar::phantom
