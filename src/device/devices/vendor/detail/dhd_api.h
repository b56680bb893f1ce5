#pragma once

#include "devices/vendor/dynamic_library.h"

/// The used part of Force Dimension's DHD library, declared by hand. Names, signatures and values are those of its
/// header dhdc.h (SDK 3.3 to 3.17).
namespace trocar::devices::dhd {

inline constexpr int kNoError = 0;         // DHD_NO_ERROR; a lower value: failed
inline constexpr int kTimeGuard = 1;       // DHD_TIMEGUARD: called again too early, the previous values
inline constexpr int kMotorSaturated = 2;  // DHD_MOTOR_SATURATED: the force was reduced to the limit of the motors
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

/// DHD_MAX_STATUS is 16 or 17, depending on the release; this length leaves a margin for later releases.
inline constexpr int kStatusLength = 64;
inline constexpr int kStatusPower = 0;
inline constexpr int kStatusReset = 3;  ///< The device is not calibrated yet.
inline constexpr int kStatusForce = 5;  ///< The motors are on.
inline constexpr int kStatusForceOffCause = 14;
inline constexpr int kForceOffButton = 1;
inline constexpr int kForceOffVelocity = 2;
inline constexpr int kForceOffWatchdog = 3;

/// One count of dhdSetWatchdog; 0 counts switch the watchdog off.
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
  const char* (*error_text)();  ///< Text of the last error of the calling thread.
  // Since SDK 3.3.2; set_watchdog needs the expert mode (dhdEnableExpertMode).
  int (*get_watchdog)(unsigned char* counts, char id);
  int (*set_watchdog)(unsigned char counts, char id);
  int (*enable_expert_mode)();
  int (*disable_expert_mode)();
};

/// Loads libdhd.so under one of its names, or the file that TROCAR_LIBDHD names.
Result<Api> load_api();

}  // namespace trocar::devices::dhd
