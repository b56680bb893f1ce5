#include "devices/vendor/detail/dhd_api.h"

namespace trocar::devices::dhd {
namespace {

// libdrd contains all of libdhd.
constexpr const char* kForceDimensionFiles[] = {"libdhd.so", "libdhd.so.3", "libdrd.so", "libdrd.so.3"};
constexpr LibraryPlace kForceDimensionPlace{
    .variable = "TROCAR_LIBDHD",
    .names = kForceDimensionFiles,
    .package = "the vendor's Force Dimension library (libdhd.so)",
    .advice = "install the Force Dimension SDK and allow yourself the device's USB port (udev rule)",
};

}  // namespace

Result<Api> load_api() {
  TROCAR_TRY(const DynamicLibrary library, DynamicLibrary::open(kForceDimensionPlace));
  Api api{};
  TROCAR_TRY_STATUS(library.find("dhdOpen", api.open));
  TROCAR_TRY_STATUS(library.find("dhdClose", api.close));
  TROCAR_TRY_STATUS(library.find("dhdGetSystemType", api.get_system_type));
  TROCAR_TRY_STATUS(library.find("dhdGetSystemName", api.get_system_name));
  TROCAR_TRY_STATUS(library.find("dhdEnableForce", api.enable_force));
  TROCAR_TRY_STATUS(library.find("dhdGetStatus", api.get_status));
  TROCAR_TRY_STATUS(library.find("dhdSetGravityCompensation", api.set_gravity_compensation));
  TROCAR_TRY_STATUS(library.find("dhdGetPositionAndOrientationFrame", api.get_pose));
  TROCAR_TRY_STATUS(library.find("dhdSetForceAndTorqueAndGripperForce", api.set_wrench));
  TROCAR_TRY_STATUS(library.find("dhdGetButton", api.get_button));
  TROCAR_TRY_STATUS(library.find("dhdErrorGetLastStr", api.error_text));
  library.find_optional("dhdGetWatchdog", api.get_watchdog);
  library.find_optional("dhdSetWatchdog", api.set_watchdog);
  library.find_optional("dhdEnableExpertMode", api.enable_expert_mode);
  library.find_optional("dhdDisableExpertMode", api.disable_expert_mode);
  return api;
}

}  // namespace trocar::devices::dhd
