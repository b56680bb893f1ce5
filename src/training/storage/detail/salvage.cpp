#include "storage/detail/salvage.h"

#include <fmt/format.h>

#include <algorithm>

#include "storage/detail/checksums.h"
#include "storage/detail/info_table.h"
#include "storage/detail/parameters_table.h"
#include "storage/detail/tick_buffer.h"
#include "storage/detail/timed_table.h"

namespace trocar::storage::detail {
namespace {

constexpr std::size_t kUncheckedBlockTicks = 500;  // a session without checksums is also read in blocks

// Names of the parts of a session in messages.
constexpr const char* kInfoPart = "facts of the case (table info)";
constexpr const char* kNamesPart = "names of tissues, layers, labels or phases";
constexpr const char* kBlocksPart = "list of tick blocks (table tick_blocks)";
constexpr const char* kTransducerPart = "poses of the transducer";
constexpr const char* kXrayPart = "use of the X-ray";
constexpr const char* kActionsPart = "actions of the trainee";
constexpr const char* kShapesPart = "shapes of the needle";
constexpr const char* kParametersPart = "changes of parameters";
constexpr const char* kInterruptionsPart = "interruptions";
constexpr const char* kTicksHashPart = "hash of all ticks";
constexpr const char* kOutcomePart = "outcome (score and hints)";

class Salvage {
 public:
  Salvage(GuardedDatabase& database, Session& session) : database_(database), session_(session) {}

  std::string read() {
    check_tables();
    session_.has_checksums = database_.has_table("tick_blocks") || database_.has_table("checksums");
    is_finished_ = has_outcome();
    if (attempt(kInfoPart, [&] { session_.info = read_info(database_.session()); })) {
      check(kInfoPart, kInfoRows, true);
      check(kNamesPart, kNameRows, true);
    }
    read_samples();
    const bool is_read = attempt(kTransducerPart, [&] { session_.transducer = read_transducer(database_.session()); });
    if (!is_read || !check(kTransducerPart, kTransducerRows, is_finished_)) session_.transducer.clear();
    read_added(kXrayPart, kXrayRows, session_.xray, [&] { session_.xray = read_xray(database_.session()); });
    read_added(kActionsPart, kActionRows, session_.actions,
               [&] { session_.actions = read_actions(database_.session()); });
    read_added(kShapesPart, kShapeRows, session_.shapes, [&] { session_.shapes = read_shapes(database_.session()); });
    read_parameters_and_interruptions();
    if (is_finished_ && session_.has_checksums)
      attempt(kTicksHashPart, [&] { session_.ticks_hash = read_ticks_hash(database_.session()); });
    session_.is_incomplete = !is_finished_ && !has_part(kOutcomePart);
    std::string outcome = read_outcome();
    find_shots();
    return outcome;
  }

 private:
  void check_tables() {
    for (const char* table : {"info", "tissues", "layers", "labels", "phases", "ticks", "events", "outcome"})
      database_.require_table(table);
    for (const char* table :
         {"transducer", "xray", "actions", "needle_shape", "parameters", "interruptions", "tick_blocks", "checksums"})
      if (database_.has_table(table)) database_.require_table(table);
  }

  /// A finished session has an outcome, and a checksum of it.
  bool has_outcome() {
    int rows = 0;
    std::optional<RowsDigest> written;
    attempt(kOutcomePart, [&] {
      database_.session() << "SELECT count(*) FROM outcome", soci::into(rows);
      if (session_.has_checksums) written = read_checksum(database_.session(), kOutcomeRows);
    });
    return rows > 0 || written.has_value();
  }

  /// Records damage if the work throws.
  template <class Work>
  bool attempt(const char* part, const Work& work) {
    try {
      work();
      return true;
    } catch (const std::exception&) {
      note(part);
      return false;
    }
  }

  /// Checks rows against their checksum. A missing checksum is damage if it is required.
  bool check(const char* part, const CheckedRows& rows, bool is_required) {
    if (!session_.has_checksums) return true;
    if (has_part(part)) return false;
    bool is_valid = false;
    attempt(part, [&] {
      const auto written = read_checksum(database_.session(), rows);
      is_valid = written ? digest_of_rows(database_.session(), rows.query) == *written : !is_required;
    });
    if (!is_valid) note(part);
    return is_valid;
  }

  bool has_part(const std::string& part) const {
    return std::any_of(session_.damage.begin(), session_.damage.end(),
                       [&](const SessionDamage& damage) { return damage.part == part; });
  }
  void note(const std::string& part) {
    if (!has_part(part)) session_.damage.push_back({part});
  }

  void note_ticks(std::size_t first_tick, std::size_t ticks) {
    SessionDamage* last = session_.damage.empty() ? nullptr : &session_.damage.back();
    if (last != nullptr && last->ticks > 0 && last->first_tick + last->ticks == first_tick) {
      last->ticks += ticks;
    } else {
      session_.damage.push_back({{}, first_tick, ticks, session_.samples.size()});
      last = &session_.damage.back();
    }
    last->part = fmt::format("ticks {} to {}", last->first_tick, last->first_tick + last->ticks - 1);
  }

