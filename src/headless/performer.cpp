#include "headless/performer.h"

#include <fmt/format.h>

#include <charconv>

namespace trocar {
namespace {

/// An operator as it was named: the text after the colon, if any, is its speed or its session.
struct OperatorChoice {
  enum class Kind { kExpert, kNovice, kConstantVelocity, kReplay };
  Kind kind = Kind::kExpert;
  double speed_mm_per_s = 0.0;
  std::string session;
};

Result<double> parse_speed(std::string_view text) {
  double speed = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), speed);
  if (error == std::errc() && end == text.data() + text.size() && speed >= 0.1 && speed <= 500.0) return speed;
  return fail_usage(fmt::format("speed {} is not a number from 0.1 to 500 mm/s", text), "--operator constant-velocity",
                    "write it as constant-velocity:10");
}

Result<OperatorChoice> parse_operator(std::string_view name) {
  using Kind = OperatorChoice::Kind;
  if (name == "expert") return OperatorChoice{Kind::kExpert, 0.0, {}};
  if (name == "novice") return OperatorChoice{Kind::kNovice, 0.0, {}};
  constexpr std::string_view kConstant = "constant-velocity:";
  if (name.starts_with(kConstant)) {
    TROCAR_TRY(const double speed, parse_speed(name.substr(kConstant.size())));
    return OperatorChoice{Kind::kConstantVelocity, speed, {}};
  }
  constexpr std::string_view kReplay = "replay:";
  if (name.starts_with(kReplay)) return OperatorChoice{Kind::kReplay, 0.0, std::string(name.substr(kReplay.size()))};
  return fail_usage(fmt::format("no operator named {}", name), "--operator",
                    "use expert, novice, constant-velocity:MM_PER_S or replay:SESSION");
}

Result<Performer> make_named(const Case& the_case, const RunOptions& options) {
  const OperatorCase what{the_case.plan.line_P, the_case.needle.is_biopsy, options.seed};
  const std::string& force_model = the_case.task.force_model;
  TROCAR_TRY(const OperatorChoice choice, parse_operator(options.operator_name));
  switch (choice.kind) {
    case OperatorChoice::Kind::kExpert:
      return Performer{make_expert(what), options.rate_hz, false, force_model};
    case OperatorChoice::Kind::kNovice:
      return Performer{make_novice(what), options.rate_hz, false, force_model};
    case OperatorChoice::Kind::kConstantVelocity:
      return Performer{make_constant_velocity(what, choice.speed_mm_per_s), options.rate_hz, false, force_model};
    case OperatorChoice::Kind::kReplay:
      break;
  }
  TROCAR_TRY(Session session, load_session(choice.session));
  const double rate_hz = session.info.rate_hz;
  return Performer{make_replay(std::move(session.samples), session.fired), rate_hz, true, session.info.force_model};
}

}  // namespace

Status check_operator(std::string_view name) {
  TROCAR_TRY_STATUS(parse_operator(name));
  return {};
}

Result<Performer> make_performer(const Case& the_case, const RunOptions& options) {
  TROCAR_TRY(Performer performer, make_named(the_case, options));
  if (!options.force_model.empty()) performer.force_model = options.force_model;
  return performer;
}

}  // namespace trocar
