#include "attempt/live/performer.h"

#include <fmt/format.h>

#include "anatomy/tissue/tissue_settings.h"
#include "attempt/record/attempt_record.h"
#include "core/text.h"
#include "haptics/haptic_scene.h"
#include "motion/patient_motion.h"
#include "tasks/fit_to_patient.h"

namespace trocar::attempt {
namespace {

/// An operator by its name: the text after the colon is its share of errors, its speed or its session.
struct OperatorChoice {
  enum class Kind { kExpert, kNovice, kConstantVelocity, kReplay };
  Kind kind = Kind::kExpert;
  double speed_mm_per_s = 0.0;
  std::string session;
  std::optional<double> error_share = {};
};

Result<double> parse_speed(std::string_view text) {
  const auto speed = parse_number<double>(text);
  if (speed && *speed >= 0.1 && *speed <= 500.0) return *speed;
  return fail_usage(fmt::format("speed \"{}\" is not a number from 0.1 to 500 mm/s", text),
                    "--operator constant-velocity", "write it as constant-velocity:10");
}

Result<double> parse_share(std::string_view text) {
  const auto share = parse_number<double>(text);
  if (share && *share >= 0.0 && *share <= 1.0) return *share;
  return fail_usage(fmt::format("share of errors \"{}\" is not a number from 0 to 1", text), "--operator novice",
                    "write it as novice:0.5");
}

Result<OperatorChoice> parse_operator(std::string_view name) {
  using Kind = OperatorChoice::Kind;
  if (name == "expert") return OperatorChoice{Kind::kExpert, 0.0, {}};
  if (name == "novice") return OperatorChoice{Kind::kNovice, 0.0, {}};
  constexpr std::string_view kNovice = "novice:";
  if (name.starts_with(kNovice)) {
    TROCAR_TRY(const double share, parse_share(name.substr(kNovice.size())));
    return OperatorChoice{Kind::kNovice, 0.0, {}, share};
  }
  constexpr std::string_view kConstant = "constant-velocity:";
  if (name.starts_with(kConstant)) {
    TROCAR_TRY(const double speed, parse_speed(name.substr(kConstant.size())));
    return OperatorChoice{Kind::kConstantVelocity, speed, {}};
  }
  constexpr std::string_view kReplay = "replay:";
  if (name == kReplay) return fail_usage("replay: needs a session", "--operator", "write replay:SESSION");
  if (name.starts_with(kReplay)) return OperatorChoice{Kind::kReplay, 0.0, std::string(name.substr(kReplay.size()))};
  return fail_usage(fmt::format("no operator named {}", name), "--operator",
                    "use expert, novice, novice:SHARE, constant-velocity:MM_PER_S or replay:SESSION");
}

Result<Performer> make_replayer(const cases::Case& the_case, const RunOptions& options) {
  std::shared_ptr<const storage::Session> session = options.replayed;
  if (session == nullptr) {
    TROCAR_TRY(session, load_replayed(options.operator_name));
  }
  if (!options.is_other_patient_meant) TROCAR_TRY_STATUS(check_patient(*session, *the_case.patient));
  ReplayChanges changes = options.replay_changes;
  if (changes.force_model.empty()) changes.force_model = options.force_model;
  Performer performer;
  TROCAR_TRY(performer.parameters, replay_parameters(*session, changes));
  performer.the_operator = tasks::make_replay(session->samples, session->actions);
  performer.rate_hz = session->info.rate_hz;
  performer.has_own_rate = true;
  performer.force_model = session->info.force_model;
  performer.replayed = std::move(session);
  return performer;
}

Result<Performer> make_named(const cases::Case& the_case, const RunOptions& options) {
  tasks::OperatorCase what{the_case.plan.line_P, the_case.needle.is_biopsy, options.seed,
                           tasks::actions_for(the_case.task, the_case.needle)};
  what.bevel_P = tasks::planned_bevel_P(the_case.task, *the_case.patient, the_case.plan.line_P);
  what.cover_mm = tasks::landmark_cover_mm(the_case.task, *the_case.patient, the_case.plan.line_P);
  what.actions.holds_breath = motion::moves(the_case.breathing) && !the_case.breathing.is_held;
  if (const tasks::Tier* const level = tasks::level_of(the_case.task)) what.tremor_mm = level->tremor_mm;
  const std::string& force_model = the_case.task.force_model;
  TROCAR_TRY(const OperatorChoice choice, parse_operator(options.operator_name));
  switch (choice.kind) {
    case OperatorChoice::Kind::kExpert:
      return Performer{tasks::make_expert(what), options.rate_hz, false, force_model};
    case OperatorChoice::Kind::kNovice:
      what.error_share = choice.error_share;
      return Performer{tasks::make_novice(what), options.rate_hz, false, force_model};
    case OperatorChoice::Kind::kConstantVelocity:
      return Performer{tasks::make_constant_velocity(what, choice.speed_mm_per_s), options.rate_hz, false, force_model};
    case OperatorChoice::Kind::kReplay:
      break;
  }
  return make_replayer(the_case, options);
}

}  // namespace

Status check_operator(std::string_view name) {
  TROCAR_TRY_STATUS(parse_operator(name));
  return {};
}

Result<Performer> make_performer(const cases::Case& the_case, const RunOptions& options) {
  TROCAR_TRY(Performer performer, make_named(the_case, options));
  if (!options.force_model.empty()) performer.force_model = options.force_model;
  const bool has_constraint = performer.force_model == to_string(haptics::ForceModel::kInsertion);
  if (!has_constraint && performer.replayed == nullptr) {  // a recorded attempt stays as it was
    for (const std::string& setting : anatomy::user_settings(the_case.tissues))
      if (setting.starts_with("path_constraint."))
        return fail_usage(fmt::format("the {} model has no path constraint", performer.force_model), "--set " + setting,
                          "leave it out, or use --force-model insertion");
  }
  return performer;
}

Result<std::shared_ptr<const storage::Session>> load_replayed(std::string_view operator_name) {
  TROCAR_TRY(const OperatorChoice choice, parse_operator(operator_name));
  if (choice.kind != OperatorChoice::Kind::kReplay) return std::shared_ptr<const storage::Session>();
  TROCAR_TRY(storage::Session session, storage::load_session(choice.session));
  if (session.samples.empty())
    return fail("the session ended before its first tick", choice.session, "name another one");
  return std::make_shared<const storage::Session>(std::move(session));
}

std::string recorded_preset(const storage::SessionInfo& info) {
  if (!info.device_preset.empty()) return info.device_preset;
  // An older program stored only the text: "premium, simulated: …" or "virtual:premium, …, through trocar-hapticd …".
  constexpr std::string_view kSimulated = ", simulated: ";
  const std::string name = info.device.substr(0, info.device.find(','));
  if (std::string preset = preset_of_device(name); !preset.empty()) return preset;
  return info.device.find(kSimulated) == name.size() ? name : std::string();
}

RunOptions options_of(const Performer& performer, RunOptions options) {
  if (performer.replayed == nullptr) return options;
  const storage::SessionInfo& info = performer.replayed->info;
  options.seed = info.seed;
  options.rate_hz = info.rate_hz;
  if (!options.is_other_patient_meant) options.patient_seed = info.patient_seed;
  if (std::string preset = recorded_preset(info); !preset.empty()) options.device = std::move(preset);
  return options;
}

}  // namespace trocar::attempt
