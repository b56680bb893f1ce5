#include "devices/pointer/speaker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

#include "core/files/temporary_folder.h"

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

TEST(Speaker, IsSilentWhereThereIsNoOutput) {
  const DiskDriver none("no such driver");
  {
    Speaker speaker;
    speaker.play(make_gun_click());
    EXPECT_FALSE(speaker.is_open());
  }  // the thread that looked for an output has ended
  EXPECT_EQ(none.loudest(), 0.0F);
}

TEST(Speaker, PlaysOnTheOutput) {
  const DiskDriver disk;
  Speaker speaker;
  while (!speaker.is_open()) std::this_thread::yield();
  const std::vector<float> click = make_gun_click();
  speaker.play(click);
  const float peak =
      *std::max_element(click.begin(), click.end(), [](float a, float b) { return std::abs(a) < std::abs(b); });
  while (disk.loudest() < std::abs(peak)) std::this_thread::yield();  // ends by the time limit of the test program
  EXPECT_FLOAT_EQ(disk.loudest(), std::abs(peak));
}

}  // namespace
}  // namespace trocar::devices
