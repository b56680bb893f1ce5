#include "tasks/phases/phase.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <functional>
#include <map>
#include <optional>

#include "anatomy/structure_words.h"
#include "tasks/action.h"

namespace trocar::tasks {
namespace {

enum class Argument : std::uint8_t { kNone, kNumber, kName, kSubstance };

struct ConditionRow {
  const char* key;
  Argument argument;
  config::Range range;  ///< Of a number.
  const char* words;    ///< {} is the argument.
};

constexpr std::array<ConditionRow, static_cast<std::size_t>(kLastCondition) + 1> kRows{{
    {"probe_on_skin", Argument::kNone, {}, "put the transducer on the skin"},
    {"target_in_image_mm", Argument::kNumber, {0.5, 50.0}, "bring the target into the image"},
    {"needle_in_plane_deg", Argument::kNumber, {1.0, 45.0}, "align the needle with the image plane"},
    {"tip_in_image_mm", Argument::kNumber, {0.5, 20.0}, "keep the needle's tip in the image"},
    {"tip_on_skin", Argument::kNone, {}, "put the needle's tip on the skin"},
    {"aims_at_target_deg", Argument::kNumber, {0.5, 45.0}, "aim the needle at the target"},
    {"path_clear_mm", Argument::kNumber, {0.0, 20.0}, "choose a way that keeps clear of structures at risk"},
    {"inserted_mm", Argument::kNumber, {0.5, 200.0}, "advance the needle {:.0f} mm into the body"},
    {"target_distance_mm", Argument::kNumber, {0.5, 50.0}, "bring the tip to the target"},
    {"tip_in", Argument::kName, {}, "bring the tip into the {}"},
    {"passed", Argument::kName, {}, "advance the tip into the {}"},
    {"stylet_drawn", Argument::kNone, {}, "remove the stylet"},
    {"returned", Argument::kSubstance, {}, "check what comes back: it has to be {}"},
    {"anaesthetised", Argument::kNone, {}, "give local anaesthetic"},
    {"breath_held", Argument::kNone, {}, "ask the patient to hold the breath"},
    {"contrast_ml", Argument::kNumber, {0.1, 50.0}, "inject {:.1f} ml of contrast agent in the target"},
    {"wire_mm", Argument::kNumber, {1.0, 300.0}, "advance the guide wire {:.0f} mm"},
    {"throw_clear", Argument::kNone, {}, "make sure that the throw ends in safe tissue"},
    {"fired", Argument::kNone, {}, "fire the gun"},
    {"cores", Argument::kNumber, {1.0, 10.0}, "take core number {:.0f}"},
    {"outside", Argument::kNone, {}, "withdraw the needle"},
    {"bevel_to_fibres_deg", Argument::kNumber, {1.0, 90.0}, "turn the needle until the bevel faces the side"},
    {"moved_mm", Argument::kNumber, {1.0, 100.0}, "move the needle"},
}};

static_assert(std::ranges::all_of(kRows, [](const ConditionRow& row) { return row.key != nullptr; }),
              "each ConditionKind has a row, in their order");

const ConditionRow& row_of(ConditionKind kind) noexcept {
  return kRows[static_cast<std::size_t>(kind)];
}

Result<std::optional<Condition>> read_condition(const config::TomlTable& table, ConditionKind kind) {
  const ConditionRow& row = row_of(kind);
  if (!table.has(row.key)) return std::optional<Condition>();
  Condition condition{kind, 0.0, {}};
  switch (row.argument) {
    case Argument::kNone: {
      TROCAR_TRY(const bool is_wanted, table.boolean_or(row.key, true));
      if (!is_wanted)
        return fail(fmt::format("{} = false asks for nothing", row.key), table.where(), "write true, or omit the key");
      break;
    }
    case Argument::kNumber: {
      TROCAR_TRY(condition.number, table.number(row.key, row.range));
      break;
    }
    case Argument::kName: {
      TROCAR_TRY(condition.name, table.string(row.key));
      break;
    }
    case Argument::kSubstance: {
      TROCAR_TRY(condition.name, table.string(row.key));
      if (!find_substance(condition.name))
        return fail(fmt::format("there is no substance \"{}\"", condition.name), table.where(),
                    "write one of data/substances.toml: csf, bile, ascites, blood …");
      break;
    }
  }
  return std::optional<Condition>(std::move(condition));
}

Result<Phase> read_phase(const config::TomlTable& row) {
  TROCAR_TRY_STATUS(row.check_keys({"name", "title", "why", "after", "hold_s", "done"}));
  Phase phase;
  TROCAR_TRY(phase.name, row.string("name"));
  TROCAR_TRY(phase.title, row.string("title"));
  TROCAR_TRY(phase.why, row.string("why"));
  TROCAR_TRY(phase.after, row.strings("after"));
  TROCAR_TRY(phase.hold_s, row.number_or("hold_s", {0.0, 60.0}, 0.0));
  TROCAR_TRY(const config::TomlTable done, row.table("done"));
  std::vector<std::string_view> known;
  for (const ConditionRow& condition : kRows) known.emplace_back(condition.key);
  TROCAR_TRY_STATUS(done.check_keys(known));
  for (std::size_t n = 0; n < kRows.size(); ++n) {
    TROCAR_TRY(auto condition, read_condition(done, static_cast<ConditionKind>(n)));
    if (condition) phase.done.push_back(*std::move(condition));
  }
  if (phase.done.empty())
    return fail(fmt::format("phase \"{}\" has no condition", phase.name), row.where(),
                fmt::format("add to done one of: {}", fmt::join(known, ", ")));
  return phase;
}

config::TomlValue value_of(const Condition& condition) {
  switch (row_of(condition.kind).argument) {
    case Argument::kNone:
      return true;
    case Argument::kNumber:
      return condition.number;
    case Argument::kName:
    case Argument::kSubstance:
      return condition.name;
  }
  return true;
}

/// The name of a phase that waits for itself; empty: none.
std::string find_cycle(const std::vector<Phase>& phases) {
  enum class Mark : std::uint8_t { kNew, kOpen, kClosed };
  std::map<std::string, Mark, std::less<>> marks;
  std::string found;
  const std::function<void(const std::string&)> visit = [&](const std::string& name) {
    if (marks[name] == Mark::kOpen) found = name;
    if (marks[name] != Mark::kNew || !found.empty()) return;
    marks[name] = Mark::kOpen;
    const auto phase = std::ranges::find(phases, name, &Phase::name);
    for (const std::string& before : phase->after) visit(before);
    marks[name] = Mark::kClosed;
  };
  for (const Phase& phase : phases)
    if (found.empty()) visit(phase.name);
  return found;
}

}  // namespace

const char* condition_key(ConditionKind kind) noexcept {
  return row_of(kind).key;
}

std::string condition_words(const Condition& condition) {
  const ConditionRow& row = row_of(condition.kind);
  switch (row.argument) {
    case Argument::kNumber:
      return fmt::format(fmt::runtime(row.words), condition.number);
    case Argument::kName:  // of several the first
      return fmt::format(fmt::runtime(row.words),
                         anatomy::structure_words(condition.name.substr(0, condition.name.find('|'))));
    case Argument::kSubstance:
      return fmt::format(fmt::runtime(row.words),
                         substance_words(find_substance(condition.name).value_or(Substance::kNothing)));
    case Argument::kNone:
      break;
  }
  return row.words;
}

Result<std::vector<Phase>> read_phases(const config::TomlTable& document) {
  TROCAR_TRY(const std::vector<config::TomlTable> rows, document.tables("phases"));
  std::vector<Phase> phases;
  for (const config::TomlTable& row : rows) {
    TROCAR_TRY(Phase phase, read_phase(row));
    phases.push_back(std::move(phase));
  }
  TROCAR_TRY_STATUS(check_phases(phases, document.where()));
  return phases;
}

void write_phases(config::TomlWriter& writer, const std::vector<Phase>& phases) {
  for (const Phase& phase : phases) {
    writer.begin_row("phases");
    writer.set("name", phase.name);
    writer.set("title", phase.title);
    writer.set("why", phase.why);
    if (!phase.after.empty()) writer.set("after", phase.after);
    if (phase.hold_s > 0.0) writer.set("hold_s", phase.hold_s);
    std::vector<config::TomlValue::Entry> done;
    for (const Condition& condition : phase.done) done.push_back({condition_key(condition.kind), value_of(condition)});
    writer.set("done", config::TomlValue(done));
  }
}

Status check_phases(const std::vector<Phase>& phases, const std::string& where) {
  for (const Phase& phase : phases) {
    if (std::ranges::count(phases, phase.name, &Phase::name) > 1)
      return fail(fmt::format("two phases are named \"{}\"", phase.name), where, "give each phase its own name");
    for (const std::string& before : phase.after)
      if (std::ranges::find(phases, before, &Phase::name) == phases.end())
        return fail(fmt::format("phase \"{}\" comes after \"{}\", which does not exist", phase.name, before), where,
                    "name one of the task's phases");
  }
  if (const std::string name = find_cycle(phases); !name.empty())
    return fail(fmt::format("phase \"{}\" waits for itself", name), where, "remove a name from its `after`");
  return {};
}

}  // namespace trocar::tasks
