#include "devices/simulated/replay_file.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "core/files/atomic_file.h"
#include "core/files/input_file.h"
#include "core/parse_number.h"
#include "geometry/quaternion.h"

namespace trocar::devices {
namespace {
namespace fs = std::filesystem;

constexpr std::string_view kHeader = "time_s,x_mm,y_mm,z_mm,qw,qx,qy,qz";
constexpr const char* kRecordMotion = "write the file with trocar session motion";
constexpr double kMostUneven = 0.01;  ///< Share of a step.
constexpr double kRateUnit_hz = 1e-6;

using Row = std::array<double, 8>;

std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find('\n'), text.size());
  std::string_view line = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::optional<Row> parse_row(std::string_view line) {
  Row row;
  for (std::size_t column = 0; column < row.size(); ++column) {
    const bool is_last = column + 1 == row.size();
    const std::size_t end = is_last ? line.size() : line.find(',');
    if (end == std::string_view::npos) return std::nullopt;
    const auto number = parse_number<double>(line.substr(0, end));
    if (!number) return std::nullopt;
    row[column] = *number;
    line.remove_prefix(is_last ? end : end + 1);
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
  std::string_view rest = bytes;
  if (take_line(rest) != kHeader) return fail("not a recorded motion", path.string(), kRecordMotion);
  const auto damaged = [&](std::size_t line, const char* what) {
    return fail(fmt::format("line {}: {}", line, what), path.string(), kRecordMotion);
  };
  RecordedMotion motion;
  double first_s = 0.0, last_s = 0.0, step_s = 0.0;
  for (std::size_t line = 2; !rest.empty(); ++line) {
    const auto row = parse_row(take_line(rest));
    if (!row) return damaged(line, "not eight numbers");
    const auto pose = pose_of(*row);
    if (!pose) return damaged(line, "the quaternion's length is not 1");
    const double time_s = row->front();
    if (motion.poses.empty()) first_s = time_s;
    if (motion.poses.size() == 1) step_s = time_s - first_s;
    if (!motion.poses.empty() && !(step_s > 0.0 && std::abs(time_s - last_s - step_s) <= kMostUneven * step_s))
      return damaged(line, "the steps in time are not equal");
    last_s = time_s;
    motion.poses.push_back(*pose);
  }
  if (motion.poses.size() < 2) return fail("fewer than two poses", path.string(), kRecordMotion);
  const double rate_hz = static_cast<double>(motion.poses.size() - 1) / (last_s - first_s);
  motion.rate_hz = std::round(rate_hz / kRateUnit_hz) * kRateUnit_hz;
  return motion;
}

Status write_motion(const RecordedMotion& motion, const fs::path& path) {
  std::string text(kHeader);
  text += '\n';
  for (std::size_t n = 0; n < motion.poses.size(); ++n) {
    const Vec3& p = motion.poses[n].p();
    const Eigen::Quaterniond q(motion.poses[n].R());
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{}\n", static_cast<double>(n) / motion.rate_hz,
                   p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
  }
  return write_file_atomically(path, text);
}

}  // namespace trocar::devices
