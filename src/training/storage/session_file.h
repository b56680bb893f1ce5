#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "geometry/pose.h"
#include "metrics/metric.h"
#include "scoring/score.h"
#include "tasks/action.h"
#include "telemetry/needle_shape.h"
#include "telemetry/tick_sample.h"

namespace trocar::storage {

inline constexpr int kSessionFormatVersion = 1;  ///< A file of a newer version is refused.

/// All data of an attempt except its ticks: enough to repeat it.
struct SessionInfo {
  std::string program_version;
  std::string started_utc;  ///< ISO 8601.
  std::string task;
  std::string task_toml;  ///< Text of a task from a file; empty: a task of the data folder, or an older program.
  std::string patient_name;
  std::string patient_source;  ///< As given on the command line: a folder, or an embedded patient's name.
  std::string patient_hash;
  std::string motion_hash;         ///< Of the patient's motion model; empty: it had none, or an older program.
  std::uint64_t patient_seed = 1;  ///< Seed of an embedded patient.
  std::string operator_name;       ///< "expert", "constant-velocity:10" …
  std::string force_model = "insertion";
  int force_version = 1;  ///< Of the force code, haptics/force_version.h; 1 also if the file has none. Range 1..1e9.
  std::uint64_t seed = 1;
  double rate_hz = 1000.0;
  /// Level of help in the trainer: "guided", "assisted", "exam"; empty: no window, or an older program.
  std::string level;
  std::string attempt_id;  ///< 32 hexadecimal digits, signing::make_id(); empty: an older program.
  std::string person_id;   ///< Key of the trainee in the database of results; empty: nobody was chosen.
  std::string needle;
  std::string device;             ///< Description.
  std::string device_preset;      ///< Name in data/devices.toml; empty: an older program.
  std::string tissue_table_toml;  ///< Table in force at the first tick.
  anatomy::NeedlePath plan_P;
  bool is_parenchymal = false;
  /// Image plane of the transducer, as the attempt began; empty: no transducer, or an older program.
  std::optional<metrics::ImagePlane> plane;
  /// Names of the ids in the samples, by id.
  std::vector<std::string> tissue_names;
  std::vector<std::string> layer_names;
  std::vector<std::string> label_names;  ///< 256 entries.
};

/// Pose of the virtual transducer at a time. Frame P.
struct TransducerSample {
  double time_s = 0.0;     ///< Same time base as the ticks.
  Pose X_PT;               ///< Felt pose: does not pass through the skin.
  double contact_n = 0.0;  ///< Contact force of skin and face.
};

/// Parameters in force from a tick on.
struct SessionParameters {
  std::size_t tick = 0;  ///< Index of the first sample that was made with them.
  double time_s = 0.0;   ///< Time of that sample.
  /// Differences from the previous parameters. For the first parameters: the user's settings of the tissue table:
  /// "skin.fp=6".
  std::vector<std::string> settings;
  std::vector<std::string> options;  ///< All options: force model, coupling …; see haptics/option_texts.h.
  std::string tissue_table_toml;     ///< The whole table.
};

/// Writes a session during the attempt: one SQLite file, in WAL mode where the file system permits it, else with a
/// rollback journal (commits then wait until no other program reads). If the program is killed at any moment, the file
/// lacks at most the last half second of ticks and can be opened again: ticks are buffered and committed every 0.5 s of
/// session time, and after as many ticks as 0.5 s contain at the session's rate. After the first failure it writes no
/// more and returns that failure again. Not real-time safe; one thread. Without finish() the buffered data are written
/// and the session stays incomplete, in one file. Every commit has a checksum of its ticks and events; each other table
/// has one checksum.
class SessionWriter {
 public:
  /// An existing file is refused (exit status 2). A file that could not be set up is removed again.
  static Result<SessionWriter> create(const std::filesystem::path& path, const SessionInfo& info);
  SessionWriter(SessionWriter&&) noexcept;
  SessionWriter& operator=(SessionWriter&&) noexcept;
  ~SessionWriter();

  Status append(const telemetry::TickSample& sample);
  /// In the order of time. A sample that is not later than the last one, or not finite, is left out.
  Status append(const TransducerSample& sample);
  /// The same.
  Status append(const tasks::XrayUse& use);
  /// The same.
  Status append(const tasks::Action& action);
  /// The same. Kept in micrometres.
  Status append(const telemetry::NeedleShape& shape);
  /// Parameters of a sample that was appended already, in the order of ticks, one per tick.
  Status append(const SessionParameters& parameters);
  /// In the order of time.
  Status append(const tasks::Interruption& interruption);
  /// Writes the buffered data, then the outcome, and makes it a single file again. `shots`: indices of samples. Nothing
  /// can be appended afterwards.
  Status finish(const scoring::Outcome& outcome, std::span<const std::size_t> shots);
  std::size_t saved_ticks() const noexcept;  ///< Ticks committed so far.
  /// What the user has to know of a folder where SQLite has no write-ahead log, in one line; empty: nothing.
  std::string note() const;
  /// Hash of all ticks, see Session; empty before finish().
  const std::string& ticks_hash() const noexcept;

