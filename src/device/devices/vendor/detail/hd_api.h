#pragma once

#include "devices/vendor/dynamic_library.h"

/// The used part of OpenHaptics' HD API, declared by hand. Names, signatures and values are those of its headers
/// hdDefines.h, hdDevice.h and hdScheduler.h (3.0 to 3.4; public copy: danepowell/openhaptics, usr/include/HD).
namespace trocar::devices::hd {

using Handle = unsigned int;                    // HHD
using Enum = unsigned int;                      // HDenum, HDerror
using Boolean = unsigned char;                  // HDboolean
using SchedulerHandle = unsigned long;          // HDSchedulerHandle
using Callback = unsigned int (*)(void* user);  // HDSchedulerCallback

struct ErrorInfo {  // HDErrorInfo
  Enum code;
  int internal_code;
  Handle device;
};

inline constexpr Handle kInvalidHandle = 0xFFFFFFFFu;
inline constexpr unsigned int kCallbackDone = 0;
inline constexpr unsigned int kCallbackContinue = 1;
inline constexpr unsigned short kHighestPriority = 0xFFFF;  // HD_MAX_SCHEDULER_PRIORITY = USHRT_MAX
inline constexpr unsigned short kLowestPriority = 0;        // HD_MIN_SCHEDULER_PRIORITY

inline constexpr Enum kSuccess = 0x0000;
inline constexpr Enum kBadHandle = 0x0104;
inline constexpr Enum kWarmMotors = 0x0200;  // first force error
inline constexpr Enum kExceededMaxForce = 0x0201;
inline constexpr Enum kForceError = 0x0204;  // last force error
inline constexpr Enum kDeviceFault = 0x0300;
inline constexpr Enum kCommError = 0x0302;
inline constexpr Enum kCommConfigError = 0x0303;
inline constexpr Enum kTimerError = 0x0304;

inline constexpr Enum kCurrentButtons = 0x2000;
inline constexpr Enum kCurrentTransform = 0x2052;  // 16 doubles, column-major, mm
inline constexpr Enum kDeviceModelType = 0x2501;
inline constexpr Enum kUsableWorkspace = 0x2551;  // 6 doubles: minimum x y z, maximum x y z, mm
inline constexpr Enum kOutputDof = 0x2554;
inline constexpr Enum kCalibrationStyle = 0x2555;
inline constexpr Enum kNominalMaxStiffness = 0x2602;        // N/mm
inline constexpr Enum kNominalMaxForce = 0x2603;            // N
inline constexpr Enum kNominalMaxContinuousForce = 0x2604;  // N
inline constexpr Enum kNominalMaxTorque = 0x2622;           // N mm
inline constexpr Enum kNominalMaxContinuousTorque = 0x2623;
inline constexpr Enum kCurrentForce = 0x2700;   // N
inline constexpr Enum kCurrentTorque = 0x2701;  // Cartesian, N mm (HAPI, PhantomHapticsDevice: "in Nmm")

inline constexpr Enum kForceOutput = 0x4000;
inline constexpr Enum kMaxForceClamping = 0x4001;

inline constexpr Enum kCalibrationOk = 0x5000;
inline constexpr Enum kCalibrationNeedsUpdate = 0x5001;
inline constexpr Enum kCalibrationNeedsManualInput = 0x5002;
inline constexpr int kStyleEncoderReset = 1 << 0;
inline constexpr int kStyleAuto = 1 << 1;
inline constexpr int kStyleInkwell = 1 << 2;

inline constexpr int kButton1 = 1 << 0;
inline constexpr int kButton2 = 1 << 1;

struct Api {
  Handle (*init_device)(const char* name);
  void (*disable_device)(Handle);
  void (*make_current_device)(Handle);
  void (*begin_frame)(Handle);
  void (*end_frame)(Handle);
  ErrorInfo (*get_error)();
  const char* (*get_error_string)(Enum code);
  void (*enable)(Enum capability);
  void (*disable)(Enum capability);
  void (*get_integerv)(Enum name, int* values);
  void (*get_doublev)(Enum name, double* values);
  void (*set_doublev)(Enum name, const double* values);
  const char* (*get_string)(Enum name);
  Enum (*check_calibration)();
  void (*update_calibration)(Enum style);
  void (*start_scheduler)();
  void (*stop_scheduler)();
  void (*set_scheduler_rate)(unsigned long hz);
  void (*schedule_synchronous)(Callback, void* user, unsigned short priority);
  SchedulerHandle (*schedule_asynchronous)(Callback, void* user, unsigned short priority);
  void (*unschedule)(SchedulerHandle);
};

/// Loads libHD.so, or the file that TROCAR_LIBHD names.
Result<Api> load_api();

}  // namespace trocar::devices::hd
