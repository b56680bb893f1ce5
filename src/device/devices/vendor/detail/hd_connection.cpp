#include "devices/vendor/detail/hd_connection.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace trocar::devices::hd {
namespace {

constexpr unsigned long kServoRate_hz = 1000;  // the vendor's usual rate
constexpr int kMostErrors = 32;                // limit of errors read at a time

/// The vendor's library has one scheduler and one current device per process.
std::atomic<bool> is_in_use{false};

bool is_force_error(Enum code) noexcept {
  return code >= kWarmMotors && code <= kForceError;
}

/// Errors at which the vendor's own programs stop, too (hduError, hduIsSchedulerError).
bool is_fatal(Enum code) noexcept {
  return code == kCommError || code == kCommConfigError || code == kTimerError || code == kDeviceFault ||
         code == kBadHandle;
}

std::string words_of(const Api& api, Enum code) {
  const char* words = api.get_error_string(code);
  return fmt::format("{} (0x{:04x})", words != nullptr && *words != '\0' ? words : "error", code);
}

}  // namespace

Mat3 R_DV() noexcept {
  Mat3 R;
  R << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  return R;
}

Mat3 R_HS() noexcept {
  return Vec3(1, -1, -1).asDiagonal();
}

Result<std::unique_ptr<Connection>> Connection::open(const std::string& device, double (*clock_s)() noexcept,
                                                     bool is_calibrating) {
  TROCAR_TRY(const Api api, load_api());
  if (is_in_use.exchange(true)) {
    return fail("OpenHaptics is already in use in this program", device, "use a separate server for each device");
  }
  const Handle handle = api.init_device(device.empty() ? nullptr : device.c_str());
  const ErrorInfo error = api.get_error();
  if (handle == kInvalidHandle || error.code != kSuccess) {
    is_in_use.store(false);
    const std::string name = device.empty() ? "default device" : device;
    return fail(fmt::format("no OpenHaptics device \"{}\": {}", name, words_of(api, error.code)), name,
                "connect it, switch it on, and set it up under this name with the vendor's setup program");
  }
  auto connection = std::unique_ptr<Connection>(new Connection(api, handle, clock_s, is_calibrating));
  TROCAR_TRY_STATUS(connection->start());
  return connection;
}

Status Connection::start() {
  api_.make_current_device(handle_);
  describe();
  api_.set_scheduler_rate(kServoRate_hz);
  api_.start_scheduler();
  TROCAR_TRY_STATUS(check("the vendor's scheduler does not start"));
  has_scheduler_ = true;
  TROCAR_TRY_STATUS(calibrate());
  exchange_.emplace(first_);
  callback_ = api_.schedule_asynchronous(&on_period, this, kHighestPriority);
  TROCAR_TRY_STATUS(check("the vendor's scheduler rejects the callback"));
  has_callback_ = true;
  return {};
}

/// Only if the device can calibrate alone, or a person holds it in the calibration position: an encoder reset is only
/// correct in the reset position of the arm.
Status Connection::calibrate() {
  api_.get_integerv(kCalibrationStyle, &calibration_style_);
  api_.schedule_synchronous(&on_first_period, this, kHighestPriority);
  const bool can_update = (calibration_style_ & (kStyleAuto | kStyleInkwell)) != 0;
  if (is_calibrating_ || (calibration_ == kCalibrationNeedsUpdate && can_update)) {
    api_.schedule_synchronous(&on_calibration_update, this, kHighestPriority);
    api_.schedule_synchronous(&on_first_period, this, kHighestPriority);
  }
  TROCAR_TRY_STATUS(check("the device does not respond"));
  if (calibration_ == kCalibrationOk) return {};
  return fail(
      "the device is not calibrated", description_.model,
      (calibration_style_ & kStyleInkwell) != 0
          ? "put the stylus into its inkwell, then open the device again"
          : "hold its arm in the reset position and calibrate it there (trocar-hapticd --test --calibrate, or Test "
            "on the trainer's start page), or with the vendor's diagnostic program");
}

void Connection::describe() {
  const char* model = api_.get_string(kDeviceModelType);
  description_.model = model != nullptr ? model : "";
  api_.get_integerv(kOutputDof, &description_.output_dof);
  description_.peak_force_n = positive(kNominalMaxForce);
  description_.continuous_force_n = positive(kNominalMaxContinuousForce);
  description_.stiffness_n_per_mm = positive(kNominalMaxStiffness);
  if (description_.output_dof > 3) {
    description_.peak_torque_nmm = positive(kNominalMaxTorque);
    description_.continuous_torque_nmm = positive(kNominalMaxContinuousTorque);
  }
  std::array<double, 6> box{};
  api_.get_doublev(kUsableWorkspace, box.data());
  const Vec3 centre = 0.5 * (Vec3(box[0], box[1], box[2]) + Vec3(box[3], box[4], box[5]));
  if (centre.allFinite()) description_.centre_V = centre;
  // An older driver returns an error for unknown parameters; these values stay unset.
  for (int i = 0; i < kMostErrors && api_.get_error().code != kSuccess; ++i) {
  }
}

std::optional<double> Connection::positive(Enum name) {
  // Some parameters have one value per joint or axis: the first one is used.
  std::array<double, 6> values{};
  api_.get_doublev(name, values.data());
  if (!std::isfinite(values[0]) || values[0] <= 0.0) return std::nullopt;
  return values[0];
}

