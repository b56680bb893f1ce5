#include "server/flight_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>

#include "core/files/atomic_file.h"
#include "telemetry/tick_fields.h"

namespace trocar::server {
namespace fs = std::filesystem;
namespace {

/// Calls visit(name, value) for every column of a flight record: the fields of the tick, then those of the device and
/// the gate, in the frame D.
template <class Visitor>
void visit_columns(const ServoRecord& r, Visitor&& visit) {
  const auto visit_vector = [&](std::array<const char*, 3> names, const Vec3& v) {
    for (std::size_t i = 0; i < names.size(); ++i) visit(names[i], v[static_cast<Eigen::Index>(i)]);
  };
  visit("tick", r.tick);
  telemetry::for_each_tick_field(
      [&]<class Value, telemetry::TickUse use>(const telemetry::TickField<Value, use>& field) {
        if constexpr (use.is_in_flight_record) telemetry::for_each_column(r.sample, field, visit);
      });
  visit("device_status", static_cast<int>(r.status));
  visit_vector({"x_mm", "y_mm", "z_mm"}, r.X_DS.p());
  const Eigen::Quaterniond q(r.X_DS.R());
  visit("qw", q.w());
  visit("qx", q.x());
  visit("qy", q.y());
  visit("qz", q.z());
  visit("buttons", r.buttons);
  visit_vector({"wanted_fx_n", "wanted_fy_n", "wanted_fz_n"}, r.wanted_D.force_n);
  visit_vector({"wanted_tx_nmm", "wanted_ty_nmm", "wanted_tz_nmm"}, r.wanted_D.torque_nmm);
  visit_vector({"written_fx_n", "written_fy_n", "written_fz_n"}, r.written_D.force_n);
  visit_vector({"written_tx_nmm", "written_ty_nmm", "written_tz_nmm"}, r.written_D.torque_nmm);
  visit("gate_actions", r.actions);
  visit("silence_s", r.silence_s);
}

std::string csv_header() {
  std::string line;
  visit_columns(ServoRecord(), [&](const char* name, const auto&) { line += fmt::format("{},", name); });
  line.back() = '\n';
  return line;
}

void append_row(std::string& text, const ServoRecord& record) {
  visit_columns(record, [&](const char*, const auto& value) {
    if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(value)>>)
      text += to_string(value);
    else
      fmt::format_to(std::back_inserter(text), "{}", value);
    text += ',';
  });
  text.back() = '\n';
}

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
  std::string text = csv_header();
  telemetry::GateFault fault = telemetry::GateFault::kNone;
  for (const ServoRecord& record : flight) {
    append_row(text, record);
    if (fault == telemetry::GateFault::kNone) fault = record.fault;
  }
  const std::filesystem::path path = folder / fmt::format("flight-{}-{}.csv", utc, to_string(fault));
  TROCAR_TRY_STATUS(write_file_atomically(path, text));
  keep_quota(folder, path);
  return path;
}

}  // namespace trocar::server