  /// Number of ticks according to the table; 0 if it cannot be read.
  std::size_t ticks_in_table() {
    int last = -1;
    soci::indicator indicator = soci::i_null;
    attempt(session_.has_checksums ? kBlocksPart : "ticks",
            [&] { database_.session() << "SELECT max(tick) FROM ticks", soci::into(last, indicator); });
    return indicator == soci::i_ok && last >= 0 ? static_cast<std::size_t>(last) + 1 : 0;
  }

  std::vector<TickBlock> find_blocks(std::size_t ticks) {
    std::vector<TickBlock> blocks;
    if (session_.has_checksums) {
      attempt(kBlocksPart, [&] { read_blocks(database_.session(), blocks); });
      check(kBlocksPart, kBlockRows, is_finished_);
      return blocks;
    }
    for (std::size_t first = 0; first < ticks; first += kUncheckedBlockTicks)
      blocks.push_back({first, std::min(kUncheckedBlockTicks, ticks - first), {}});
    return blocks;
  }

  void read_parameters_and_interruptions() {
    auto& parameters = session_.parameters;
    read_added(kParametersPart, kParameterRows, parameters,
               [&] { parameters = read_parameters(database_.session(), ticks_in_table()); });
    auto& interruptions = session_.interruptions;
    read_added(kInterruptionsPart, kInterruptionRows, interruptions,
               [&] { interruptions = read_interruptions(database_.session()); });
    move_parameters_to_samples();
  }

  /// A table that sessions of older programs lack; a missing table with a checksum is damage.
  template <class Rows, class Work>
  void read_added(const char* part, const CheckedRows& checked, Rows& rows, const Work& work) {
    bool was_written = database_.has_table(checked.name);
    if (!was_written && session_.has_checksums)
      attempt(part, [&] { was_written = read_checksum(database_.session(), checked).has_value(); });
    if (!was_written) return;
    if (!attempt(part, work) || !check(part, checked, is_finished_)) rows.clear();
  }

  /// If ticks are missing, parameters apply from the first sample after their tick.
  void move_parameters_to_samples() {
    const auto& samples = session_.samples;
    if (session_.damage.empty()) return;
    for (SessionParameters& parameters : session_.parameters) {
      const auto behind = std::find_if(samples.begin(), samples.end(), [&](const telemetry::TickSample& sample) {
        return sample.time_s >= parameters.time_s;
      });
      parameters.tick = static_cast<std::size_t>(behind - samples.begin());
    }
  }

  void read_samples() {
    const std::size_t ticks = ticks_in_table();
    std::size_t next_tick = 0;
    TickReader reader(database_.session());
    for (const TickBlock& block : find_blocks(ticks)) {
      if (database_.is_exhausted()) return;
      if (block.first_tick > next_tick) note_ticks(next_tick, block.first_tick - next_tick);
      next_tick = block.first_tick + block.ticks;
      try {
        const std::vector<telemetry::TickSample> samples = reader.read(block);
        session_.samples.insert(session_.samples.end(), samples.begin(), samples.end());
      } catch (const std::exception&) {
        note_ticks(block.first_tick, block.ticks);
      }
    }
    if (ticks > next_tick) note_ticks(next_tick, ticks - next_tick);
  }

  /// The sample of a tick, if it was read.
  std::optional<std::size_t> sample_of(std::size_t tick) const {
    std::size_t missing = 0;
    for (const SessionDamage& damage : session_.damage) {
      if (damage.ticks == 0 || damage.first_tick > tick) continue;
      if (tick < damage.first_tick + damage.ticks) return std::nullopt;
      missing += damage.ticks;
    }
    const std::size_t sample = tick - missing;
    if (sample >= session_.samples.size()) throw soci::soci_error("the fired tick is out of range");
    return sample;
  }

  /// The samples of the shots among the actions; that of the outcome is an older program's.
  void find_shots() {
    constexpr double kSameTick_s = 1e-4;  // actions of one tick are recorded a little after each other
    const auto& samples = session_.samples;
    std::vector<std::size_t> shots;
    for (const tasks::Action& action : session_.actions) {
      if (action.kind != tasks::ActionKind::kFire) continue;
      const auto behind = std::upper_bound(samples.begin(), samples.end(), action.time_s,
                                           [](double time_s, const auto& sample) { return time_s < sample.time_s; });
      if (behind == samples.begin() || action.time_s - (behind - 1)->time_s > kSameTick_s) continue;
      shots.push_back(static_cast<std::size_t>(behind - samples.begin()) - 1);
    }
    if (!shots.empty()) session_.shots = std::move(shots);
  }

  std::string read_outcome() {
    std::string json;
    const bool is_read = attempt(kOutcomePart, [&] {
      int fired = 0;
      soci::indicator indicator = soci::i_null;
      database_.session() << "SELECT fired_tick, json FROM outcome", soci::into(fired, indicator), soci::into(json);
      if (json.empty() || indicator != soci::i_ok) return;
      if (fired < 0) throw soci::soci_error("the fired tick is out of range");
      if (const auto sample = sample_of(static_cast<std::size_t>(fired))) session_.shots = {*sample};
    });
    if (is_read && check(kOutcomePart, kOutcomeRows, is_finished_)) return json;
    session_.shots.clear();
    return {};
  }

  GuardedDatabase& database_;
  Session& session_;
  bool is_finished_ = false;
};

}  // namespace

std::string salvage(GuardedDatabase& database, Session& session) {
  return Salvage(database, session).read();
}

}  // namespace trocar::storage::detail
