#include "devices/pointer/speaker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <string>

#include "core/files/folders.h"

namespace trocar::devices {
namespace {

double loudest(const std::vector<float>& samples, double from_s, double to_s) {
  double most = 0.0;
  for (auto n = static_cast<std::size_t>(from_s * Speaker::kRate_hz);
       n < static_cast<std::size_t>(to_s * Speaker::kRate_hz); ++n)
    most = std::max(most, std::abs(static_cast<double>(samples[n])));
  return most;
}

TEST(Speaker, GunClicksTwiceThenStaysSilent) {
  const std::vector<float> click = make_gun_click();
  EXPECT_TRUE(std::all_of(click.begin(), click.end(), [](float s) { return std::isfinite(s) && std::abs(s) <= 1.0F; }));
  const double stylet = loudest(click, 0.0, 0.01), between = loudest(click, 0.045, 0.06);
  const double cannula = loudest(click, 0.06, 0.07), end = loudest(click, 0.24, 0.25);
  EXPECT_GT(stylet, 0.2);
  EXPECT_GT(cannula, 3.0 * between);
  EXPECT_LT(end, 0.001);
}

/// SDL's disk driver, which writes what is played into a file; declared before the speaker whose thread reads it.
class DiskDriver {
 public:
  /// `driver`: another name makes SDL find no output.
  explicit DiskDriver(const char* driver = "disk") {
    ::setenv("SDL_AUDIODRIVER", driver, 1);
    ::setenv("SDL_DISKAUDIOFILE", file().c_str(), 1);
  }
  ~DiskDriver() {
    ::unsetenv("SDL_AUDIODRIVER");
    ::unsetenv("SDL_DISKAUDIOFILE");
  }

  /// Loudest sample that was played until now.
  float loudest() const {
    std::ifstream stream(file(), std::ios::binary);
    float most = 0.0F;
    for (float sample = 0.0F; stream.read(reinterpret_cast<char*>(&sample), sizeof sample);)
      most = std::max(most, std::abs(sample));
    return most;
  }

 private:
  std::string file() const { return (folder_ / "played").string(); }

  TemporaryFolder folder_;
};

/// Polls for at most a minute.
bool eventually(const std::function<bool()>& is_true) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!is_true())
    if (std::chrono::steady_clock::now() > end) return false;
  return true;
}

TEST(Speaker, StaysClosedWithoutAnOutput) {
  const DiskDriver none("no such driver");
  Speaker speaker;
  ASSERT_TRUE(eventually([&] { return !speaker.is_opening(); }));
  EXPECT_FALSE(speaker.is_open());
  speaker.play(make_gun_click());  // dropped
}

TEST(Speaker, PlaysThroughTheOutput) {
  const DiskDriver disk;
  Speaker speaker;
  ASSERT_TRUE(eventually([&] { return speaker.is_open(); }));
  const std::vector<float> click = make_gun_click();
  speaker.play(click);
  const float peak =
      *std::max_element(click.begin(), click.end(), [](float a, float b) { return std::abs(a) < std::abs(b); });
  ASSERT_TRUE(eventually([&] { return disk.loudest() >= std::abs(peak); }));
  EXPECT_FLOAT_EQ(disk.loudest(), std::abs(peak));
}

}  // namespace
}  // namespace trocar::devices
