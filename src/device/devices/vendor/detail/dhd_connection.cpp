#include "devices/vendor/detail/dhd_connection.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "core/log.h"
#include "core/start_thread.h"
#include "devices/detail/units.h"

namespace trocar::devices::dhd {
namespace {

constexpr double kNmmPerNm = 1000.0;
constexpr double kWatchdog_s = 0.020;  // if the vendor's is off: as ours, ServoExchange::kOldestWrench_s
constexpr int kFailuresToLose = 5;     // consecutive failed calls [assumed]
constexpr int kPeriodsPerStatus = 50;  // 25 ms at 2 kHz: interval of reading the motors' state [assumed]

}  // namespace

Mat3 R_DV() noexcept {
  Mat3 R;
  R << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  return R;
}

Mat3 R_HS() noexcept {
  Mat3 R;
  R << 0, 0, -1, 1, 0, 0, 0, -1, 0;
  return R;
}

Connection::Connection(const Api& api, char id, std::shared_ptr<ServoPace> pace)
    : api_(api), id_(id), pace_(std::move(pace)), type_(api.get_system_type(id)) {
  const char* name = api.get_system_name(id);
  name_ = name != nullptr ? name : "Force Dimension device";
}

Result<std::unique_ptr<Connection>> Connection::open(std::shared_ptr<ServoPace> pace) {
  TROCAR_TRY(const Api api, load_api());
  const int id = api.open();
  if (id < 0) {
    return fail(fmt::format("no Force Dimension device: {}", api.error_text()), "dhdOpen",
                "connect it, switch it on, and allow yourself its USB port (udev rule of the SDK)");
  }
  auto connection = std::unique_ptr<Connection>(new Connection(api, static_cast<char>(id), std::move(pace)));
  TROCAR_TRY_STATUS(connection->check_state());
  return connection;
}

tl::unexpected<Error> Connection::failed(const char* what) const {
  return fail(fmt::format("{}: {}", what, api_.error_text()), name_,
              "switch the device off and on, then open it again");
}

Status Connection::check_state() {
  std::array<int, kStatusLength> status{};
  if (api_.get_status(status.data(), id_) < kNoError) return failed("the device does not report its state");
  if (status[kStatusPower] == 0) return fail("the device has no power", name_, "switch it on, then open it again");
  if (status[kStatusReset] != 0) {
    return fail("the device is not calibrated", name_,
                "put its handle into the calibration pit until the light is steady, then open it again");
  }
  return {};
}

/// The vendor's watchdog stops the force without new commands. Its setting is kept; it is switched on if it is off.
Status Connection::keep_watchdog() {
  unsigned char counts = 0;
  const bool is_known = api_.get_watchdog != nullptr && api_.get_watchdog(&counts, id_) >= kNoError;
  if (is_known && counts > 0) return {};
  const bool can_set = api_.set_watchdog != nullptr && api_.enable_expert_mode != nullptr &&
                       api_.disable_expert_mode != nullptr && api_.enable_expert_mode() >= kNoError;
  if (!can_set) {
    log_warning("{}: its library has no watchdog; only Trocar's own timeout stops an outdated force", name_);
    return {};
  }
  const auto wanted = static_cast<unsigned char>(std::lround(kWatchdog_s / kWatchdogCount_s));
  const bool is_set = api_.set_watchdog(wanted, id_) >= kNoError;
  api_.disable_expert_mode();
  if (!is_set) log_warning("{}: cannot switch on its watchdog: {}", name_, api_.error_text());
  return {};
}

Status Connection::start(bool senses_rotation) {
  senses_rotation_ = senses_rotation;
  TROCAR_TRY_STATUS(keep_watchdog());
  if (api_.set_gravity_compensation(kOn, id_) < kNoError) return failed("cannot switch on its gravity compensation");
  if (sense(sample_) == Sensed::kFailed) return failed("cannot read its pose");
  if (api_.enable_force(kOn, id_) < kNoError) return failed("cannot switch on its motors");
  if (!apply(Wrench{})) return failed("it does not accept forces");
  exchange_.emplace(sample_);
  TROCAR_TRY(thread_, start_thread("device", [this] { pace_->run(is_stopping_, *this); }));
  return {};
}

Connection::~Connection() {
  if (exchange_) exchange_->close();
  is_stopping_.store(true);
  pace_->wake();
  if (thread_.joinable()) thread_.join();
  if (exchange_) apply(Wrench{});
  api_.enable_force(kOff, id_);
  api_.close(id_);
}

void Connection::serve(double now_s) noexcept {
  if (sample_.is_lost) return;
  const Sensed sensed = sense(sample_);
  const Wrench wrench_D = exchange_->wanted(now_s);
  // The library converts forces to motor torques with the pose: no force without a finite pose.
  const bool is_applied = apply(sample_.X_DS.is_finite() ? wrench_D : Wrench{});
  failures_ = sensed != Sensed::kFailed && is_applied ? 0 : failures_ + 1;
  if (!is_applied) sample_.is_force_refused = true;
  if (failures_ >= kFailuresToLose) {
    sample_.is_lost = true;
    last_error_.store(api_.error_text(), std::memory_order_relaxed);
  } else if (++periods_ % kPeriodsPerStatus == 0) {
    sample_.is_force_refused = !has_force();
  }
  if (sensed == Sensed::kNew || sample_.is_lost) exchange_->sensed(sample_);
}

/// Reads into the sample, which keeps its pose if the device does not respond.
Connection::Sensed Connection::sense(ServoSample& sample) noexcept {
  Vec3 p_VH = Vec3::Zero();
  double rows[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int answer = api_.get_pose(&p_VH.x(), &p_VH.y(), &p_VH.z(), rows, id_);
  if (answer < kNoError) return Sensed::kFailed;
  Mat3 R_VH;
  R_VH << rows[0][0], rows[0][1], rows[0][2],  //
      rows[1][0], rows[1][1], rows[1][2],      //
      rows[2][0], rows[2][1], rows[2][2];
  const Mat3 R_DS = senses_rotation_ ? Mat3(R_DV() * R_VH * R_HS()) : Mat3(Mat3::Identity());
  sample.X_DS = {R_DS, kMmPerM * (R_DV() * p_VH)};
  sample.buttons = 0;
  if (api_.get_button(0, id_) == kOn) sample.buttons |= kButtonMain;
  if (api_.get_button(1, id_) == kOn) sample.buttons |= kButtonSecond;
  return answer == kTimeGuard ? Sensed::kRepeated : Sensed::kNew;
}

bool Connection::apply(const Wrench& wrench_D) noexcept {
  const Vec3 f = R_DV().transpose() * wrench_D.force_n;
  const Vec3 t = R_DV().transpose() * wrench_D.torque_nmm / kNmmPerNm;
  return api_.set_wrench(f.x(), f.y(), f.z(), t.x(), t.y(), t.z(), 0.0, id_) >= kNoError;
}

/// Returns false if its button, velocity brake or watchdog keeps the motors off. Only the person at the device can
/// switch them on again (force button).
bool Connection::has_force() noexcept {
  std::array<int, kStatusLength> status{};
  return api_.get_status(status.data(), id_) < kNoError || status[kStatusForce] != 0;
}

}  // namespace trocar::devices::dhd
