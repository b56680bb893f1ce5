#include "station/journal.h"

#include "config/json.h"
#include "core/atomic_file.h"

namespace trocar {
namespace {

constexpr int kVersion = 1;

Json to_json(const SeatState& state) {
  const CaseOptions& options = state.choice.options;
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

/// Nothing where a field is missing or of another kind.
std::optional<SeatState> from_json(const Json& json) {
  const auto text = [&](const char* key) -> std::optional<std::string> {
    return json.contains(key) && json[key].is_string() ? std::optional(json[key].get<std::string>()) : std::nullopt;
  };
  const auto number = [&](const char* key) -> std::uint64_t {
    return json.contains(key) && json[key].is_number_unsigned() ? json[key].get<std::uint64_t>() : 1;
  };
  if (!json.is_object() || !json.contains("version") || json["version"] != kVersion) return std::nullopt;
  const auto session = text("session"), patient = text("patient"), task = text("task");
  if (!session || !patient || !task) return std::nullopt;
  SeatState state;
  state.session = *session;
  state.choice.patient_source = *patient;
  state.choice.patient_seed = number("patient_seed");
  state.choice.force_model = text("force_model").value_or("");
  CaseOptions& options = state.choice.options;
  options.task = *task;
  options.needle = text("needle").value_or("");
  options.tissue_file = text("tissue_file").value_or("");
  options.profile = text("profile").value_or("");
  options.seed = number("seed");
  if (json.contains("overrides") && json["overrides"].is_array())
    for (const Json& one : json["overrides"])
      if (one.is_string()) options.overrides.push_back(one.get<std::string>());
  return state;
}

}  // namespace

Status Journal::begin(const SeatState& state) const {
  return write_file_atomically(path_, json_text(to_json(state)));
}

void Journal::clear() const noexcept {
  std::error_code error;
  std::filesystem::remove(path_, error);
}

std::optional<SeatState> Journal::recover() const {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path_, error)) return std::nullopt;
  const Result<Json> json = load_json(path_);
  if (!json) return std::nullopt;
  auto state = from_json(*json);
  if (!state || !std::filesystem::is_regular_file(state->session, error)) return std::nullopt;
  return state;
}

}  // namespace trocar
