#include "attempt/record/journal.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "config/json.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"

namespace trocar::attempt {
namespace fs = std::filesystem;
namespace {

constexpr int kVersion = 1;

config::Json to_json(const JournalEntry& state) {
  const cases::CaseOptions& options = state.choice.options;
  return {{"version", kVersion},
          {"session", state.session.string()},
          {"patient", state.choice.patient_source},
          {"patient_seed", state.choice.patient_seed},
          {"force_model", state.choice.force_model},
          {"task", options.task},
          {"needle", options.needle},
          {"tissue_file", options.tissue_file},
          {"profile", options.profile},
          {"overrides", options.overrides},
          {"seed", options.seed}};
}

/// Empty if a field is missing or has another type.
std::optional<JournalEntry> from_json(const config::Json& json) {
  const auto text = [&](const char* key) -> std::optional<std::string> {
    return json.contains(key) && json[key].is_string() ? std::optional(json[key].get<std::string>()) : std::nullopt;
  };
  const auto number = [&](const char* key) -> std::optional<std::uint64_t> {
    return json.contains(key) && json[key].is_number_unsigned() ? std::optional(json[key].get<std::uint64_t>())
                                                                : std::nullopt;
  };
  if (!json.is_object() || !json.contains("version") || json["version"] != kVersion) return std::nullopt;
  const auto session = text("session"), patient = text("patient"), force_model = text("force_model"),
             task = text("task"), needle = text("needle"), tissue_file = text("tissue_file"), profile = text("profile");
  const auto patient_seed = number("patient_seed"), seed = number("seed");
  if (!session || !patient || !force_model || !task || !needle || !tissue_file || !profile || !patient_seed || !seed ||
      !json.contains("overrides") || !json["overrides"].is_array())
    return std::nullopt;
  std::vector<std::string> overrides;
  for (const config::Json& one : json["overrides"]) {
    if (!one.is_string()) return std::nullopt;
    overrides.push_back(one.get<std::string>());
  }
  JournalEntry state;
  state.session = *session;
  state.choice.patient_source = *patient;
  state.choice.patient_seed = *patient_seed;
  state.choice.force_model = *force_model;
  cases::CaseOptions& options = state.choice.options;
  options.task = *task;
  options.needle = *needle;
  options.tissue_file = *tissue_file;
  options.profile = *profile;
  options.overrides = std::move(overrides);
  options.seed = *seed;
  return state;
}

std::optional<JournalEntry> load_state(const fs::path& file) {
  const Result<config::Json> json = config::load_json(file);
  return json ? from_json(*json) : std::nullopt;
}

/// Empty if another trainer holds the lock, or it is not available.
std::optional<FileLock> lock_of(fs::path file) {
  auto lock = FileLock::try_lock(file.replace_extension(".lock"));
  return lock ? *std::move(lock) : std::nullopt;
}

fs::path file_of(const fs::path& folder, const JournalEntry& state) {
  return folder / (state.session.stem().string() + ".json");
}

}  // namespace

Status Journal::begin(const JournalEntry& state) {
  clear();
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error) return fail("cannot make the folder: " + error.message(), folder_.string(), "choose another folder");
  file_ = file_of(folder_, state);
  TROCAR_TRY(lock_, FileLock::try_lock(fs::path(file_).replace_extension(".lock")));
  if (!lock_) return fail("the attempt runs in another trainer", file_.string(), "choose another name");
  return write_file_atomically(file_, config::json_text(to_json(state)));
}

void Journal::clear() noexcept {
  if (!lock_) return;
  std::error_code ignored;
  fs::remove(file_, ignored);
  lock_->remove();
  lock_.reset();
}

std::optional<JournalEntry> Journal::find_cut_off() const {
  std::optional<JournalEntry> newest;
  fs::file_time_type newest_time;
  std::error_code error;
  const auto files = list_folder(folder_);
  if (!files) return newest;
  for (const fs::path& file : *files) {
    if (file.extension() != ".json") continue;
    std::optional<JournalEntry> state = load_state(file);
    if (!state || !fs::is_regular_file(state->session, error) || !lock_of(file)) continue;
    const fs::file_time_type time = fs::last_write_time(file, error);
    if (newest && time < newest_time) continue;
    newest = std::move(state);
    newest_time = time;
  }
  return newest;
}

std::optional<JournalClaim> Journal::claim(const JournalEntry& state) const {
  fs::path file = file_of(folder_, state);
  std::optional<FileLock> lock = lock_of(file);
  std::error_code error;
  if (!lock) return std::nullopt;
  if (!fs::is_regular_file(file, error)) {
    lock->remove();
    return std::nullopt;
  }
  return JournalClaim(state, std::move(file), *std::move(lock));
}

void JournalClaim::forget() && noexcept {
  std::error_code ignored;
  fs::remove(file_, ignored);
  lock_.remove();
}

namespace {

constexpr double kBytesATick = 11e6 / 60.0 / 1000.0;  // measured: 11 MB a minute at 1000 Hz
constexpr double kLeastStart_s = 10.0;
constexpr const char* kAdvice =
    "free some disk space, or start trocar-trainer with --state and a folder on another disk";

std::string duration_words(double seconds) {
  constexpr double kMinute_s = 60.0;
  if (seconds < 2.0 * kMinute_s) return fmt::format("{:.0f} s", seconds);
  return fmt::format("{:.0f} minutes", std::floor(seconds / kMinute_s));
}

}  // namespace

RecordingSpace::RecordingSpace(std::filesystem::path folder, std::optional<std::uintmax_t> free_bytes, double rate_hz)
    : folder_(std::move(folder)), bytes_a_second_(kBytesATick * rate_hz) {
  if (free_bytes) free_bytes_ = static_cast<double>(*free_bytes);
}

bool RecordingSpace::is_full() const noexcept {
  return free_bytes_ && *free_bytes_ < kClosing_bytes;
}

double RecordingSpace::left_s() const noexcept {
  return free_bytes_ ? std::max(0.0, *free_bytes_ - kClosing_bytes) / bytes_a_second_ : HUGE_VAL;
}

Status RecordingSpace::check_start() const {
  const double needed_bytes = kClosing_bytes + kLeastStart_s * bytes_a_second_;
  if (!free_bytes_ || *free_bytes_ >= needed_bytes) return {};
  return fail(fmt::format("the disk is full: {:.1f} MB are free in {}, an attempt needs at least {:.0f} MB",
                          *free_bytes_ / 1e6, folder_.string(), needed_bytes / 1e6),
              {}, kAdvice);
}

std::string RecordingSpace::start_warning() const {
  if (left_s() >= kAmple_s) return {};
  return fmt::format("The disk is almost full: {:.0f} MB are free in {}, enough to record {}.", *free_bytes_ / 1e6,
                     folder_.string(), duration_words(left_s()));
}

std::string RecordingSpace::banner() const {
  if (left_s() >= kScarce_s) return {};
  return fmt::format("The disk is almost full: {} can still be recorded in {}. Then the attempt ends and is scored",
                     duration_words(left_s()), folder_.string());
}

}  // namespace trocar::attempt
