#include "server/flight_recorder.h"

#include <fcntl.h>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <iterator>
#include <utility>

#include "core/files/file_system.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
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

/// "flight-20260101T000000.123Z-runaway.csv"; former versions wrote no milliseconds.
bool is_flight_name(std::string_view name) {
  constexpr std::string_view kPrefix = "flight-", kSuffix = ".csv";
  constexpr std::array<std::string_view, 2> kTimes{"00000000T000000.000Z-", "00000000T000000Z-"};
  if (!name.starts_with(kPrefix) || !name.ends_with(kSuffix)) return false;
  return std::any_of(kTimes.begin(), kTimes.end(), [&](std::string_view time) {
    if (name.size() <= kPrefix.size() + time.size() + kSuffix.size()) return false;
    return std::equal(time.begin(), time.end(), name.begin() + kPrefix.size(),
                      [](char pattern, char c) { return pattern == '0' ? c >= '0' && c <= '9' : c == pattern; });
  });
}

/// Creates an empty file with a name that does not exist: `stem`.csv, `stem`-2.csv and so on.
Result<fs::path> reserve_name(const fs::path& folder, const std::string& stem) {
  constexpr int kMostOfAName = 1000;
  for (int number = 1; number <= kMostOfAName; ++number) {
    const fs::path path = folder / (number == 1 ? stem + ".csv" : fmt::format("{}-{}.csv", stem, number));
    const int file = ::open(path.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
    if (file >= 0) {
      ::close(file);
      return path;
    }
    if (errno != EEXIST) return fail(std::strerror(errno), path.string(), "see --flight-records");
  }
  return fail("there are too many flight records of one moment", folder.string(), "remove some");
}

struct FlightFile {
  fs::path path;
  std::uintmax_t bytes = 0;
};

/// The flight records of a folder, oldest first.
std::vector<FlightFile> find_flights(const fs::path& folder) {
  std::vector<FlightFile> flights;
  const auto files = list_folder(folder);
  if (!files) return flights;
  for (const fs::path& file : *files) {
    std::error_code gone;
    const bool is_file = fs::symlink_status(file, gone).type() == fs::file_type::regular;
    if (gone || !is_file || !is_flight_name(file.filename().string())) continue;
    const std::uintmax_t bytes = fs::file_size(file, gone);
    if (!gone) flights.push_back({file, bytes});
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
  const bool is_new_fault =
      record.sample.gate_fault != telemetry::GateFault::kNone && fault_ == telemetry::GateFault::kNone;
  fault_ = record.sample.gate_fault;
  if (is_new_fault && wanted_ == 0) {
    wanted_ = after_;
    return std::nullopt;
  }
  if (wanted_ == 0 || --wanted_ > 0) return std::nullopt;
  return std::vector<ServoRecord>(records_.begin(), records_.end());
}

std::optional<std::vector<ServoRecord>> FlightRecorder::finish() {
  if (std::exchange(wanted_, 0) == 0) return std::nullopt;
  return std::vector<ServoRecord>(records_.begin(), records_.end());
}

Status check_flight_folder(const fs::path& folder) {
  constexpr const char* kAdvice = "free or repair it, or name another folder with --flight-records";
  if (Status made = make_writable_folder(folder); !made) {
    made.error().advice = kAdvice;
    return made;
  }
  constexpr std::uintmax_t kOneRecord_bytes = 4U << 20;  // see FlightQuota
  const std::optional<std::uintmax_t> free_bytes = find_free_bytes(folder);
  if (free_bytes && *free_bytes < kOneRecord_bytes)
    return fail(fmt::format("only {} kB are free, a flight record needs up to {} kB", *free_bytes / 1024,
                            kOneRecord_bytes / 1024),
                folder.string(), kAdvice);
  return {};
}

std::string flight_time(std::chrono::system_clock::time_point time) {
  const auto ms = std::chrono::duration_cast<std::chrono::milliseconds>(time.time_since_epoch()).count();
  constexpr std::int64_t kMsPerS = 1000;
  return fmt::format("{:%Y%m%dT%H%M%S}.{:03}Z", fmt::gmtime(static_cast<std::time_t>(ms / kMsPerS)), ms % kMsPerS);
}

Result<std::filesystem::path> write_flight(const std::filesystem::path& folder, const std::string& utc,
                                           const std::vector<ServoRecord>& flight) {
  std::string text = csv_header();
  telemetry::GateFault fault = telemetry::GateFault::kNone;
  for (const ServoRecord& record : flight) {
    append_row(text, record);
    if (fault == telemetry::GateFault::kNone) fault = record.sample.gate_fault;
  }
  TROCAR_TRY(const fs::path path, reserve_name(folder, fmt::format("flight-{}-{}", utc, to_string(fault))));
  if (Status written = write_file_atomically(path, text); !written) {
    std::error_code error;
    fs::remove(path, error);  // the reserved name
    return tl::unexpected(std::move(written.error()));
  }
  keep_quota(folder, path);
  return path;
}

}  // namespace trocar::server
