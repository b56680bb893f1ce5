#include "devices/pointer/speaker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <thread>

namespace trocar::devices {
namespace {

double loudest(const std::vector<float>& samples, double from_s, double to_s) {
  double most = 0.0;
  for (auto n = static_cast<std::size_t>(from_s * Speaker::kRate_hz);
       n < static_cast<std::size_t>(to_s * Speaker::kRate_hz); ++n)
    most = std::max(most, std::abs(static_cast<double>(samples[n])));
  return most;
}

TEST(Speaker, TheGunClicksTwiceAndEndsInSilence) {
  const std::vector<float> click = make_gun_click();
  EXPECT_TRUE(std::all_of(click.begin(), click.end(), [](float s) { return std::isfinite(s) && std::abs(s) <= 1.0F; }));
  const double stylet = loudest(click, 0.0, 0.01), between = loudest(click, 0.045, 0.06);
  const double cannula = loudest(click, 0.06, 0.07), end = loudest(click, 0.24, 0.25);
  EXPECT_GT(stylet, 0.2);
  EXPECT_GT(cannula, 3.0 * between);
  EXPECT_LT(end, 0.001);
}

/// SDL's choice of driver while it lives: declared before the speaker whose thread reads it.
struct Driver {
  explicit Driver(const char* name) { ::setenv("SDL_AUDIODRIVER", name, 1); }
  ~Driver() { ::unsetenv("SDL_AUDIODRIVER"); }
};

TEST(Speaker, IsSilentWhereThereIsNoOutput) {
  const Driver none("no such driver");
  Speaker speaker;
  speaker.play(make_gun_click());
}

TEST(Speaker, OpensAnOutputAndPlays) {
  const Driver dummy("dummy");
  Speaker speaker;
  while (!speaker.is_open()) std::this_thread::yield();
  speaker.play(make_gun_click());
}

}  // namespace
}  // namespace trocar::devices
