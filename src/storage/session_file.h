#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/result.h"
#include "training/score.h"

namespace trocar {

/// Everything about an attempt but its ticks: enough to repeat it.
struct SessionInfo {
  std::string program_version;
  std::string started_utc;  ///< ISO 8601.
  std::string task;
  std::string patient_name;
  std::string patient_source;  ///< As given on the command line: a folder, or an embedded patient's name.
  std::string patient_hash;
  std::uint64_t patient_seed = 1;  ///< Of an embedded patient.
  std::string operator_name;       ///< "expert", "constant-velocity:10" …
  std::string force_model = "insertion";
  std::uint64_t seed = 1;
  double rate_hz = 1000.0;
  std::string needle;
  std::string device;
  std::string tissue_table_toml;
  NeedlePath plan_P;
  bool is_parenchymal = false;
  /// Names behind the ids in the samples, by id.
  std::vector<std::string> tissue_names;
  std::vector<std::string> layer_names;
  std::vector<std::string> label_names;  ///< 256 entries.
};

/// Writes a session as it happens: one SQLite file in WAL mode. Killed at any moment it loses at most the last second
/// of samples and opens again. Ticks are buffered and committed at least every 500 ms of session time.
class SessionWriter {
 public:
  /// An existing file is refused (exit status 2).
  static Result<SessionWriter> create(const std::filesystem::path& path, const SessionInfo& info);
  SessionWriter(SessionWriter&&) noexcept;
  SessionWriter& operator=(SessionWriter&&) noexcept;
  ~SessionWriter();

  Status append(const TickSample& sample);
  /// Writes what is buffered, then the outcome, and makes it a single file again.
  Status finish(const Outcome& outcome, std::optional<std::size_t> fired);

 private:
  struct Impl;
  explicit SessionWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

struct Session {
  SessionInfo info;
  std::vector<TickSample> samples;
  std::optional<Outcome> outcome;    ///< Missing when the program was killed before the end.
  std::optional<std::size_t> fired;  ///< Sample at which the biopsy gun was fired.
};
Result<Session> load_session(const std::filesystem::path& path);

/// The events of a sample in words: "puncture:skin;enter:liver".
std::string event_text(const SessionInfo& info, const TickSample& sample);
/// One row a tick, the columns of the contract in their order.
Status export_csv(const Session& session, const std::filesystem::path& path);

}  // namespace trocar
