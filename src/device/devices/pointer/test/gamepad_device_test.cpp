#include "devices/pointer/gamepad_device.h"

#include <SDL.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <cmath>

#include "devices/pointer/test/pointer_checks.h"
#include "devices/pointer/test/virtual_gamepad.h"
#include "devices/test/bad_numbers.h"

namespace trocar::devices {
namespace {

using testing::is_gone;
using testing::kInfinity;
using testing::kNaN;
using testing::kTick_s;
using testing::reads_until;
using testing::wait_until;

/// SDL's virtual joystick in the layout of a gamepad. Its state is set by any thread and taken over by SDL's update in
/// the thread that polls, where the rumble comes back.
class VirtualPad {
 public:
  VirtualPad() {
    SDL_SetHint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    SDL_InitSubSystem(SDL_INIT_GAMECONTROLLER);
    attach();
  }
  ~VirtualPad() {
    detach();
    SDL_QuitSubSystem(SDL_INIT_GAMECONTROLLER);
  }
  VirtualPad(const VirtualPad&) = delete;
  VirtualPad& operator=(const VirtualPad&) = delete;

  void attach() {
    SDL_VirtualJoystickDesc description = testing::gamepad_description("Trocar test pad");
    description.userdata = this;
    description.Update = [](void* self) { static_cast<VirtualPad*>(self)->update(); };
    description.Rumble = [](void* self, Uint16 low, Uint16 high) {
      auto* pad = static_cast<VirtualPad*>(self);
      pad->low_ = low;
      pad->high_ = high;
      return 0;
    };
    axes_[SDL_CONTROLLER_AXIS_TRIGGERLEFT] = SDL_JOYSTICK_AXIS_MIN;
    axes_[SDL_CONTROLLER_AXIS_TRIGGERRIGHT] = SDL_JOYSTICK_AXIS_MIN;
    const int index = SDL_JoystickAttachVirtualEx(&description);
    ASSERT_GE(index, 0) << SDL_GetError();
    id_ = SDL_JoystickGetDeviceInstanceID(index);
  }
  void detach() {
    for (int i = 0; i < SDL_NumJoysticks(); ++i) {
      if (SDL_JoystickGetDeviceInstanceID(i) == id_) {
        SDL_JoystickDetachVirtual(i);
        return;
      }
    }
  }

  /// -1..1; triggers too, where -1 is let go.
  void set_axis(SDL_GameControllerAxis axis, double value) {
    axes_[static_cast<std::size_t>(axis)] = static_cast<int>(value * SDL_JOYSTICK_AXIS_MAX);
  }
  void press(SDL_GameControllerButton button, bool is_pressed) {
    buttons_[static_cast<std::size_t>(button)] = is_pressed;
  }
  int low() const { return low_; }
  int high() const { return high_; }

 private:
  void update() {
    SDL_Joystick* joystick = SDL_JoystickFromInstanceID(id_);
    if (joystick == nullptr) return;
    for (std::size_t i = 0; i < axes_.size(); ++i) {
      SDL_JoystickSetVirtualAxis(joystick, static_cast<int>(i), static_cast<Sint16>(axes_[i].load()));
    }
    for (std::size_t i = 0; i < buttons_.size(); ++i) {
      SDL_JoystickSetVirtualButton(joystick, static_cast<int>(i), buttons_[i] ? 1 : 0);
    }
  }

