// Force along one needle path for each force model: on the layered patients, or on any patient with its own path.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "bench/benchmarks.h"
#include "bench/haptics/curve_output.h"
#include "cases/scene_request.h"
#include "core/files/folders.h"
#include "core/files/output_file.h"
#include "phantom/phantom.h"
#include "tasks/needle.h"

namespace trocar::bench {
namespace {

constexpr double kCurveSpeed_mm_per_s = 5.0;
constexpr double kAfter_mm = 10.0;  ///< Maximum time for the tip to arrive.

/// A patient and its needles: the usual one, and others for comparison.
struct Way {
  std::string patient;
  std::vector<std::string> needles;
};
constexpr const char* kOtherNeedle = "chiba-22g";
const std::vector<Way>& layered_ways() {
  static const std::vector<Way> ways{{"layers-lumbar", {"quincke-22g", "tuohy-18g"}},
                                     {"layers-ascites", {"paracentesis-14g"}},
                                     {"layers-liver", {kOtherNeedle, "biopsy-18g"}}};
  return ways;
}

bool is_embedded(const std::string& name) {
  return phantom::find_embedded_patient(name).has_value();
}

/// "layers-lumbar" -> "lumbar"; of other names, only characters valid in file names are kept.
std::string short_name(std::string name) {
  constexpr std::string_view kLayers = "layers-";
  if (name.starts_with(kLayers)) name.erase(0, kLayers.size());
  for (char& c : name) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-';
    if (!is_plain) c = '_';
  }
  return name;
}

std::vector<std::string> needles_for(const std::string& patient) {
  for (const Way& way : layered_ways())
    if (way.patient == patient) return way.needles;
  return {kOtherNeedle};
}

struct Tables {
  anatomy::TissueTable tissues;
  std::vector<tasks::Needle> needles;
};

Result<Tables> load_tables_of_curves() {
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  Tables tables;
  TROCAR_TRY(tables.tissues, anatomy::load_tissue_table(data / "tissues.toml"));
  TROCAR_TRY(tables.needles, tasks::load_needles(data / "needles.toml"));
  return tables;
}

Result<PathCurves> curves_of(std::shared_ptr<const anatomy::VirtualPatient> patient, const std::string& needle_name,
                             bool is_usual_needle, const Tables& tables, const Options& options,
                             double speed_mm_per_s = kCurveSpeed_mm_per_s) {
  if (patient->paths.empty())
    return fail_usage("the patient has no needle path of its own", patient->name, "use an embedded patient");
  const auto needle = std::find_if(tables.needles.begin(), tables.needles.end(),
                                   [&](const tasks::Needle& candidate) { return candidate.name == needle_name; });
  if (needle == tables.needles.end())
    return fail("there is no needle of that name", needle_name, "use a needle of data/needles.toml");

  cases::PrescribedMotion motion;
  motion.line_P = patient->paths.front().line_P;
  motion.speed_mm_per_s = speed_mm_per_s;
  motion.after_mm = kAfter_mm;
  const Segment with_rest{motion.line_P.a, motion.line_P.b + kAfter_mm * motion.line_P.direction()};
  PathCurves path;
  path.name = short_name(patient->name);
  if (!is_usual_needle) path.name += "-" + needle_name;
  path.title = fmt::format("{}, {}, {:.0f} mm/s", patient->name, needle_name, speed_mm_per_s);
  for (const haptics::ForceModel model : kForceModels) {
    if (options.force_model && *options.force_model != model) continue;
    haptics::HapticOptions haptic;
    haptic.force_model = model;
    haptic.has_weight_compensation = false;
    const haptics::NeedleGeometry geometry = cases::needle_geometry(*needle);
    TROCAR_TRY(const auto scene, haptics::make_haptic_scene(patient, tables.tissues, geometry, {}, haptic));
    if (path.pieces.empty()) path.pieces = cases::pieces_along(*scene, tables.tissues, with_rest);
    NamedCurve curve{to_string(model), cases::force_curve(*scene, motion), {}};
    curve.events = cases::find_curve_events(curve.points, tables.tissues);
    path.curves.push_back(std::move(curve));
  }
  return path;
}

/// Borders without a wall at which the force has a peak: where the needle's tip is at the peak.
void add_borders(std::vector<CaseResult>& results, const PathCurves& path) {
  for (const NamedCurve& curve : path.curves)
    for (const cases::CurveBorder& border : cases::find_curve_borders(curve.points, path.pieces))
      results.push_back({fmt::format("curves/{}/{}/border-of-{}", path.name, curve.name, border.name),
                         "mm",
                         figure_of(border.tip_mm - border.at_mm),
                         {},
                         fmt::format("tip behind the border at its peak of {:.2f} N", border.peak_n),
                         {{"peak_n", border.peak_n}}});
}

/// One line per puncture, in order; repeated punctures are numbered. In JSON, drop and drop time are separate cases; in
/// text they are in the note.
void add_cases(std::vector<CaseResult>& results, const PathCurves& path, bool is_for_people) {
  for (const NamedCurve& curve : path.curves) {
    std::map<std::string, int> times;
    for (const cases::CurveEvent& event : curve.events) {
      const int number = ++times[event.layer];
      std::string name = fmt::format("curves/{}/{}/{}", path.name, curve.name, event.layer);
      if (number > 1) name += fmt::format("-{}", number);
      constexpr double kRise_n = 0.05;
      std::string note =
          fmt::format("peak, device {:.1f} mm deep; then {:.2f} N: {:.2f} N less, nine tenths of it in {:.0f} ms",
                      event.way_mm, event.after_n, event.drop_n(), event.fall_ms);
      if (event.highest_n > event.peak_n + kRise_n) note += fmt::format("; ROSE to {:.2f} N first", event.highest_n);
      results.push_back({name, "n", figure_of(event.peak_n), {}, note});
      if (is_for_people) continue;
      results.push_back({name + "/drop", "n", figure_of(event.drop_n()), {}, ""});
      results.push_back({name + "/fall", "ms", event.drop_n() > 0.0 ? figure_of(event.fall_ms) : Figures{}, {}, ""});
      results.push_back({name + "/way", "mm", figure_of(event.way_mm), {}, "of the device past the resting skin"});
    }
  }
}

Result<std::vector<std::shared_ptr<const anatomy::VirtualPatient>>> patients_of(const Options& options) {
  std::vector<std::shared_ptr<const anatomy::VirtualPatient>> patients;
  if (options.patient) return std::vector{options.patient};
  for (const Way& way : layered_ways()) {
    if (!is_embedded(way.patient)) continue;
    TROCAR_TRY(anatomy::VirtualPatient generated, phantom::generate_phantom(way.patient, 1, {}, options.progress));
    patients.push_back(std::make_shared<const anatomy::VirtualPatient>(std::move(generated)));
  }
  if (!patients.empty()) return patients;
  TROCAR_TRY(anatomy::VirtualPatient generated, phantom::generate_phantom("abdomen", 1, {}, options.progress));
  patients.push_back(std::make_shared<const anatomy::VirtualPatient>(std::move(generated)));
  return patients;
}

Status write_all(const std::vector<PathCurves>& paths, const anatomy::TissueTable& tissues,
                 const std::filesystem::path& out) {
  return write_folder_atomically(out, [&](const std::filesystem::path& folder) -> Status {
    for (const PathCurves& path : paths) TROCAR_TRY_STATUS(write_curves(path, tissues, folder));
    return {};
  });
}

/// Peak of each layer at one speed, by "PATH/MODEL/LAYER".
using Peaks = std::map<std::string, double>;

Result<Peaks> peaks_at(const std::vector<std::shared_ptr<const anatomy::VirtualPatient>>& patients,
                       const Tables& tables, const Options& options, double speed_mm_per_s) {
  Peaks peaks;
  for (const auto& patient : patients) {
    const std::vector<std::string> needles = needles_for(patient->name);
    for (const std::string& needle : needles) {
      TROCAR_TRY(const PathCurves path,
                 curves_of(patient, needle, needle == needles.front(), tables, options, speed_mm_per_s));
      for (const NamedCurve& curve : path.curves)
        for (const cases::CurveEvent& event : curve.events)
          peaks.emplace(fmt::format("{}/{}/{}", path.name, curve.name, event.layer), event.peak_n);
    }
  }
  return peaks;
}

}  // namespace

