#include "cli/ultrasound/scan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "cases/prepare_case.h"
#include "cli/patient_option.h"
#include "config/json.h"
#include "core/text.h"
#include "io/sequence/transform_file.h"
#include "ultrasound/probe/probe_placement.h"

namespace trocar::cli {
namespace {
namespace fs = std::filesystem;

constexpr double kLeastDepth_mm = 20.0;
constexpr double kLeastFocus_mm = 5.0;
/// No transducer images deeper; the limit of the transducer is checked later.
constexpr double kMostDepth_mm = 300.0;
/// With a given depth and no focus, the focus stays within the image.
constexpr double kDeepestFocus = 0.75;
constexpr double kWorthSaying = 0.1;  ///< Share of an image outside the CT that causes a warning.
/// Settings stored with a saved pose.
constexpr const char* kTransducerNote = "transducer";
constexpr const char* kDepthNote = "depth_mm";
constexpr const char* kFrequencyNote = "frequency_mhz";
constexpr const char* kFocusNote = "focus_mm";
constexpr const char* kHarmonicNote = "harmonic";

/// Applies a given number after checking it against the transducer's limits.
Status take(const char* option, const std::optional<double>& asked, double low, double high, const char* unit,
            double& value) {
  if (!asked) return {};
  value = *asked;
  if (value >= low && value <= high) return {};
  return fail_usage(fmt::format("{} is out of the range of the transducer", option), fmt::format("{}", value),
                    fmt::format("give {:g} to {:g} {}", low, high, unit));
}

/// Reads a setting saved with a pose, clamped to the transducer's range; `value` is unchanged if the file has none.
Status take_note(const io::TransformNotes& notes, const char* key, double low, double high, double& value,
                 const std::string& where) {
  const auto note = notes.find(key);
  if (note == notes.end()) return {};
  const auto& text = note->second;
  const auto number = parse_number<double>(text);
  if (!number)
    return fail(fmt::format("{} is not a number: \"{}\"", key, text), where, "correct or delete the comment line");
  value = std::clamp(*number, low, high);
  return {};
}

/// Applies the settings of the saved pose to the transducer that it was saved with.
Status take_notes(const io::TransformNotes& notes, const ultrasound::Transducer& transducer, const std::string& where,
                  ultrasound::Acquisition& acquisition) {
  const auto name = notes.find(kTransducerNote);
  if (name == notes.end() || name->second != transducer.name) return {};
  TROCAR_TRY_STATUS(
      take_note(notes, kDepthNote, kLeastDepth_mm, transducer.greatest_depth_mm, acquisition.depth_mm, where));
  TROCAR_TRY_STATUS(take_note(notes, kFrequencyNote, transducer.lowest_mhz, transducer.highest_mhz,
                              acquisition.frequency_mhz, where));
  TROCAR_TRY_STATUS(
      take_note(notes, kFocusNote, kLeastFocus_mm, transducer.greatest_depth_mm, acquisition.focus_mm, where));
  double harmonic = acquisition.is_harmonic ? 1.0 : 0.0;
  TROCAR_TRY_STATUS(take_note(notes, kHarmonicNote, 0.0, 1.0, harmonic, where));
  acquisition.is_harmonic = harmonic >= 0.5;
  return {};
}

/// Chooses the frequency to receive. Error: the transducer has no harmonic imaging.
Status tune_harmonic(const ultrasound::Transducer& transducer, ultrasound::Acquisition& acquisition) {
  const auto received_mhz = ultrasound::harmonic_mhz(transducer, acquisition.frequency_mhz);
  if (!received_mhz)
    return fail_usage(fmt::format("{} has no harmonic imaging: its band of {:g} to {:g} MHz is less than an octave",
                                  transducer.name, transducer.lowest_mhz, transducer.highest_mhz),
                      "--harmonic", "take another transducer");
  acquisition.frequency_mhz = *received_mhz;
  return {};
}

Result<ultrasound::Acquisition> gather_acquisition(const ScanArguments& a, const ultrasound::Transducer& transducer,
                                                   const std::optional<ultrasound::ProbeView>& view,
                                                   const io::TransformNotes& notes) {
  ultrasound::Acquisition acquisition = ultrasound::default_acquisition(transducer);
  if (view) acquisition.depth_mm = std::min(view->depth_mm, transducer.greatest_depth_mm);
  if (view && view->frequency_mhz)
    acquisition.frequency_mhz = std::clamp(*view->frequency_mhz, transducer.lowest_mhz, transducer.highest_mhz);
  if (view && view->focus_mm) acquisition.focus_mm = *view->focus_mm;
  TROCAR_TRY_STATUS(take_notes(notes, transducer, a.pose, acquisition));
  TROCAR_TRY_STATUS(
      take("--depth-mm", a.depth_mm, kLeastDepth_mm, transducer.greatest_depth_mm, "mm", acquisition.depth_mm));
  TROCAR_TRY_STATUS(take("--frequency-mhz", a.frequency_mhz, transducer.lowest_mhz, transducer.highest_mhz, "MHz",
                         acquisition.frequency_mhz));
  acquisition.is_harmonic = a.is_harmonic.value_or(acquisition.is_harmonic);
  if (acquisition.is_harmonic) TROCAR_TRY_STATUS(tune_harmonic(transducer, acquisition));
  acquisition.focus_mm = std::min(acquisition.focus_mm, kDeepestFocus * acquisition.depth_mm);
  TROCAR_TRY_STATUS(
      take("--focus-mm", a.focus_mm, kLeastFocus_mm, transducer.greatest_depth_mm, "mm", acquisition.focus_mm));
  acquisition.lines = a.lines.value_or(acquisition.lines);
  acquisition.samples = a.samples.value_or(acquisition.samples);
  acquisition.steering_angles = a.steering_angles.value_or(acquisition.steering_angles);
  acquisition.planes = a.planes.value_or(acquisition.planes);
  if (acquisition.planes % 2 == 0)
    return fail_usage("--planes must be odd", fmt::format("{}", acquisition.planes), "give 1, 3, 5, 7 or 9");
  for (const std::string& name : a.off) TROCAR_TRY_STATUS(ultrasound::switch_off(acquisition.artefacts, name));
  return acquisition;
}

Result<ultrasound::DisplaySettings> gather_display(const ScanArguments& a) {
  ultrasound::DisplaySettings display = a.display;
  if (!a.gray_map.empty()) {
    TROCAR_TRY(display.gray_map, ultrasound::parse_gray_map(a.gray_map));
  }
  if (!a.tgc_db.empty()) {
    if (a.tgc_db.size() != display.tgc_db.size())
      return fail_usage(fmt::format("--tgc has {} numbers", a.tgc_db.size()),
                        fmt::format("{}", fmt::join(a.tgc_db, ",")), "give eight, from near to far");
    std::copy(a.tgc_db.begin(), a.tgc_db.end(), display.tgc_db.begin());
  }
  TROCAR_TRY_STATUS(check(display));
  return display;
}

/// Finds a view by its name before a patient is opened.
Result<std::optional<ultrasound::ProbeView>> find_view(const std::vector<ultrasound::ProbeView>& views,
                                                       const std::string& name) {
  if (name.empty()) return std::nullopt;
  const auto found =
      std::find_if(views.begin(), views.end(), [&](const ultrasound::ProbeView& view) { return view.name == name; });
  if (found != views.end()) return *found;
  TROCAR_TRY(ultrasound::ProbeView unknown, ultrasound::choose_view(anatomy::VirtualPatient{}, views, name));
  return unknown;
}

}  // namespace

void add_scan_options(Command& command, ScanArguments& a) {
  command.add_option("--patient", a.source.folder_or_name, "Patient folder, or an embedded patient's name").required();
  command.add_option("--patient-seed", a.source.seed, "Seed of an embedded patient").seed().show_default();
  add_cache_option(command, a.source);
  Option pose = command.add_option("--pose", a.pose, "X_PT: transform from the transducer to the patient (.tfm)");
  Option view =
      command.add_option("--view", a.view, "Place the transducer in a standard view: trocar ultrasound views");
  pose.excludes(view);
  command.add_option(
      "--save-pose", a.save_pose,
      "Write X_PT as a .tfm, with transducer, depth, frequency, focus and harmonic as comments that --pose reads");
  command.add_option("--transducer", a.transducer,
                     "Transducer, see trocar ultrasound transducers; default: that of the view, or a suitable one");
  command.add_option("--depth-mm", a.depth_mm, "Image depth below the face")
      .number_within(kLeastDepth_mm, kMostDepth_mm, "mm");
  command.add_option("--frequency-mhz", a.frequency_mhz, "Transmit frequency, within the transducer's band")
      .number_within(0.5, 50.0, "MHz");
  command.add_flag("--harmonic,!--no-harmonic", a.is_harmonic,
                   "Tissue harmonic imaging: transmit half of the frequency and receive the second harmonic");
  command.add_option("--focus-mm", a.focus_mm, "Depth of the transmit focus")
      .number_within(kLeastFocus_mm, kMostDepth_mm, "mm");
  command.add_option("--gain-db", a.display.gain_db, "Gain").number_within(-40.0, 40.0, "dB").show_default();
  command.add_option("--tgc", a.tgc_db, "Eight TGC sliders from near to far, as 0,0,0,0,0,0,0,0")
      .number_within(-20.0, 20.0, "dB")
      .separated_by(',')
      .one_value_each();
  command.add_option("--dynamic-range-db", a.display.dynamic_range_db, "Dynamic range")
      .number_within(20.0, 100.0, "dB")
      .show_default();
  command.add_option("--gray-map", a.gray_map, "linear, soft or high-contrast; soft when left out");
  command.add_option("--lines", a.lines, "Number of scanlines").whole_number_within(2, 1024);
  command.add_option("--samples", a.samples, "Samples per scanline; 1024 when left out").whole_number_within(16, 4096);
  command.add_option("--planes", a.planes, "Number of elevation planes, an odd number; 5 when left out")
      .whole_number_within(1, 9);
  command
      .add_option("--looks", a.steering_angles, "Number of compounding angles; 3 when left out, 1 gives full speckle")
      .whole_number_within(1, 5);
  command
      .add_option(
          "--off", a.off,
          fmt::format("Artefacts to switch off, with commas: {}, all", fmt::join(ultrasound::artefact_names(), ", ")))
      .separated_by(',')
      .one_value_each();
  command.add_option("--seed", a.seed, "Random seed of the receiver noise").seed().show_default();
}

Result<Scan> prepare_scan(const ScanArguments& a, const std::string& default_transducer, const Progress& progress) {
  if (a.pose.empty() && a.view.empty())
    return fail_usage("the transducer has no position", "--pose, --view", "give --pose FILE.tfm or --view NAME");
  Scan scan;
  TROCAR_TRY(const fs::path views_file, find_data("views.toml"));
  TROCAR_TRY(const auto views, ultrasound::load_probe_views(views_file));
  TROCAR_TRY(scan.view, find_view(views, a.view));
  io::TransformNotes notes;
  if (!a.pose.empty()) {
    TROCAR_TRY(scan.X_PT, io::read_transform(a.pose));
    TROCAR_TRY(notes, io::read_transform_notes(a.pose));
  }
  std::string fitting = default_transducer;
  if (fitting.empty() && scan.view) fitting = scan.view->transducer;
  if (fitting.empty() && notes.contains(kTransducerNote)) fitting = notes.at(kTransducerNote);
  const std::string& name = !a.transducer.empty() ? a.transducer : fitting.empty() ? std::string("C5-2") : fitting;
  TROCAR_TRY(const fs::path transducers_file, find_data("transducers.toml"));
  TROCAR_TRY(scan.transducer, ultrasound::load_transducer(transducers_file, name));
  TROCAR_TRY(scan.acquisition, gather_acquisition(a, scan.transducer, scan.view, notes));
  TROCAR_TRY(scan.display, gather_display(a));
  TROCAR_TRY(const fs::path acoustics_file, find_data("acoustics.toml"));
  TROCAR_TRY(ultrasound::AcousticTable table, ultrasound::load_acoustic_table(acoustics_file));

  TROCAR_TRY(const anatomy::VirtualPatient patient, io::open_patient(a.source, progress));
  scan.patient_name = patient.name;
  scan.motion = patient.motion;
  TROCAR_TRY(scan.breathing, cases::breathing_of(patient, a.breathing, a.phase));
  if (scan.view) {
    TROCAR_TRY(scan.view, ultrasound::choose_view(patient, views, a.view));
    core::report(progress, "searching the pose of the transducer", 0.0);
    TROCAR_TRY(const ultrasound::ProbePlacement placed, ultrasound::place_probe(patient, *scan.view, scan.transducer));
    scan.X_PT = placed.X_PT;
    scan.visibility = placed.visibility;
  }
  TROCAR_TRY(scan.scene, ultrasound::make_acoustic_scene(patient, std::move(table), {}, progress));
  const ultrasound::Acquisition& a_scan = scan.acquisition;
  scan.unscanned_share =
      unscanned_share(scan.scene->ends, scan.X_PT,
                      ultrasound::make_scan_geometry(scan.transducer, a_scan.depth_mm, a_scan.lines, a_scan.samples));
  if (a.needs_flow) {
    TROCAR_TRY(const fs::path flow_file, find_data("flow.toml"));
    TROCAR_TRY(ultrasound::FlowTable flow_table, ultrasound::load_flow_table(flow_file));
    TROCAR_TRY(scan.flow, ultrasound::make_vessel_flow(patient, std::move(flow_table), {}, progress));
  }
  return scan;
}

Status check_outputs(const std::vector<std::string>& outputs) {
  std::set<fs::path> paths;
  for (const std::string& out : outputs) {
    if (out.empty()) continue;
    TROCAR_TRY_STATUS(check_new(out));
    std::error_code ignored;
    const fs::path path = fs::absolute(out, ignored).lexically_normal();
    if (!fs::is_directory(path.parent_path(), ignored))
      return fail("the output folder does not exist", path.parent_path().string(), "create it first");
    if (!paths.insert(path).second)
      return fail_usage("two outputs have the same name", out, "give each output its own name");
  }
  return {};
}

void warn_of_contact(double coupled) {
  constexpr double kHardlyAny = 0.02;
  constexpr double kMost = 0.75;
  if (coupled < kHardlyAny) {
    print_warning("the transducer does not touch the skin: the image shows only air");
  } else if (coupled < kMost) {
    print_warning(fmt::format("only {:.0f} % of the transducer face touches the skin", 100.0 * coupled));
  }
}

void warn_of_visibility(const Scan& scan) {
  if (scan.view && scan.visibility && scan.visibility->visible < ultrasound::kEnoughVisible)
    print_warning(fmt::format(
        "view \"{}\": only {:.0f} % of the subject is visible ({}): select another view, or set the pose with --pose",
        scan.view->name, 100.0 * scan.visibility->visible, ultrasound::hidden_causes(*scan.visibility)));
  if (scan.unscanned_share > kWorthSaying)
    print_warning(fmt::format(
        "{:.0f} % of the image is outside the CT (hatched) and has no echoes: use a larger CT or another view",
        100.0 * scan.unscanned_share));
}

Status save_pose(const Scan& scan, const std::string& path) {
  const ultrasound::Acquisition& a = scan.acquisition;
  return io::write_transform(scan.X_PT, path,
                             {{kTransducerNote, scan.transducer.name},
                              {kDepthNote, fmt::format("{}", a.depth_mm)},
                              {kFrequencyNote, fmt::format("{}", a.frequency_mhz)},
                              {kFocusNote, fmt::format("{}", a.focus_mm)},
                              {kHarmonicNote, a.is_harmonic ? "1" : "0"}});
}

config::Json to_json(const Pose& X) {
  config::Json rows = config::Json::array();
  for (int row = 0; row < 3; ++row) rows.push_back({X.R()(row, 0), X.R()(row, 1), X.R()(row, 2), X.p()[row]});
  rows.push_back({0.0, 0.0, 0.0, 1.0});
  return rows;
}

config::Json to_json(const Scan& scan) {
  const ultrasound::Acquisition& a = scan.acquisition;
  return {{"patient", scan.patient_name},
          {"transducer", scan.transducer.name},
          {"view", scan.view ? config::Json(scan.view->name) : config::Json(nullptr)},
          {"visible", scan.visibility ? config::Json(scan.visibility->visible) : config::Json(nullptr)},
          {"outside_ct", scan.unscanned_share},
          {"X_PT", to_json(scan.X_PT)},
          {"depth_mm", a.depth_mm},
          {"frequency_mhz", a.frequency_mhz},
          {"focus_mm", a.focus_mm},
          {"harmonic", a.is_harmonic},
          {"lines", a.lines},
          {"samples", a.samples},
          {"planes", a.planes},
          {"looks", a.steering_angles}};
}

}  // namespace trocar::cli
