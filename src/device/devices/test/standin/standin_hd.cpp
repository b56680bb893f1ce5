// A stand-in for libHD.so: a scheduler thread, frames, and a mass that the force moves. It keeps OpenHaptics' calling
// rules as its headers and examples show them, and notes each one that is broken.
#include "devices/test/standin/hd_simulated_device.h"

namespace {

trocar::testing::HdSimulatedDevice& device() {
  static trocar::testing::HdSimulatedDevice the_device;
  return the_device;
}

}  // namespace

namespace hd = trocar::devices::hd;

extern "C" {
trocar::testing::HdStandIn* trocar_hd_stand_in() {
  return &device();
}
trocar::devices::hd::Handle hdInitDevice(const char* name) {
  return device().init(name);
}
void hdDisableDevice(trocar::devices::hd::Handle handle) {
  device().disable_device(handle);
}
void hdMakeCurrentDevice(trocar::devices::hd::Handle) {
  device().require_open("hdMakeCurrentDevice without an open device");
}
void hdBeginFrame(trocar::devices::hd::Handle handle) {
  device().begin(handle);
}
void hdEndFrame(trocar::devices::hd::Handle handle) {
  device().end(handle);
}
trocar::devices::hd::ErrorInfo hdGetError() {
  return device().pop_error();
}
const char* hdGetErrorString(trocar::devices::hd::Enum code) {
  return code == trocar::devices::hd::kCommError ? "Communication error" : "Some error";
}
void hdEnable(trocar::devices::hd::Enum capability) {
  device().enable(capability, true);
}
void hdDisable(trocar::devices::hd::Enum capability) {
  device().enable(capability, false);
}
void hdGetIntegerv(trocar::devices::hd::Enum name, int* values) {
  device().get_integers(name, values);
}
void hdGetDoublev(trocar::devices::hd::Enum name, double* values) {
  device().get_doubles(name, values);
}
void hdSetDoublev(trocar::devices::hd::Enum name, const double* values) {
  device().set_doubles(name, values);
}
const char* hdGetString(trocar::devices::hd::Enum name) {
  return device().get_string(name);
}
trocar::devices::hd::Enum hdCheckCalibration() {
  return device().check_calibration();
}
void hdUpdateCalibration(trocar::devices::hd::Enum style) {
  device().update_calibration(style);
}
void hdStartScheduler() {
  device().start();
}
void hdStopScheduler() {
  device().stop();
}
void hdSetSchedulerRate(unsigned long hz) {
  device().set_rate(hz);
}
void hdScheduleSynchronous(trocar::devices::hd::Callback callback, void* user, unsigned short priority) {
  device().schedule(callback, user, priority, true);
}
trocar::devices::hd::SchedulerHandle hdScheduleAsynchronous(trocar::devices::hd::Callback callback, void* user,
                                                            unsigned short priority) {
  return device().schedule(callback, user, priority, false);
}
void hdUnschedule(trocar::devices::hd::SchedulerHandle handle) {
  device().unschedule(handle);
}
}
