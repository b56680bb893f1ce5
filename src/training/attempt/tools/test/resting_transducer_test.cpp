#include <gtest/gtest.h>

#include "attempt/tools/tool_motion.h"
#include "phantom/phantom.h"
#include "volume/sampling.h"

namespace trocar::attempt {
namespace {

class RestingTransducerTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    auto made = phantom::generate_phantom("layers-liver");
    ASSERT_TRUE(made.has_value());
    patient = new anatomy::VirtualPatient(*std::move(made));
  }
  static void TearDownTestSuite() {
    delete patient;
    patient = nullptr;
  }
  static inline anatomy::VirtualPatient* patient = nullptr;

  static const Segment& path() { return patient->paths.front().line_P; }
  static double above_skin_mm(const link::HandTarget& hand) {
    return volume::sample_linear(patient->skin_distance_mm, hand.X_PN.p());
  }
  static constexpr double kTremor_mm = 0.2;  // of three axes together
};

TEST_F(RestingTransducerTest, DescendsOntoTheSkinAndStaysPressedIn) {
  const RestingTransducer hand(*patient, path());
  EXPECT_NEAR(above_skin_mm(hand.at(0.0)), RestingTransducer::kAbove_mm, 0.5);
  for (const double time_s : {2.0, 10.0, 60.0})
    EXPECT_NEAR(above_skin_mm(hand.at(time_s)), -RestingTransducer::kPress_mm, 0.5) << time_s;
}

TEST_F(RestingTransducerTest, FacesTheBodyBesideTheEntry) {
  const RestingTransducer hand(*patient, path());
  const link::HandTarget held = hand.at(10.0);
  EXPECT_NEAR((held.X_PN.p() - path().a).norm(), RestingTransducer::kBeside_mm, 0.15 * RestingTransducer::kBeside_mm);
  const Vec3 outwards_P = volume::gradient_per_mm(patient->skin_distance_mm, held.X_PN.p()).normalized();
  EXPECT_LT(held.X_PN.R().col(1).dot(outwards_P), -0.99);
  EXPECT_NEAR(held.X_PN.R().determinant(), 1.0, 1e-9);
  EXPECT_LT((held.X_PN.R() * held.X_PN.R().transpose() - Mat3::Identity()).norm(), 1e-9);
}

TEST_F(RestingTransducerTest, TremblesAndReportsItsVelocity) {
  const RestingTransducer hand(*patient, path());
  constexpr double kStep_s = 1e-6;
  for (int i = 0; i < 400; ++i) {
    const double time_s = 0.013 * i + 0.001;
    const Vec3 moved = hand.at(time_s + kStep_s).X_PN.p() - hand.at(time_s - kStep_s).X_PN.p();
    EXPECT_LT((moved / (2 * kStep_s) - hand.at(time_s).v_P).norm(), 0.1) << time_s;
  }
  const Vec3 rest = hand.at(5.0).X_PN.p();
  for (int i = 1; i <= 20; ++i) EXPECT_LT((hand.at(5.0 + 0.05 * i).X_PN.p() - rest).norm(), 2 * kTremor_mm);
  EXPECT_GT((hand.at(5.02).X_PN.p() - rest).norm(), 1e-3);
}

}  // namespace
}  // namespace trocar::attempt
