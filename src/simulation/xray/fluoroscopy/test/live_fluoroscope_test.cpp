#include "xray/fluoroscopy/live_fluoroscope.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>

#include "xray/fluoroscopy/testing/trunk_phantom.h"

namespace trocar::xray {
namespace {

FluoroscopyRequest pedal_request() {
  FluoroscopyRequest request;
  request.arm.pixels = 64;
  request.is_pedal_down = true;
  return request;
}

/// Asks again and again, as a window does, until an image is as it should be; nullptr after a long time.
template <class Ready>
std::shared_ptr<const FluoroscopyFrame> ask_until(LiveFluoroscope& fluoroscope, FluoroscopyRequest& request,
                                                  const Ready& is_ready) {
  for (int n = 0; n < 10000; ++n) {
    request.time_s += 1.0 / 60.0;
    fluoroscope.request(request);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    const auto frame = fluoroscope.frames().value();
    if (frame && is_ready(*frame)) return frame;
  }
  return nullptr;
}

TEST(LiveFluoroscope, ShowsTheNewestOfManyRequests) {
  LiveFluoroscope fluoroscope;
  EXPECT_EQ(fluoroscope.frames().value(), nullptr);
  fluoroscope.open(testing::trunk());
  FluoroscopyRequest request = pedal_request();
  for (int n = 0; n < 200; ++n) {
    request.arm.lao_deg = 0.1 * n;
    fluoroscope.request(request);
  }
  const auto frame = ask_until(fluoroscope, request,
                               [&](const FluoroscopyFrame& made) { return made.arm.lao_deg == request.arm.lao_deg; });
  ASSERT_NE(frame, nullptr);
  EXPECT_LT(frame->number, 150U) << "requests that came before a newer one are left out";
}

TEST(LiveFluoroscope, HoldsTheLastImageWithThePedalUp) {
  LiveFluoroscope fluoroscope;
  fluoroscope.open(testing::trunk());
  FluoroscopyRequest request = pedal_request();
  ASSERT_NE(ask_until(fluoroscope, request, [](const FluoroscopyFrame& made) { return made.dose.pulses > 3; }),
            nullptr);
  request.is_pedal_down = false;
  const auto held = ask_until(fluoroscope, request, [](const FluoroscopyFrame& made) { return made.is_held; });
  ASSERT_NE(held, nullptr);
  request.arm.lao_deg = 40.0;
  request.display.is_inverted = true;
  const auto shown =
      ask_until(fluoroscope, request, [&](const FluoroscopyFrame& made) { return made.number > held->number; });
  ASSERT_NE(shown, nullptr);
  EXPECT_EQ(shown->arm.lao_deg, 0.0);
  EXPECT_EQ(shown->dose.pulses, held->dose.pulses);
  request.is_pedal_down = true;
  EXPECT_NE(ask_until(fluoroscope, request, [](const FluoroscopyFrame& made) { return made.arm.lao_deg == 40.0; }),
            nullptr);
}

TEST(LiveFluoroscope, RestartsWithAnotherPatient) {
  LiveFluoroscope fluoroscope;
  fluoroscope.open(testing::trunk());
  FluoroscopyRequest request = pedal_request();
  ASSERT_NE(ask_until(fluoroscope, request, [](const FluoroscopyFrame& made) { return made.dose.pulses > 5; }),
            nullptr);
  fluoroscope.open(testing::trunk());
  EXPECT_EQ(fluoroscope.frames().value(), nullptr);
  const auto first = ask_until(fluoroscope, request, [](const FluoroscopyFrame&) { return true; });
  ASSERT_NE(first, nullptr);
  EXPECT_LE(first->dose.pulses, 5);
}

TEST(LiveFluoroscope, NamesAnImpossibleCArmAndRecovers) {
  LiveFluoroscope fluoroscope;
  fluoroscope.open(testing::trunk());
  FluoroscopyRequest bad = pedal_request();
  bad.arm.source_isocentre_mm = 100.0;
  for (int n = 0; n < 10000 && !fluoroscope.error(); ++n) {
    fluoroscope.request(bad);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_TRUE(fluoroscope.error().has_value());
  FluoroscopyRequest request = pedal_request();
  EXPECT_NE(ask_until(fluoroscope, request, [](const FluoroscopyFrame&) { return true; }), nullptr);
  EXPECT_FALSE(fluoroscope.error().has_value());
}

}  // namespace
}  // namespace trocar::xray
