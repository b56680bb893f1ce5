#include "devices/testing/gamepad_stand_in.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/mman.h>
#include <unistd.h>

#include "core/testing/source_dir.h"

namespace trocar::testing {
namespace {

constexpr int kLeftX = 0, kLeftY = 1, kLeftTrigger = 4, kRightTrigger = 5;  // SDL_GameControllerAxis
constexpr double kAxisEnd = 32767.0;
constexpr std::int32_t kTriggerFree = -32768;

}  // namespace

GamepadStandIn::GamepadStandIn(bool is_plugged) {
  const std::string path = (folder_ / "pad").string();
  const int file = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  EXPECT_EQ(::ftruncate(file, sizeof(GamepadControls)), 0);
  void* memory = ::mmap(nullptr, sizeof(GamepadControls), PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  EXPECT_NE(memory, MAP_FAILED);
  ::close(file);
  controls_ = new (memory) GamepadControls{};
  controls_->axes[kLeftTrigger] = controls_->axes[kRightTrigger] = kTriggerFree;
  controls_->is_plugged = is_plugged;
  ::setenv(kGamepadVariable, path.c_str(), 1);
  ::setenv("LD_PRELOAD", (standin_dir() / "libstandin_gamepad.so").c_str(), 1);
}

GamepadStandIn::~GamepadStandIn() {
  ::unsetenv("LD_PRELOAD");
  ::unsetenv(kGamepadVariable);
  ::munmap(controls_, sizeof(GamepadControls));
}

void GamepadStandIn::pull_right_trigger(double share) {
  controls_->axes[kRightTrigger] = static_cast<std::int32_t>(kTriggerFree + share * (kAxisEnd - kTriggerFree));
}

void GamepadStandIn::push_left_stick(double right, double away) {
  controls_->axes[kLeftX] = static_cast<std::int32_t>(kAxisEnd * right);
  controls_->axes[kLeftY] = static_cast<std::int32_t>(-kAxisEnd * away);
}

}  // namespace trocar::testing