/// The errors since the last check, with the oldest as the cause.
Status Connection::check(const char* what) {
  Enum first = kSuccess;
  for (int i = 0; i < kMostErrors; ++i) {
    const Enum code = api_.get_error().code;
    if (code == kSuccess) break;
    first = code;
  }
  if (first == kSuccess) return {};
  return fail(fmt::format("{}: {}", what, words_of(api_, first)), description_.model,
              "check the device with the vendor's diagnostic program");
}

Connection::~Connection() {
  if (exchange_) exchange_->close();
  const bool answers = !is_lost_.load() && !(exchange_ && exchange_->is_lost());
  if (has_callback_ && answers) {
    // One complete callback period is in between: it has sent zero before the motors are switched off.
    api_.schedule_synchronous([](void*) { return kCallbackDone; }, nullptr, kLowestPriority);
    api_.schedule_synchronous(&on_closing, this, kLowestPriority);
  }
  if (has_scheduler_) api_.stop_scheduler();
  if (has_callback_) api_.unschedule(callback_);
  api_.disable_device(handle_);
  is_in_use.store(false);
}

std::string Connection::last_error() const {
  const Enum code = last_error_.load();
  return code == kSuccess ? std::string() : words_of(api_, code);
}

unsigned int Connection::on_period(void* connection) {
  auto& self = *static_cast<Connection*>(connection);
  if (self.is_done_ || self.is_lost_.load(std::memory_order_relaxed)) return kCallbackDone;
  self.serve();
  return self.is_lost_.load(std::memory_order_relaxed) ? kCallbackDone : kCallbackContinue;
}

/// Checks the calibration and, if it is valid, switches the motors on with zero force.
unsigned int Connection::on_first_period(void* connection) {
  auto& self = *static_cast<Connection*>(connection);
  self.api_.begin_frame(self.handle_);
  self.calibration_ = self.api_.check_calibration();
  self.first_ = self.sense();
  if (self.calibration_ == kCalibrationOk) {
    self.api_.enable(kForceOutput);
    self.apply(Wrench{});
  }
  self.api_.end_frame(self.handle_);
  return kCallbackDone;
}

unsigned int Connection::on_calibration_update(void* connection) {
  auto& self = *static_cast<Connection*>(connection);
  for (const int style : {kStyleAuto, kStyleInkwell, kStyleEncoderReset}) {
    if ((self.calibration_style_ & style) == 0) continue;
    self.api_.update_calibration(static_cast<Enum>(style));
    break;
  }
  return kCallbackDone;
}

/// After the callback of its period, whose frame set the motors to zero: no second frame in this period, and none until
/// the scheduler stops.
unsigned int Connection::on_closing(void* connection) {
  auto& self = *static_cast<Connection*>(connection);
  self.is_done_ = true;
  self.api_.disable(kForceOutput);
  return kCallbackDone;
}

/// One frame: everything between hdBeginFrame and hdEndFrame, on the scheduler's thread.
void Connection::serve() noexcept {
  api_.begin_frame(handle_);
  ServoSample sample = sense();
  const Wrench wrench_D = exchange_->wanted(clock_s_());
  // The driver converts forces to motor torques with the pose: no force without a finite pose.
  apply(sample.X_DS.is_finite() ? wrench_D : Wrench{});
  api_.end_frame(handle_);
  take_errors(sample);
  exchange_->sensed(sample);
}

ServoSample Connection::sense() noexcept {
  std::array<double, 16> columns{};
  int buttons = 0;
  api_.get_doublev(kCurrentTransform, columns.data());
  api_.get_integerv(kCurrentButtons, &buttons);
  Mat3 R_VH;
  R_VH << columns[0], columns[4], columns[8],  //
      columns[1], columns[5], columns[9],      //
      columns[2], columns[6], columns[10];
  const Vec3 p_VH(columns[12], columns[13], columns[14]);
  ServoSample sample;
  sample.X_DS = {R_DV() * R_VH * R_HS(), R_DV() * (p_VH - description_.centre_V)};
  if ((buttons & kButton1) != 0) sample.buttons |= kButtonMain;
  if ((buttons & kButton2) != 0) sample.buttons |= kButtonSecond;
  return sample;
}

void Connection::apply(const Wrench& wrench_D) noexcept {
  const Vec3 force_V = R_DV().transpose() * wrench_D.force_n;
  api_.set_doublev(kCurrentForce, force_V.data());
  if (description_.output_dof <= 3) return;
  const Vec3 torque_V = R_DV().transpose() * wrench_D.torque_nmm;
  api_.set_doublev(kCurrentTorque, torque_V.data());
}

void Connection::take_errors(ServoSample& sample) noexcept {
  for (int i = 0; i < kMostErrors; ++i) {
    const Enum code = api_.get_error().code;
    if (code == kSuccess) return;
    last_error_.store(code, std::memory_order_relaxed);
    if (is_force_error(code)) sample.is_force_refused = true;
    if (is_fatal(code)) {
      sample.is_lost = true;
      is_lost_.store(true, std::memory_order_relaxed);
    }
  }
}

}  // namespace trocar::devices::hd
