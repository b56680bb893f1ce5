#include "devices/simulated/replay_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "config/csv.h"
#include "core/files/input_file.h"
#include "core/files/output_file.h"
#include "core/result.h"
#include "core/text.h"
#include "devices/detail/factories.h"
#include "devices/simulated/detail/hand_motion.h"
#include "geometry/pose.h"

namespace trocar::devices {
namespace {

/// Distance from a recorded sample, as share of a period, below which the sample itself is used: a server at the same
/// rate gets identical bits.
constexpr double kSameSample = 1e-6;

Pose between(const Pose& a, const Pose& b, double share) noexcept {
  const Eigen::Quaterniond turned = Eigen::Quaterniond(a.R()).slerp(share, Eigen::Quaterniond(b.R())).normalized();
  return {turned.toRotationMatrix(), a.p() + share * (b.p() - a.p())};
}

}  // namespace

ReplayDevice::ReplayDevice(stylus::DevicePreset preset, std::string name, std::vector<Pose> poses, double rate_hz)
    : preset_(std::move(preset)), name_(std::move(name)), poses_(std::move(poses)), rate_hz_(rate_hz) {
  TROCAR_CHECK(!poses_.empty());
  TROCAR_CHECK(rate_hz_ > 0.0);
}

DeviceReading ReplayDevice::read(double now_s) noexcept {
  if (!std::isfinite(now_s)) now_s = last_s_;
  if (!is_started_) start_s_ = now_s;
  DeviceReading reading;
  if (is_started_ && !(now_s > last_s_)) reading.status = DeviceStatus::kRepeated;
  is_started_ = true;
  last_s_ = std::max(now_s, last_s_);

  const double last = static_cast<double>(poses_.size() - 1);
  const double sample = std::clamp((now_s - start_s_) * rate_hz_, 0.0, last);
  const double nearest = std::round(sample);
  if (std::abs(sample - nearest) < kSameSample) {
    reading.X_DS = poses_[static_cast<std::size_t>(nearest)];
    return reading;
  }
  const auto before = static_cast<std::size_t>(sample);
  reading.X_DS = between(poses_[before], poses_[before + 1], sample - std::floor(sample));
  return reading;
}

bool ReplayDevice::write(const Wrench& wrench_D) noexcept {
  return is_valid(wrench_D);
}

OpenedDevice open_replay(const DeviceSpec& spec, const DeviceOptions& options) {
  constexpr double kMaxRate_hz = 10000.0;
  if (options.motion.poses.empty()) {
    return fail("there are no poses to replay", spec.argument, "name a session with at least one sample");
  }
  for (std::size_t i = 0; i < options.motion.poses.size(); ++i) {
    if (options.motion.poses[i].is_finite()) continue;
    return fail("a recorded pose is not finite", spec.argument + ", sample " + std::to_string(i), "record it again");
  }
  if (!(options.motion.rate_hz > 0.0 && options.motion.rate_hz <= kMaxRate_hz)) {
    return fail("the rate of the recorded poses is not in 0..10000 Hz", spec.argument, "record it again");
  }
  TROCAR_TRY(stylus::DevicePreset preset, load_preset_of(options, "premium"));
  return std::make_unique<ReplayDevice>(std::move(preset), spec.argument, options.motion.poses, options.motion.rate_hz);
}

namespace {
namespace fs = std::filesystem;

constexpr std::array<std::string_view, 8> kColumns{"time_s", "x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz"};
constexpr const char* kRecordMotion = "write the file with trocar session motion";
constexpr double kMostUneven = 0.01;  ///< Share of a step.
constexpr double kRateUnit_hz = 1e-6;

using Row = std::array<double, 8>;

/// Eight numbers. Error: the column and what is wrong with it.
tl::expected<Row, std::string> parse_row(const config::CsvRow& text) {
  Row row;
  if (text.fields.size() != row.size())
    return tl::unexpected(fmt::format("{} fields, not {}: commas separate them, numbers have a decimal point",
                                      text.fields.size(), row.size()));
  for (std::size_t n = 0; n < row.size(); ++n) {
    const auto number = parse_number<double>(text.fields[n]);
    if (!number)
      return tl::unexpected(
          fmt::format("column {}: '{}' is not a finite number", kColumns[n], text.fields[n].substr(0, 40)));
    row[n] = *number;
  }
  return row;
}

std::optional<Pose> pose_of(const Row& row) {
  const Eigen::Quaterniond q = from_wxyz({row[4], row[5], row[6], row[7]});
  const double length = q.norm();
  if (!(std::abs(length - 1.0) < 1e-3)) return std::nullopt;
  return Pose(q.normalized().toRotationMatrix(), Vec3(row[1], row[2], row[3]));
}

}  // namespace

Result<RecordedMotion> read_motion(const fs::path& path) {
  TROCAR_TRY(const std::string bytes, read_input(path, FileKind::kOther));
  config::CsvReader rows(bytes, path.string());
  config::CsvRow text;
  TROCAR_TRY(const bool has_header, rows.next(text));
  if (!has_header || !std::ranges::equal(text.fields, kColumns))
    return fail(fmt::format("not a recorded motion: line 1 is not {}", fmt::join(kColumns, ",")), path.string(),
                kRecordMotion);
  const auto damaged = [&](const std::string& what) {
    return fail(fmt::format("line {}: {}", text.line, what), path.string(), kRecordMotion);
  };
  RecordedMotion motion;
  double first_s = 0.0, last_s = 0.0, step_s = 0.0;
  while (true) {
    TROCAR_TRY(const bool has_row, rows.next(text));
    if (!has_row) break;
    const auto row = parse_row(text);
    if (!row) return damaged(row.error());
    const auto pose = pose_of(*row);
    if (!pose) return damaged("column qw: the quaternion's length is not 1");
    const double time_s = row->front();
    if (motion.poses.empty()) first_s = time_s;
    if (motion.poses.size() == 1) step_s = time_s - first_s;
    if (!motion.poses.empty() && !(step_s > 0.0 && std::abs(time_s - last_s - step_s) <= kMostUneven * step_s))
      return damaged("column time_s: the steps in time are not equal");
    last_s = time_s;
    motion.poses.push_back(*pose);
  }
  if (motion.poses.size() < 2) return fail("fewer than two poses", path.string(), kRecordMotion);
  const double rate_hz = static_cast<double>(motion.poses.size() - 1) / (last_s - first_s);
  motion.rate_hz = std::round(rate_hz / kRateUnit_hz) * kRateUnit_hz;
  return motion;
}

Status write_motion(const RecordedMotion& motion, const fs::path& path) {
  std::string text = fmt::format("{}\n", fmt::join(kColumns, ","));
  for (std::size_t n = 0; n < motion.poses.size(); ++n) {
    const Vec3& p = motion.poses[n].p();
    const Eigen::Quaterniond q(motion.poses[n].R());
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{}\n", static_cast<double>(n) / motion.rate_hz,
                   p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
  }
  return write_file_atomically(path, text);
}

}  // namespace trocar::devices
