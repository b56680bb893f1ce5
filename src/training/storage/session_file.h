#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "tasks/active_time.h"
#include "tasks/score.h"
#include "telemetry/tick_sample.h"

namespace trocar::storage {

inline constexpr int kSessionFormatVersion = 1;  ///< A file of a newer version is refused.

/// Everything about an attempt but its ticks: enough to repeat it.
struct SessionInfo {
  std::string program_version;
  std::string started_utc;  ///< ISO 8601.
  std::string task;
  std::string task_toml;  ///< Of a task from a file, its text; empty: a task of the data folder, or an older program.
  std::string patient_name;
  std::string patient_source;  ///< As given on the command line: a folder, or an embedded patient's name.
  std::string patient_hash;
  std::uint64_t patient_seed = 1;  ///< Of an embedded patient.
  std::string operator_name;       ///< "expert", "constant-velocity:10" …
  std::string force_model = "insertion";
  std::uint64_t seed = 1;
  double rate_hz = 1000.0;
  std::string level;  ///< Of help in the trainer: "guided", "assisted", "exam"; empty: no window, or an older program.
  std::string needle;
  std::string device;             ///< In words.
  std::string device_preset;      ///< Of data/devices.toml; empty: an older program.
  std::string tissue_table_toml;  ///< As in force at the first tick.
  anatomy::NeedlePath plan_P;
  bool is_parenchymal = false;
  /// Names behind the ids in the samples, by id.
  std::vector<std::string> tissue_names;
  std::vector<std::string> layer_names;
  std::vector<std::string> label_names;  ///< 256 entries.
};

/// Pose of the virtual transducer at a time. Frame P.
struct TransducerSample {
  double time_s = 0.0;     ///< As the ticks' time.
  Pose X_PT;               ///< As felt: it does not pass through the skin.
  double contact_n = 0.0;  ///< Of skin and face.
};

/// Parameters in force from a tick on.
struct SessionParameters {
  std::size_t tick = 0;  ///< Index of the first sample that was made with them.
  double time_s = 0.0;   ///< Of that sample.
  /// What differs from the parameters before; of the first ones, what a user had set in the tissue table: "skin.fp=6".
  std::vector<std::string> settings;
  std::vector<std::string> options;  ///< Force model, coupling …: all of them; see haptics/scene_options.h.
  std::string tissue_table_toml;     ///< The whole table.
};

/// Writes a session as it happens: one SQLite file in WAL mode. Killed at any moment it loses at most the last half
/// second of ticks and opens again: ticks are buffered and committed every 0.5 s of session time, and after as many as
/// 0.5 s hold at the session's rate. After the first failure it writes no more and returns that failure again.
/// Not real-time safe; one thread. Without finish() what is buffered is written and the session stays incomplete, in
/// one file. Every commit has a checksum of its ticks and events, the other tables have one each.
class SessionWriter {
 public:
  /// An existing file is refused (exit status 2). A file that could not be set up is removed again.
  static Result<SessionWriter> create(const std::filesystem::path& path, const SessionInfo& info);
  SessionWriter(SessionWriter&&) noexcept;
  SessionWriter& operator=(SessionWriter&&) noexcept;
  ~SessionWriter();

  Status append(const telemetry::TickSample& sample);
  /// In the order of time. One that is not later than the last one, or not finite, is left out.
  Status append(const TransducerSample& sample);
  /// Of a sample that was appended already, in the order of ticks, one a tick.
  Status append(const SessionParameters& parameters);
  /// In the order of time.
  Status append(const tasks::Interruption& interruption);
  /// Writes what is buffered, then the outcome, and makes it a single file again. `fired` is a sample's index. Nothing
  /// can be appended afterwards.
  Status finish(const tasks::Outcome& outcome, std::optional<std::size_t> fired);
  std::size_t saved_ticks() const noexcept;  ///< Committed so far.
  /// Hash of all ticks, see Session; empty before finish().
  const std::string& ticks_hash() const noexcept;

 private:
  struct Impl;
  explicit SessionWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// A part of a session that cannot be read or does not fit its checksum, and is left out.
struct SessionDamage {
  std::string part;            ///< In words: "ticks 500 to 999".
  std::size_t first_tick = 0;  ///< Of damaged ticks.
  std::size_t ticks = 0;       ///< 0: another part than ticks.
  std::size_t sample = 0;      ///< Of damaged ticks: index in `samples` of the first one behind them.
};

struct Session {
  SessionInfo info;
  std::vector<telemetry::TickSample> samples;
  std::vector<TransducerSample> transducer;        ///< By time; empty: there was none, or an older program recorded it.
  std::vector<SessionParameters> parameters;       ///< By tick; empty: an older program wrote the session.
  std::vector<tasks::Interruption> interruptions;  ///< By time.
  std::optional<tasks::Outcome> outcome;           ///< Missing when the program was killed before the end.
  std::optional<std::size_t> fired;                ///< Sample at which the biopsy gun was fired.
  bool is_incomplete = false;                      ///< The program ended before the attempt did.
  /// XXH3 (128 bits, hexadecimal) of all values of all ticks: two sessions have the same if and only if their ticks are
  /// the same bit by bit (NaN is one value, -0.0 is 0.0). Empty: incomplete, or of an older program.
  std::string ticks_hash;
  bool has_checksums = false;         ///< Missing in sessions of older programs: damage may pass unnoticed.
  std::vector<SessionDamage> damage;  ///< In the order of ticks; empty in what load_session gives.
};
/// Reads a finished or a killed session (its -wal file beside it). NaN comes back as NaN, -0.0 as 0.0; other values bit
/// by bit. Errors, one line each: no such file, a folder, empty, not a session, damaged, of a newer version, a killed
/// session where nothing can be written. A hostile file costs bounded time and memory.
Result<Session> load_session(const std::filesystem::path& path);
/// Reads the undamaged part of a damaged session, with a list of the damage. Error if nothing is readable.
Result<Session> salvage_session(const std::filesystem::path& path);
/// "the session is damaged: ticks 500 to 999".
Error damage_error(const Session& session, const std::filesystem::path& path, const std::string& advice);

/// The files that a session consists of while it is written: itself and SQLite's companions.
std::vector<std::filesystem::path> session_files(const std::filesystem::path& path);
/// Renames an incomplete session that an interrupted program left at `path` (first.session ->
/// first.incomplete.session), so that a new one can be made there; gives its new name. Nothing where there is no such
/// session. Errors: another program is still writing it, or it cannot be renamed.
Result<std::optional<std::filesystem::path>> set_aside_incomplete_session(const std::filesystem::path& path);

/// An event in words, "puncture:skin"; empty for kNone. An id without a name is "#id".
std::string event_text(const SessionInfo& info, const telemetry::TickEvent& event);
/// The events of a sample in words: "puncture:skin;enter:liver".
std::string event_text(const SessionInfo& info, const telemetry::TickSample& sample);
/// What the CSV says of them: "set:skin.fp=6;set:liver.k=0.5", "interruption:39.000" (seconds). Empty: nothing.
std::string event_text(const SessionParameters& parameters);
std::string event_text(const tasks::Interruption& interruption);
/// One row a tick under a header, comma separated; numbers in the shortest form that reads back to the same value, nan
/// and inf as words. Columns: docs and `trocar session export --help`. Written whole or not at all. Of an incomplete
/// session the last row has the event "incomplete"; behind a gap of damaged ticks the next row (or the last one) has
/// the event "damaged:FIRST-LAST".
Status export_csv(const Session& session, const std::filesystem::path& path);

}  // namespace trocar::storage