 private:
  struct Impl;
  explicit SessionWriter(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// A part of a session that cannot be read or does not match its checksum, and is left out.
struct SessionDamage {
  std::string part;            ///< Description: "ticks 500 to 999".
  std::size_t first_tick = 0;  ///< First one of damaged ticks.
  std::size_t ticks = 0;       ///< 0: the part does not consist of ticks.
  std::size_t sample = 0;      ///< For damaged ticks: index in `samples` of the first one after them.
};

struct Session {
  SessionInfo info;
  std::vector<telemetry::TickSample> samples;
  std::vector<TransducerSample> transducer;  ///< By time; empty: there was none, or an older program recorded it.
  std::vector<tasks::XrayUse> xray;          ///< By time, each until the next one; empty: no X-ray was used.
  std::vector<tasks::Action> actions;        ///< By time; empty also in a session of an older program.
  /// By time, each until the next one; straight before the first. Empty: never bent, or an older program recorded it.
  std::vector<telemetry::NeedleShape> shapes;
  std::vector<SessionParameters> parameters;       ///< By tick; empty: an older program wrote the session.
  std::vector<tasks::Interruption> interruptions;  ///< By time.
  std::optional<scoring::Outcome> outcome;         ///< Missing when the program was killed before the end.
  std::vector<std::size_t> shots;                  ///< Samples at which the biopsy gun was fired, in order.
  bool is_incomplete = false;                      ///< The program ended before the attempt did.
  /// XXH3 (128 bits, hexadecimal) of all values of all ticks: two sessions have the same hash if and only if their
  /// ticks are the same bit by bit (NaN is one value, -0.0 is 0.0). Empty: incomplete, or of an older program.
  std::string ticks_hash;
  bool has_checksums = false;         ///< Missing in sessions of older programs: damage may pass unnoticed.
  std::vector<SessionDamage> damage;  ///< In the order of ticks; load_session returns an empty list.
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
/// Copies a session of a finished or killed program to a new file, as one file with all that was committed; the
/// original is only read. Errors: it cannot be read or written.
Status copy_session(const std::filesystem::path& from, const std::filesystem::path& to);
/// Renames an incomplete session that an interrupted program left at `path` (first.session ->
/// first.incomplete.session), so that a new one can be made there; returns its new path. Empty if there is no such
/// session. Errors: another program is still writing it, or it cannot be renamed.
Result<std::optional<std::filesystem::path>> set_aside_incomplete_session(const std::filesystem::path& path);

/// Text of an event, "puncture:skin"; empty for kNone. An id without a name is "#id".
std::string event_text(const SessionInfo& info, const telemetry::TickEvent& event);
/// Text of the events of a sample: "puncture:skin;enter:liver".
std::string event_text(const SessionInfo& info, const telemetry::TickSample& sample);
/// Text in the CSV: "set:skin.fp=6;set:liver.k=0.5", "interruption:39.000" (seconds). Empty: nothing.
std::string event_text(const SessionParameters& parameters);
std::string event_text(const tasks::Interruption& interruption);
/// One row per tick under a header, comma separated; numbers in the shortest form that reads back to the same value,
/// nan and inf as words. Columns: docs and `trocar session export --help`. Written completely or not at all. Of an
/// incomplete session the last row has the event "incomplete"; after a gap of damaged ticks the next row (or the last
/// one) has the event "damaged:FIRST-LAST".
Status export_csv(const Session& session, const std::filesystem::path& path);

/// A session without its recording.
struct SessionSummary {
  SessionInfo info;                         ///< The tissue table is that of the start, without names of ids.
  std::optional<scoring::Outcome> outcome;  ///< Missing in an incomplete session.
  bool is_incomplete() const noexcept { return !outcome.has_value(); }
};

/// Reads info and outcome of a session and checks their checksums; the time does not grow with the recording. Errors:
/// those of load_session, but for damage in the recording, which passes unnoticed.
Result<SessionSummary> load_summary(const std::filesystem::path& path);

}  // namespace trocar::storage
