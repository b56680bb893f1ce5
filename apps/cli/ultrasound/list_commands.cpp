// trocar ultrasound views and transducers: available choices.
#include <fmt/format.h>

#include <algorithm>

#include "cli/commands.h"
#include "cli/constants.h"
#include "cli/patient_option.h"
#include "config/json.h"
#include "io/patient/patient_cache.h"
#include "ultrasound/probe/probe_view.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::cli {
namespace {

struct ViewArguments {
  io::PatientSource source;
  bool is_json = false;
};

/// `missing`: why the patient does not offer it; empty if he does; nothing without a patient.
config::Json view_json(const ultrasound::ProbeView& view, const std::optional<std::string>& missing,
                       const anatomy::Label* target) {
  return {{"name", view.name},
          {"title", view.title},
          {"transducer", view.transducer},
          {"depth_mm", view.depth_mm},
          {"possible", missing ? config::Json(missing->empty()) : config::Json(nullptr)},
          {"reason", missing && !missing->empty() ? config::Json(*missing) : config::Json(nullptr)},
          {"target", target != nullptr ? config::Json(target->name) : config::Json(nullptr)}};
}

Status list_views(const ViewArguments& arguments) {
  TROCAR_TRY(const auto file, find_data("views.toml"));
  TROCAR_TRY(const auto views, ultrasound::load_probe_views(file));
  const bool has_patient = !arguments.source.folder_or_name.empty();
  anatomy::VirtualPatient patient;
  if (has_patient) {
    const ProgressPrinter printer;
    TROCAR_TRY(patient, io::open_patient(arguments.source, printer.callback()));
  }
  config::Json list = config::Json::array();
  for (const ultrasound::ProbeView& view : views) {
    std::optional<std::string> missing;
    if (has_patient) missing = ultrasound::missing_label(patient, view);
    const bool is_possible = missing && missing->empty();
    const anatomy::Label* target = is_possible ? ultrasound::find_target(patient, view.targets) : nullptr;
    if (arguments.is_json) {
      list.push_back(view_json(view, missing, target));
      continue;
    }
    const std::string what = !missing ? "" : target != nullptr ? target->name : "not offered: " + *missing;
    fmt::print("{:<20} {:<6} {:>3.0f} mm  {}{}\n", view.name, view.transducer, view.depth_mm, view.title,
               what.empty() ? "" : fmt::format(" ({})", what));
  }
  if (arguments.is_json) print_json({{"views", list}});
  return {};
}

const char* name_of(ultrasound::TransducerKind kind) {
  switch (kind) {
    case ultrasound::TransducerKind::kConvex:
      return "convex";
    case ultrasound::TransducerKind::kLinear:
      return "linear";
    case ultrasound::TransducerKind::kPhased:
      return "phased";
    case ultrasound::TransducerKind::kMechanicalConvex:
      return "mechanical convex";
  }
  return "";
}

config::Json transducer_json(const ultrasound::Transducer& t) {
  const bool is_fan = t.kind != ultrasound::TransducerKind::kLinear;
  const bool has_arc = is_fan && t.kind != ultrasound::TransducerKind::kPhased;
  const bool has_motor = t.kind == ultrasound::TransducerKind::kMechanicalConvex;
  const auto where = [](bool applies, double value) { return applies ? config::Json(value) : config::Json(nullptr); };
  return {{"name", t.name},
          {"description", t.description},
          {"kind", name_of(t.kind)},
          {"frequency_mhz", t.frequency_mhz},
          {"lowest_mhz", t.lowest_mhz},
          {"highest_mhz", t.highest_mhz},
          {"elements", t.elements},
          {"pitch_mm", t.pitch_mm},
          {"face_width_mm", t.face_width_mm()},
          {"radius_mm", where(has_arc, t.radius_mm)},
          {"field_of_view_deg", where(is_fan, t.field_of_view_rad * kDegPerRad)},
          {"depth_mm", t.depth_mm},
          {"greatest_depth_mm", t.greatest_depth_mm},
          {"focus_mm", t.focus_mm},
          {"elevation_focus_mm", t.elevation_focus_mm},
          {"sweep_deg", where(has_motor, t.sweep_rad * kDegPerRad)},
          {"sweep_radius_mm", where(has_motor, t.sweep_radius_mm)}};
}

void print_transducers(const std::vector<ultrasound::Transducer>& transducers) {
  fmt::print("{:<12} {:<18} {:>12} {:>9} {:>8} {:>7} {:>8} {:>10}\n", "name", "kind", "MHz", "face", "radius", "fan",
             "depth", "sweep");
  for (const ultrasound::Transducer& t : transducers) {
    const bool is_fan = t.kind != ultrasound::TransducerKind::kLinear;
    const bool has_arc = is_fan && t.kind != ultrasound::TransducerKind::kPhased;
    const std::string radius = has_arc ? fmt::format("{:.0f} mm", t.radius_mm) : "";
    const std::string fan = is_fan ? fmt::format("{:.0f} deg", t.field_of_view_rad * kDegPerRad) : "";
    const std::string sweep = t.kind == ultrasound::TransducerKind::kMechanicalConvex
                                  ? fmt::format("{:.0f} deg", t.sweep_rad * kDegPerRad)
                                  : "";
    fmt::print("{:<12} {:<18} {:>12} {:>6.0f} mm {:>8} {:>7} {:>5.0f} mm {:>10}  {}\n", t.name, name_of(t.kind),
               fmt::format("{:g} ({:g}-{:g})", t.frequency_mhz, t.lowest_mhz, t.highest_mhz), t.face_width_mm(), radius,
               fan, t.depth_mm, sweep, t.description);
  }
}

Status list_transducers(const ViewArguments& arguments) {
  TROCAR_TRY(const auto file, find_data("transducers.toml"));
  TROCAR_TRY(const auto transducers, ultrasound::load_transducers(file));
  if (!arguments.is_json) {
    print_transducers(transducers);
    return {};
  }
  config::Json list = config::Json::array();
  for (const ultrasound::Transducer& transducer : transducers) list.push_back(transducer_json(transducer));
  print_json({{"transducers", list}});
  return {};
}

}  // namespace

void add_ultrasound_list_commands(Command& ultrasound, Action& action) {
  const auto a = std::make_shared<ViewArguments>();  // one command runs: they share the arguments
  Command views = ultrasound.add_command("views", "List standard views, and whether a patient supports them");
  views.add_option("--patient", a->source.folder_or_name, "Patient folder, or an embedded patient's name");
  views.add_option("--patient-seed", a->source.seed, "Seed of an embedded patient").seed().show_default();
  add_cache_option(views, a->source);
  views.add_flag("--json", a->is_json, "Print one JSON object");
  views.footer("Example:\n  trocar ultrasound views --patient abdomen\n");
  views.when_parsed([&action, a] { action = [a] { return list_views(*a); }; });

  Command transducers = ultrasound.add_command("transducers", "List available transducers");
  transducers.add_flag("--json", a->is_json, "Print one JSON object");
  transducers.footer("Example:\n  trocar ultrasound transducers\n");
  transducers.when_parsed([&action, a] { action = [a] { return list_transducers(*a); }; });
}

}  // namespace trocar::cli
