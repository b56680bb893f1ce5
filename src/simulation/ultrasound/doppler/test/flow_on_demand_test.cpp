#include "ultrasound/doppler/flow_on_demand.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "ultrasound/doppler/test/tube_patient.h"

namespace trocar::ultrasound {
namespace {

using testing::make_steady_table;
using testing::make_tube_patient;

std::shared_ptr<const anatomy::VirtualPatient> patient_with(const std::string& label, double radius_mm) {
  return std::make_shared<const anatomy::VirtualPatient>(
      make_tube_patient({20.0, 20.0, 60.0}, {1.0, 1.0, 1.0},
                        {{label, [=](const Vec3& p_P) { return std::hypot(p_P.x(), p_P.y()) < radius_mm; }}}));
}

void wait_for(FlowOnDemand& flow) {
  while (flow.is_computing()) {
    flow.poll();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

TEST(FlowOnDemand, IsComputedWhenItIsFirstUsed) {
  const auto patient = patient_with("tube", 4.0);
  FlowOnDemand flow(patient, make_steady_table(60.0, 2.0));
  EXPECT_TRUE(flow.is_possible());
  EXPECT_FALSE(flow.is_computing());
  flow.poll();
  wait_for(flow);
  const auto first = flow.poll();
  ASSERT_TRUE(first);
  EXPECT_EQ(flow.poll(), first) << "once";
  const auto direct = make_vessel_flow(*patient, make_steady_table(60.0, 2.0));
  ASSERT_TRUE(direct);
  EXPECT_EQ(first->velocity_A(Vec3::Zero(), 0.0, 0.0), (*direct)->velocity_A(Vec3::Zero(), 0.0, 0.0));
  EXPECT_GT(first->velocity_A(Vec3::Zero(), 0.0, 0.0).norm(), 500.0);
}

TEST(FlowOnDemand, IsUnavailableWithoutATableRow) {
  FlowOnDemand flow(patient_with("unknown", 4.0), make_steady_table(60.0, 2.0));
  EXPECT_FALSE(flow.is_possible());
  EXPECT_FALSE(flow.poll());
  EXPECT_FALSE(flow.is_computing());
}

TEST(FlowOnDemand, IsUnavailableInTooSmallVessels) {
  FlowOnDemand flow(patient_with("tube", 0.6), make_steady_table(60.0, 2.0));
  EXPECT_TRUE(flow.is_possible());
  EXPECT_FALSE(flow.poll());
  wait_for(flow);
  EXPECT_FALSE(flow.is_possible());
  EXPECT_FALSE(flow.poll());
}

}  // namespace
}  // namespace trocar::ultrasound
