#include "registration/ct_ultrasound/landmark_fit.h"

#include <gtest/gtest.h>

namespace trocar::registration {
namespace {

using NamedPoints = std::vector<NamedPoint>;

const Pose kX_CU(Eigen::AngleAxisd(0.7, Vec3(1, 2, 2) / 3.0).toRotationMatrix(), Vec3(30, -120, 55));

NamedPoints ultrasound() {
  return {{"hilum", Vec3(0, 50, 0)},
          {"apex", Vec3(40, 60, 10)},
          {"lesion", Vec3(-20, 90, -30)},
          {"vein", Vec3(10, 30, 40)},
          {"kidney", Vec3(-40, 70, 20)}};
}

/// In another order.
NamedPoints ct() {
  NamedPoints points;
  for (const NamedPoint& point : ultrasound()) points.insert(points.begin(), {point.name, kX_CU * point.p});
  return points;
}

std::string refusal(const NamedPoints& ct, const NamedPoints& us) {
  const auto fit = fit_landmarks(ct, us);
  return fit ? std::string() : fit.error().text();
}

TEST(LandmarkFit, PairsByLabel) {
  const auto fit = fit_landmarks(ct(), ultrasound());
  ASSERT_TRUE(fit) << fit.error().text();
  EXPECT_LT((fit->fit.X_AB.p() - kX_CU.p()).norm(), 1e-9);
  EXPECT_TRUE(fit->warning.empty());
  EXPECT_TRUE(fit->unmatched.empty());
}

TEST(LandmarkFit, ListsUnmatchedLabels) {
  NamedPoints us = ultrasound();
  us.push_back({"spleen", Vec3(1, 2, 3)});
  const auto fit = fit_landmarks(ct(), us);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->unmatched, std::vector<std::string>{"spleen"});
}

TEST(LandmarkFit, NamesTheWorstPair) {
  NamedPoints us = ultrasound();
  us[2].p += Vec3(0, 8, 0);
  const auto doubtful = fit_landmarks(ct(), us);
  ASSERT_TRUE(doubtful);
  EXPECT_EQ(doubtful->worst, "lesion");
  EXPECT_NE(doubtful->warning.find("lesion"), std::string::npos);
  us[2].p += Vec3(0, 30, 0);
  EXPECT_NE(refusal(ct(), us).find("lesion"), std::string::npos);
}

TEST(LandmarkFit, RefusesAScaleDifference) {
  NamedPoints us = ultrasound();
  for (NamedPoint& point : us) point.p *= 1.1;
  EXPECT_NE(refusal(ct(), us).find("scale 0.909"), std::string::npos);
}

TEST(LandmarkFit, RefusesDegenerateLandmarks) {
  NamedPoints us = ultrasound();
  us.resize(2);
  EXPECT_NE(refusal(ct(), us).find("at least 3"), std::string::npos);
  EXPECT_NE(refusal(ct(), {{"a", Vec3(1, 0, 0)}, {"b", Vec3(0, 1, 0)}, {"c", Vec3(0, 0, 1)}}).find("unmatched: "),
            std::string::npos);
  us = ultrasound();
  for (NamedPoint& point : us) point.p.x() = -point.p.x();
  EXPECT_NE(refusal(ct(), us).find("mirrored"), std::string::npos);
  us = ultrasound();
  us[1].name = "hilum";
  EXPECT_NE(refusal(ct(), us).find("twice"), std::string::npos);
  EXPECT_NE(refusal({{"a", Vec3(0, 0, 0)}, {"b", Vec3(1, 0, 0)}, {"c", Vec3(2, 0, 0)}},
                    {{"a", Vec3(0, 0, 0)}, {"b", Vec3(1, 0, 0)}, {"c", Vec3(2, 0, 0)}})
                .find("one line"),
            std::string::npos);
}

}  // namespace
}  // namespace trocar::registration
