#include "server/flight_recorder.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/files/atomic_file.h"

namespace trocar::server {
namespace fs = std::filesystem;
namespace {

std::string csv_row(const ServoRecord& r) {
  const auto vec = [](const Vec3& v) { return fmt::format("{},{},{}", v.x(), v.y(), v.z()); };
  const Eigen::Quaterniond q(r.X_DS.R());
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", r.tick, r.sample.time_s,
                     static_cast<int>(r.status), vec(r.X_DS.p()), q.w(), q.x(), q.y(), q.z(), r.buttons,
                     vec(r.wanted_D.force_n), vec(r.wanted_D.torque_nmm), vec(r.written_D.force_n),
                     vec(r.written_D.torque_nmm), to_string(r.mode), to_string(r.fault), r.actions, r.scale,
                     r.silence_s, vec(r.sample.tip_mm));
}

constexpr std::string_view kHeader =
    "tick,time_s,device_status,x_mm,y_mm,z_mm,qw,qx,qy,qz,buttons,wanted_fx_n,wanted_fy_n,wanted_fz_n,wanted_tx_nmm,"
    "wanted_ty_nmm,wanted_tz_nmm,written_fx_n,written_fy_n,written_fz_n,written_tx_nmm,written_ty_nmm,written_tz_nmm,"
    "gate_mode,fault,gate_actions,gate_scale,silence_s,tip_x_mm,tip_y_mm,tip_z_mm\n";

/// "flight-20260101T000000Z-runaway.csv"
bool is_flight_name(const std::string& name) {
  constexpr std::string_view kPrefix = "flight-", kSuffix = ".csv", kTime = "00000000T000000Z-";
  if (!name.starts_with(kPrefix) || !name.ends_with(kSuffix)) return false;
  if (name.size() <= kPrefix.size() + kTime.size() + kSuffix.size()) return false;
  return std::equal(kTime.begin(), kTime.end(), name.begin() + kPrefix.size(),
                    [](char pattern, char c) { return pattern == '0' ? c >= '0' && c <= '9' : c == pattern; });
}

struct FlightFile {
  fs::path path;
  std::uintmax_t bytes = 0;
};

/// The flight records of a folder, oldest first.
std::vector<FlightFile> find_flights(const fs::path& folder) {
  std::vector<FlightFile> flights;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    std::error_code gone;
    const bool is_file = it->symlink_status(gone).type() == fs::file_type::regular;
    if (gone || !is_file || !is_flight_name(it->path().filename().string())) continue;
    const std::uintmax_t bytes = it->file_size(gone);
    if (!gone) flights.push_back({it->path(), bytes});
  }
  std::sort(flights.begin(), flights.end(), [](const FlightFile& a, const FlightFile& b) { return a.path < b.path; });
  return flights;
}

}  // namespace

std::size_t keep_quota(const fs::path& folder, const fs::path& newest, const FlightQuota& quota) {
  const std::vector<FlightFile> flights = find_flights(folder);
  std::uintmax_t bytes = 0;
  for (const FlightFile& flight : flights) bytes += flight.bytes;
  std::size_t count = flights.size(), removed = 0;
  for (const FlightFile& flight : flights) {
    if (count <= quota.files && bytes <= quota.bytes) break;
    std::error_code error;
    if (flight.path == newest || !fs::remove(flight.path, error)) continue;
    --count;
    ++removed;
    bytes -= flight.bytes;
  }
  return removed;
}

FlightRecorder::FlightRecorder(double rate_hz)
    : before_(static_cast<std::size_t>(kBefore_s * rate_hz)), after_(static_cast<std::size_t>(kAfter_s * rate_hz)) {}

std::optional<std::vector<ServoRecord>> FlightRecorder::add(const ServoRecord& record) {
  records_.push_back(record);
  if (records_.size() > before_ + after_) records_.pop_front();
  const bool is_new_fault = record.fault != telemetry::GateFault::kNone && fault_ == telemetry::GateFault::kNone;
  fault_ = record.fault;
  if (is_new_fault && wanted_ == 0) {
    wanted_ = after_;
    return std::nullopt;
  }
  if (wanted_ == 0 || --wanted_ > 0) return std::nullopt;
  return std::vector<ServoRecord>(records_.begin(), records_.end());
}

Result<std::filesystem::path> write_flight(const std::filesystem::path& folder, const std::string& utc,
                                           const std::vector<ServoRecord>& flight) {
  std::string text(kHeader);
  telemetry::GateFault fault = telemetry::GateFault::kNone;
  for (const ServoRecord& record : flight) {
    text += csv_row(record);
    if (fault == telemetry::GateFault::kNone) fault = record.fault;
  }
  const std::filesystem::path path = folder / fmt::format("flight-{}-{}.csv", utc, to_string(fault));
  TROCAR_TRY_STATUS(write_file_atomically(path, text));
  keep_quota(folder, path);
  return path;
}

}  // namespace trocar::server
