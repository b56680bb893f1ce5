#include <gtest/gtest.h>

#include "telemetry/tick_sample.h"

namespace trocar::telemetry {
namespace {

TEST(TickEvents, FillTheEntriesFromTheFront) {
  TickSample sample;
  for (std::size_t n = 0; n < sample.events.size(); ++n) {
    EXPECT_TRUE(add_event(sample, {EventKind::kEnter, static_cast<std::uint8_t>(n)}));
    EXPECT_EQ(sample.events[n].kind, EventKind::kEnter);
    EXPECT_EQ(sample.events[n].id, n);
  }
}

TEST(TickEvents, AreDroppedByAFullSample) {
  TickSample sample;
  sample.events.fill({EventKind::kEnter, 7});
  EXPECT_FALSE(add_event(sample, limit_event(LimitReason::kFault)));
  for (const TickEvent& event : sample.events) EXPECT_EQ(event.kind, EventKind::kEnter);
}

TEST(TickEvents, ReportALimitByItsReason) {
  const TickEvent event = limit_event(LimitReason::kSlew);
  EXPECT_EQ(event.kind, EventKind::kLimit);
  EXPECT_EQ(event.id, static_cast<std::uint8_t>(LimitReason::kSlew));
}

}  // namespace
}  // namespace trocar::telemetry
