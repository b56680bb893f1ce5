// A stand-in for libHD.so: a scheduler thread, frames, and a mass that the force moves. It keeps OpenHaptics' calling
// rules as its headers and examples show them, and notes each one that is broken.
#include "devices/test/standin/hd_simulated_device.h"

namespace {

trocar::testing::HdSimulatedDevice& device() {
  static trocar::testing::HdSimulatedDevice the_device;
  return the_device;
}

}  // namespace

namespace hd = trocar::hd;

extern "C" {
trocar::testing::HdStandIn* trocar_hd_stand_in() {
  return &device();
}
hd::Handle hdInitDevice(const char* name) {
  return device().init(name);
}
void hdDisableDevice(hd::Handle handle) {
  device().disable_device(handle);
}
void hdMakeCurrentDevice(hd::Handle) {
  device().require_open("hdMakeCurrentDevice without an open device");
}
void hdBeginFrame(hd::Handle handle) {
  device().begin(handle);
}
void hdEndFrame(hd::Handle handle) {
  device().end(handle);
}
hd::ErrorInfo hdGetError() {
  return device().pop_error();
}
const char* hdGetErrorString(hd::Enum code) {
  return code == hd::kCommError ? "Communication error" : "Some error";
}
void hdEnable(hd::Enum capability) {
  device().enable(capability, true);
}
void hdDisable(hd::Enum capability) {
  device().enable(capability, false);
}
void hdGetIntegerv(hd::Enum name, int* values) {
  device().get_integers(name, values);
}
void hdGetDoublev(hd::Enum name, double* values) {
  device().get_doubles(name, values);
}
void hdSetDoublev(hd::Enum name, const double* values) {
  device().set_doubles(name, values);
}
const char* hdGetString(hd::Enum name) {
  return device().get_string(name);
}
hd::Enum hdCheckCalibration() {
  return device().check_calibration();
}
void hdUpdateCalibration(hd::Enum style) {
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
void hdScheduleSynchronous(hd::Callback callback, void* user, unsigned short priority) {
  device().schedule(callback, user, priority, true);
}
hd::SchedulerHandle hdScheduleAsynchronous(hd::Callback callback, void* user, unsigned short priority) {
  return device().schedule(callback, user, priority, false);
}
void hdUnschedule(hd::SchedulerHandle handle) {
  device().unschedule(handle);
}
}