Result<std::vector<CaseResult>> run_speeds_benchmark(const Options& options) {
  constexpr std::array kSpeeds_mm_per_s{1.0, 5.0, 10.0, 20.0, 50.0};
  constexpr double kMostRatio = 1.5;
  TROCAR_TRY(const Tables tables, load_tables_of_curves());
  TROCAR_TRY(const auto patients, patients_of(options));
  std::vector<Peaks> of_speed;
  for (const double speed : kSpeeds_mm_per_s) {
    TROCAR_TRY(Peaks peaks, peaks_at(patients, tables, options, speed));
    of_speed.push_back(std::move(peaks));
  }
  std::vector<CaseResult> results;
  for (const auto& [name, slowest_n] : of_speed.front()) {
    CaseResult result{"speeds/" + name, "ratio", {}, {}, "peak"};
    for (std::size_t i = 0; i < of_speed.size(); ++i) {
      const auto found = of_speed[i].find(name);
      result.note +=
          found != of_speed[i].end()
              ? fmt::format("{} {:.2f} N at {:.0f} mm/s", i > 0 ? "," : "", found->second, kSpeeds_mm_per_s[i])
              : fmt::format("{} none at {:.0f} mm/s", i > 0 ? "," : "", kSpeeds_mm_per_s[i]);
      if (found != of_speed[i].end()) result.figures = figure_of(found->second / slowest_n);  // of the fastest
    }
    result.is_missed = of_speed.back().contains(name) && of_speed.back().at(name) > kMostRatio * slowest_n;
    results.push_back(std::move(result));
  }
  return results;
}

Result<std::vector<CaseResult>> run_curves_benchmark(const Options& options) {
  TROCAR_TRY(const Tables tables, load_tables_of_curves());
  TROCAR_TRY(const auto patients, patients_of(options));
  std::vector<PathCurves> paths;
  for (const auto& patient : patients) {
    const std::vector<std::string> needles = needles_for(patient->name);
    for (const std::string& needle : needles) {
      TROCAR_TRY(PathCurves path, curves_of(patient, needle, needle == needles.front(), tables, options));
      paths.push_back(std::move(path));
    }
  }
  std::vector<CaseResult> results;
  for (const PathCurves& path : paths) {
    if (options.print && options.out.empty()) options.print(curves_text(path));
    add_cases(results, path, static_cast<bool>(options.print));
    add_borders(results, path);
  }
  if (!options.out.empty()) TROCAR_TRY_STATUS(write_all(paths, tables.tissues, options.out));
  return results;
}

}  // namespace trocar::bench
