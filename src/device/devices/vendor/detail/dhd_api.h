#pragma once

#include "devices/vendor/dynamic_library.h"

/// The part of Force Dimension's DHD library that is used, declared by hand: names, signatures and values are facts of
/// its header dhdc.h (SDK 3.3 to 3.17).
namespace trocar::devices::dhd {

inline constexpr int kNoError = 0;         // DHD_NO_ERROR; below it: failed
inline constexpr int kTimeGuard = 1;       // DHD_TIMEGUARD: asked again too early, the values of before
inline constexpr int kMotorSaturated = 2;  // DHD_MOTOR_SATURATED: the force was cut to what the motors can give
inline constexpr unsigned char kOn = 1;
inline constexpr unsigned char kOff = 0;

inline constexpr int kDelta6 = 64;
inline constexpr int kOmega3 = 33;
inline constexpr int kOmega6 = 34;
inline constexpr int kOmega6Left = 36;
inline constexpr int kOmega7 = 35;
inline constexpr int kOmega7Left = 37;
inline constexpr int kFalcon = 60;
inline constexpr int kSigma7 = 104;
inline constexpr int kSigma7Left = 105;

/// DHD_MAX_STATUS is 16 or 17, and grew before: room for more.
inline constexpr int kStatusLength = 64;
inline constexpr int kStatusPower = 0;
inline constexpr int kStatusReset = 3;  ///< Waits for its calibration.
inline constexpr int kStatusForce = 5;  ///< The motors are on.
inline constexpr int kStatusForceOffCause = 14;
inline constexpr int kForceOffButton = 1;
inline constexpr int kForceOffVelocity = 2;
inline constexpr int kForceOffWatchdog = 3;

/// One count of dhdSetWatchdog; 0 counts switch it off.
inline constexpr double kWatchdogCount_s = 125e-6;

struct Api {
  int (*open)();
  int (*close)(char id);
  int (*get_system_type)(char id);
  const char* (*get_system_name)(char id);
  int (*enable_force)(unsigned char on, char id);
  int (*get_status)(int* status, char id);
  int (*set_gravity_compensation)(int on, char id);
  int (*get_pose)(double* x, double* y, double* z, double (*rows)[3], char id);
  int (*set_wrench)(double fx, double fy, double fz, double tx, double ty, double tz, double gripper, char id);
  int (*get_button)(int index, char id);
  const char* (*error_text)();  ///< Of the last error of the calling thread.
  // Since SDK 3.3.2; setting it is for experts (dhdEnableExpertMode).
  int (*get_watchdog)(unsigned char* counts, char id);
  int (*set_watchdog)(unsigned char counts, char id);
  int (*enable_expert_mode)();
  int (*disable_expert_mode)();
};

/// libdhd.so under one of its names, or what TROCAR_LIBDHD names.
Result<Api> load_api();

}  // namespace trocar::devices::dhd
