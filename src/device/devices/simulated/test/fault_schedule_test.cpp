#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "devices/simulated/faulty_device.h"

namespace trocar::devices {
namespace {

TEST(FaultSchedule, ReadsKindAmountStartAndDuration) {
  const auto jitter = parse_fault("jitter:0.3@1+2");
  ASSERT_TRUE(jitter) << jitter.error().text();
  EXPECT_EQ(jitter->fault, DeviceFault::kJitter);
  EXPECT_EQ(jitter->amount, 0.3);
  EXPECT_EQ(jitter->from_s, 1.0);
  EXPECT_EQ(jitter->for_s, 2.0);
  const auto nan = parse_fault("nan@2.0+0.5");
  ASSERT_TRUE(nan) << nan.error().text();
  EXPECT_EQ(nan->fault, DeviceFault::kNan);
  EXPECT_EQ(nan->from_s, 2.0);
  EXPECT_EQ(nan->for_s, 0.5);
}

TEST(FaultSchedule, LastsForEverWithoutADuration) {
  const auto fault = parse_fault("disconnect@5");
  ASSERT_TRUE(fault) << fault.error().text();
  EXPECT_EQ(fault->fault, DeviceFault::kDisconnect);
  EXPECT_TRUE(std::isinf(fault->for_s));
}

TEST(FaultSchedule, EveryKindIsReadByItsName) {
  for (const DeviceFault fault :
       {DeviceFault::kJitter, DeviceFault::kDropped, DeviceFault::kNan, DeviceFault::kStuck, DeviceFault::kJump,
        DeviceFault::kDisconnect, DeviceFault::kSlowWrite, DeviceFault::kSlowRead}) {
    const std::string name = to_string(fault);
    ASSERT_FALSE(name.empty());
    const auto plain = parse_fault(name + "@1");
    const auto with_amount = parse_fault(name + ":2@1");
    EXPECT_NE(plain.has_value(), with_amount.has_value()) << name;  // a kind takes an amount or it does not
    EXPECT_EQ((plain ? plain : with_amount)->fault, fault) << name;
  }
}

TEST(FaultSchedule, RefusesMalformedTextWithTheGrammar) {
  for (const char* text : {"",        "@",        "nan",       "nan@",        "nan@x",        "nan@1+",
                           "nan@1+x", "nan@-1",   "nan@1+-1",  "nan@nan",     "nan@inf",      "nan@1+inf",
                           "nan:1@1", "jitter@1", "jitter:@1", "jitter:-1@1", "jitter:1e9@1", "slow_write:60000@1",
                           "melt@1",  "nan@1 ",   " nan@1",    "nan@1+2+3",   "jitter:1:2@1", "NAN@1"}) {
    const auto fault = parse_fault(text);
    ASSERT_FALSE(fault) << text;
    EXPECT_EQ(fault.error().exit_status, 2) << text;
    EXPECT_NE(fault.error().advice.find("KIND[:AMOUNT]@FROM_S[+FOR_S]"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace trocar::devices