  std::atomic<SDL_JoystickID> id_{-1};
  std::array<std::atomic<int>, SDL_CONTROLLER_AXIS_MAX> axes_{};
  std::array<std::atomic<bool>, SDL_CONTROLLER_BUTTON_MAX> buttons_{};
  std::atomic<int> low_{-1};
  std::atomic<int> high_{-1};
};

stylus::DevicePreset gamepad() {
  stylus::DevicePreset preset;
  preset.name = "gamepad";
  preset.workspace_radius_mm = 100.0;
  return preset;
}

std::unique_ptr<HapticDevice> open_pad() {
  auto device = PolledPointer::open(gamepad(), make_gamepad_source());
  EXPECT_TRUE(device.has_value()) << device.error().text();
  return device ? std::move(*device) : nullptr;
}

TEST(GamepadMotion, RestsWithinTheDeadZone) {
  GamepadState state;
  state.left_x = 0.9 * kStickDeadZone;
  state.right_y = -0.9 * kStickDeadZone;
  state.left_trigger = state.right_trigger = 0.9 * kTriggerDeadZone;
  const PointerMotion motion = gamepad_motion(state);
  EXPECT_TRUE(motion.v_D.isZero(0.0));
  EXPECT_TRUE(motion.w_D.isZero(0.0));
  EXPECT_EQ(motion.inward_mm_per_s, 0.0);
  EXPECT_EQ(motion.turning_rad_per_s, 0.0);
}

TEST(GamepadMotion, LeftStickMovesSidewaysAndAway) {
  GamepadState state;
  state.left_x = 1.0;
  EXPECT_NEAR((gamepad_motion(state).v_D - Vec3(kPadSpeed_mm_per_s, 0, 0)).norm(), 0.0, 1e-12);
  state.left_x = 0.0;
  state.left_y = -1.0;  // pushed away
  EXPECT_NEAR((gamepad_motion(state).v_D - Vec3(0, kPadSpeed_mm_per_s, 0)).norm(), 0.0, 1e-12);
}

TEST(GamepadMotion, IsContinuousAtTheDeadZoneAndGrowsWithTheStick) {
  double last = 0.0;
  constexpr int kSteps = 200;
  for (int i = 0; i <= kSteps; ++i) {
    GamepadState state;
    state.left_x = static_cast<double>(i) / kSteps;
    const double speed = gamepad_motion(state).v_D.x();
    EXPECT_GE(speed, last);
    EXPECT_LT(speed - last, 0.05 * kPadSpeed_mm_per_s);
    last = speed;
  }
  EXPECT_DOUBLE_EQ(last, kPadSpeed_mm_per_s);
}

TEST(GamepadMotion, DiagonalStickIsNoFaster) {
  GamepadState state;
  state.left_x = state.left_y = 1.0;
  EXPECT_NEAR(gamepad_motion(state).v_D.norm(), kPadSpeed_mm_per_s, 1e-9);
}

TEST(GamepadMotion, RightStickSwingsTheTipToWhereItPoints) {
  const auto tip_after = [](double x, double y) {
    GamepadState state;
    state.right_x = x;
    state.right_y = y;
    return move_pointer(pointer_start(), gamepad_motion(state), 0.1, 100.0).R().col(2).eval();
  };
  EXPECT_GT(tip_after(1.0, 0.0).x(), 0.01);
  EXPECT_LT(tip_after(-1.0, 0.0).x(), -0.01);
  EXPECT_GT(tip_after(0.0, -1.0).y(), 0.01);  // pushed away
}

TEST(GamepadMotion, TriggersMoveAlongTheNeedleAndShouldersTurnIt) {
  GamepadState state;
  state.right_trigger = 1.0;
  EXPECT_DOUBLE_EQ(gamepad_motion(state).inward_mm_per_s, kPadInward_mm_per_s);
  state.left_trigger = 1.0;
  EXPECT_DOUBLE_EQ(gamepad_motion(state).inward_mm_per_s, 0.0);
  state.is_right_shoulder = true;
  EXPECT_DOUBLE_EQ(gamepad_motion(state).turning_rad_per_s, kPadTurning_rad_per_s);
  state.is_down = true;
  EXPECT_DOUBLE_EQ(gamepad_motion(state).v_D.z(), -kPadSpeed_mm_per_s);
}

TEST(GamepadMotion, ClampsInvalidAxisValues) {
  for (const double bad : {kNaN, kInfinity, -kInfinity, 1e200}) {
    const GamepadState state{bad, bad, bad, bad, bad, bad};
    const PointerMotion motion = gamepad_motion(state);
    EXPECT_LE(motion.v_D.norm(), kPadSpeed_mm_per_s * (1 + 1e-9));
    EXPECT_LE(motion.w_D.norm(), kPadTilt_rad_per_s * (1 + 1e-9));
    EXPECT_LE(std::abs(motion.inward_mm_per_s), kPadInward_mm_per_s);
  }
}

TEST(RumblePower, IsLinearBetweenItsEnds) {
  EXPECT_EQ(rumble_power(0.0), 0.0);
  EXPECT_EQ(rumble_power(kRumbleFrom_n), 0.0);
  EXPECT_DOUBLE_EQ(rumble_power((kRumbleFrom_n + kRumbleFull_n) / 2), 0.5);
  EXPECT_EQ(rumble_power(kRumbleFull_n), 1.0);
  EXPECT_EQ(rumble_power(1e200), 1.0);
  EXPECT_EQ(rumble_power(kNaN), 0.0);
}

TEST(Gamepad, ErrorExplainsHowToConnectOne) {
  const auto device = PolledPointer::open(gamepad(), make_gamepad_source());
  if (device.has_value()) GTEST_SKIP() << "a real gamepad is connected";
  EXPECT_NE(device.error().text().find("connect or pair one"), std::string::npos);
}

TEST(Gamepad, StickMovesTheStylus) {
  VirtualPad pad;
  const auto device = open_pad();
  ASSERT_NE(device, nullptr);
  EXPECT_EQ(device->name(), "gamepad");
  pad.set_axis(SDL_CONTROLLER_AXIS_LEFTX, 1.0);
  double now_s = 100.0;
  Pose X_DS;
  EXPECT_TRUE(reads_until(*device, now_s, [&](const DeviceReading& reading) {
    X_DS = reading.X_DS;
    return X_DS.p().x() > 5.0;
  }));
  EXPECT_NEAR(X_DS.p().tail<2>().norm(), 0.0, 1e-9);
  EXPECT_NEAR((X_DS.R() - pointer_start().R()).norm(), 0.0, 1e-9);
}

TEST(Gamepad, TriggerMovesDownIntoTheBody) {
  VirtualPad pad;
  const auto device = open_pad();
  ASSERT_NE(device, nullptr);
  pad.set_axis(SDL_CONTROLLER_AXIS_TRIGGERRIGHT, 1.0);
  double now_s = 0.0;
  EXPECT_TRUE(reads_until(*device, now_s, [](const DeviceReading& r) { return r.X_DS.p().z() < -2.0; }));
}

TEST(Gamepad, ReportsButtons) {
  VirtualPad pad;
  const auto device = open_pad();
  ASSERT_NE(device, nullptr);
  double now_s = 0.0;
  pad.press(SDL_CONTROLLER_BUTTON_A, true);
  EXPECT_TRUE(reads_until(*device, now_s, [](const DeviceReading& r) { return r.buttons == kButtonMain; }));
  pad.press(SDL_CONTROLLER_BUTTON_B, true);
  EXPECT_TRUE(
      reads_until(*device, now_s, [](const DeviceReading& r) { return r.buttons == (kButtonMain | kButtonSecond); }));
  pad.press(SDL_CONTROLLER_BUTTON_A, false);
  pad.press(SDL_CONTROLLER_BUTTON_B, false);
  EXPECT_TRUE(reads_until(*device, now_s, [](const DeviceReading& r) { return r.buttons == 0; }));
}

TEST(Gamepad, RumblesWhileForceIsWritten) {
  VirtualPad pad;
  auto device = open_pad();
  ASSERT_NE(device, nullptr);
  const double force_n = (kRumbleFrom_n + kRumbleFull_n) / 2;
  const Wrench wrench{Vec3(0.0, force_n, 0.0), Vec3::Zero()};
  const auto rumbles = [&] {
    EXPECT_TRUE(device->write(wrench));
    return pad.low() == 32767 && pad.high() == 32767;
  };
  EXPECT_TRUE(wait_until(rumbles));
  EXPECT_TRUE(wait_until([&] { return pad.low() == 0 && pad.high() == 0; }));  // nobody writes
  EXPECT_TRUE(wait_until(rumbles));
  device.reset();
  EXPECT_EQ(pad.low(), 0);
  EXPECT_EQ(pad.high(), 0);
}

TEST(Gamepad, ForceThatIsNotFiniteIsRefused) {
  VirtualPad pad;
  const auto device = open_pad();
  ASSERT_NE(device, nullptr);
  EXPECT_FALSE(device->write({Vec3(kNaN, 0, 0), Vec3::Zero()}));
  EXPECT_FALSE(device->write({Vec3(1e200, 1e200, 0), Vec3::Zero()}));  // its norm is infinite
  EXPECT_TRUE(device->write({Vec3(1e10, 0, 0), Vec3::Zero()}));
}

TEST(Gamepad, ReconnectsAtItsLastPose) {
  VirtualPad pad;
  const auto device = open_pad();
  ASSERT_NE(device, nullptr);
  double now_s = 0.0;
  pad.set_axis(SDL_CONTROLLER_AXIS_LEFTX, 1.0);
  EXPECT_TRUE(reads_until(*device, now_s, [](const DeviceReading& r) { return r.X_DS.p().x() > 1.0; }));
  pad.set_axis(SDL_CONTROLLER_AXIS_LEFTX, 0.0);
  pad.detach();
  EXPECT_TRUE(reads_until(*device, now_s, is_gone));
  EXPECT_FALSE(device->write({}));
  EXPECT_FALSE(device->reconnect().has_value());
  EXPECT_TRUE(is_gone(device->read(now_s)));
  const Pose X_DS = device->read(now_s).X_DS;

  pad.attach();
  const Status status = device->reconnect();
  ASSERT_TRUE(status.has_value()) << status.error().text();
  now_s += 1000.0;  // however long it took
  Pose back;
  EXPECT_TRUE(reads_until(*device, now_s, [&](const DeviceReading& r) {
    back = r.X_DS;
    return r.status == DeviceStatus::kFresh;
  }));
  EXPECT_EQ(back.p(), X_DS.p());
}

TEST(Gamepad, ReadAndWriteDoNotAllocate) {
  VirtualPad pad;
  const auto device = open_pad();
  ASSERT_NE(device, nullptr);
  pad.set_axis(SDL_CONTROLLER_AXIS_LEFTX, 1.0);
  pad.set_axis(SDL_CONTROLLER_AXIS_RIGHTX, 1.0);
  testing::expect_no_allocation(*device);
}

TEST(Gamepad, IsOpenedByItsName) {
  const VirtualPad pad;
  testing::expect_opened_by_name("gamepad");
}

}  // namespace
}  // namespace trocar::devices
