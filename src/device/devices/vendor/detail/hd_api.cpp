#include "devices/vendor/detail/hd_api.h"

namespace trocar::devices::hd {
namespace {

constexpr const char* kOpenHapticsFiles[] = {"libHD.so", "libHD.so.3.4", "libHD.so.3"};
constexpr LibraryPlace kOpenHapticsPlace{
    .variable = "TROCAR_LIBHD",
    .names = kOpenHapticsFiles,
    .package = "the vendor's OpenHaptics library (libHD.so)",
    .advice = "install the vendor's OpenHaptics toolkit and the driver of the device (Touch Device Driver)",
};

}  // namespace

Result<Api> load_api() {
  TROCAR_TRY(const DynamicLibrary library, DynamicLibrary::open(kOpenHapticsPlace));
  Api api{};
  TROCAR_TRY_STATUS(library.find("hdInitDevice", api.init_device));
  TROCAR_TRY_STATUS(library.find("hdDisableDevice", api.disable_device));
  TROCAR_TRY_STATUS(library.find("hdMakeCurrentDevice", api.make_current_device));
  TROCAR_TRY_STATUS(library.find("hdBeginFrame", api.begin_frame));
  TROCAR_TRY_STATUS(library.find("hdEndFrame", api.end_frame));
  TROCAR_TRY_STATUS(library.find("hdGetError", api.get_error));
  TROCAR_TRY_STATUS(library.find("hdGetErrorString", api.get_error_string));
  TROCAR_TRY_STATUS(library.find("hdEnable", api.enable));
  TROCAR_TRY_STATUS(library.find("hdDisable", api.disable));
  TROCAR_TRY_STATUS(library.find("hdGetIntegerv", api.get_integerv));
  TROCAR_TRY_STATUS(library.find("hdGetDoublev", api.get_doublev));
  TROCAR_TRY_STATUS(library.find("hdSetDoublev", api.set_doublev));
  TROCAR_TRY_STATUS(library.find("hdGetString", api.get_string));
  TROCAR_TRY_STATUS(library.find("hdCheckCalibration", api.check_calibration));
  TROCAR_TRY_STATUS(library.find("hdUpdateCalibration", api.update_calibration));
  TROCAR_TRY_STATUS(library.find("hdStartScheduler", api.start_scheduler));
  TROCAR_TRY_STATUS(library.find("hdStopScheduler", api.stop_scheduler));
  TROCAR_TRY_STATUS(library.find("hdSetSchedulerRate", api.set_scheduler_rate));
  TROCAR_TRY_STATUS(library.find("hdScheduleSynchronous", api.schedule_synchronous));
  TROCAR_TRY_STATUS(library.find("hdScheduleAsynchronous", api.schedule_asynchronous));
  TROCAR_TRY_STATUS(library.find("hdUnschedule", api.unschedule));
  return api;
}

}  // namespace trocar::devices::hd
