#include "cli/xray/arguments.h"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <string_view>
#include <vector>

#include "cli/breathing_option.h"
#include "core/files/folders.h"
#include "core/text.h"
#include "io/markups_file.h"
#include "xray/geometry/c_arm.h"
#include "xray/tools/tool_shape.h"

namespace trocar::cli {
namespace {

constexpr double kMost_ml = 200.0;
constexpr double kFarthest_mm = 2000.0;

/// "30,-10": `count` finite decimal numbers with commas between; empty if the text is anything else.
std::optional<std::vector<double>> parse_numbers(std::string_view text, std::size_t count) {
  std::vector<double> numbers;
  for (std::size_t n = 0; n < count; ++n) {
    if (n > 0) {
      if (!text.starts_with(',')) return std::nullopt;
      text.remove_prefix(1);
    }
    const auto number = find_leading_number<double>(text);
    if (!number) return std::nullopt;
    numbers.push_back(number->value);
    text = number->rest;
  }
  if (!text.empty()) return std::nullopt;
  return numbers;
}

Result<std::array<double, 2>> parse_pair(const char* option, const std::string& text) {
  if (const auto pair = parse_numbers(text, 2)) return std::array{(*pair)[0], (*pair)[1]};
  return fail_usage(fmt::format("{} is not two numbers with a comma between", option), text, "write it as 30,-10");
}

Result<Vec3> parse_place(const char* option, const std::string& text) {
  if (const auto numbers = parse_numbers(text, 3)) {
    const Vec3 p((*numbers)[0], (*numbers)[1], (*numbers)[2]);
    if (p.norm() < kFarthest_mm) return p;
  }
  return fail_usage(fmt::format("{} is not a place x,y,z in mm (LPS), within 2 m", option), text,
                    "write it as -41,-12.5,25");
}

/// Angles and field that the unit has.
Status check_reach(const XrayArguments& a, const xray::CArmPreset& unit, const xray::CArm& arm) {
  const double lao_deg = unit.largest_lao_deg, cranial_deg = unit.largest_cranial_deg;
  if (std::abs(arm.lao_deg) > lao_deg || std::abs(arm.cranial_deg) > cranial_deg)
    return fail_usage(fmt::format("--carm is beyond the reach of the unit \"{}\"", unit.name), a.carm,
                      fmt::format("LAO or RAO to {:g}, cranial or caudal to {:g} degrees", lao_deg, cranial_deg));
  if (arm.field_mm > unit.arm.field_mm)
    return fail_usage(fmt::format("--field is larger than that of the unit \"{}\"", unit.name),
                      fmt::format("{:g} mm", arm.field_mm), fmt::format("at most {:g} mm", unit.arm.field_mm));
  return {};
}

}  // namespace

void add_xray_options(Command& command, XrayArguments& a) {
  command.add_option("--patient", a.source.folder_or_name, "Patient folder, or an embedded patient's name").required();
  command.add_option("--patient-seed", a.source.seed, "Seed of an embedded patient").seed().show_default();
  add_breathing_options(command, a.breathing, a.phase);
  command.add_option("--carm", a.carm, "LAO,CRAN in degrees; RAO and caudal are negative").show_default();
  command.add_option(
      "--at", a.at,
      "Middle of the image, x,y,z (mm, LPS); without it: the needle's tip, the injection, the target of the patient's "
      "task (its first expert path), or the centre of the body");
  command.add_option("--unit", a.unit, "X-ray unit of data/carms.toml").show_default();
  command.add_option("--field", a.field_mm, "Edge of the field; without it the unit's largest")
      .number_within(50.0, 500.0, "mm");
  command.add_option("--pixels", a.pixels, "Pixels along each edge").whole_number_within(16, 2048).show_default();
  command.add_option("--collimate", a.collimate, "Irradiated share of width and height, 0.05 to 1").show_default();
  command.add_option("--dose", a.dose, "Dose at the detector; --subtract takes that of acquisitions")
      .one_of({"low", "normal", "high"})
      .show_default();
  const Option needle = command.add_option(
      "--needle", a.needle, "X_PN: transform from the needle (tip at 0, +z towards the tip) to the patient (.tfm)");
  command.add_option("--needle-diameter", a.needle_mm, "Outer diameter of the needle")
      .number_within(0.2, 5.0, "mm")
      .needs(needle)
      .show_default();
  command.add_option(
      "--tools", a.tools,
      "Guide wire, catheter, markers: curves and point lists of 3D Slicer (.mrk.json), each named after a "
      "tool of data/xray_tools.toml");
  const Option contrast = command.add_option("--contrast", a.contrast,
                                             "Contrast agent, ML@x,y,z: volume (ml) and place of the tip (mm, LPS)");
  command.add_option("--rate", a.rate_ml_per_s, "Rate of the injection")
      .number_within(0.05, 20.0, "ml/s")
      .needs(contrast)
      .show_default();
  command.add_option("--time", a.time_s, "Time since the injection began; without it: when it ends")
      .number_within(0.0, 3600.0, "s")
      .needs(contrast);
  command.add_option("--frames", a.frames, "Images over that time, as one .dcm")
      .whole_number_within(1, 1000)
      .show_default();
  command.add_flag("--subtract", a.is_subtracted, "Digital subtraction: only what the contrast agent adds")
      .needs(contrast);
  command.add_flag("--inverted", a.is_inverted, "Bones white, as in a radiograph");
  command.add_option("--seed", a.seed, "Seed of the noise").seed().show_default();
  command.add_option("--out", a.out, "Output: .png, .nrrd (attenuation -ln of the signal) or .dcm (DICOM XA)")
      .required();
  command.add_flag("--json", a.is_json, "Print one JSON object");
}

Result<std::optional<Injection>> parse_injection(const std::string& text, double ml_per_s) {
  if (text.empty()) return std::optional<Injection>();
  Injection injection;
  const auto ml = find_leading_number<double>(text);
  if (!ml || !ml->rest.starts_with('@'))
    return fail_usage("--contrast is not ML@x,y,z", text, "write it as 10@-36.8,-62.9,16.1");
  injection.ml = ml->value;
  if (injection.ml <= 0.0 || injection.ml > kMost_ml)
    return fail_usage("--contrast has a volume that cannot be injected", text,
                      fmt::format("give more than 0 and at most {:g} ml", kMost_ml));
  TROCAR_TRY(injection.place_P, parse_place("--contrast", std::string(ml->rest.substr(1))));
  injection.ml_per_s = ml_per_s;
  return std::optional<Injection>(injection);
}

Result<std::vector<xray::ToolShape>> read_tools(const std::string& file) {
  std::vector<xray::ToolShape> tools;
  if (file.empty()) return tools;
  TROCAR_TRY(const std::vector<io::MarkupPoints> markups, io::read_markup_points(file));
  for (const io::MarkupPoints& drawn : markups) {
    TROCAR_TRY(const xray::ToolKind kind, xray::load_tool_kind(data_dir() / "xray_tools.toml", drawn.name));
    if (!drawn.is_list) {
      tools.push_back(xray::tool_along(kind, drawn.points_P));
      continue;
    }
    for (const Vec3& p_P : drawn.points_P) tools.push_back(xray::tool_along(kind, {&p_P, 1}));
  }
  return tools;
}

Result<xray::FluoroscopyRequest> parse_request(const XrayArguments& a) {
  TROCAR_TRY(const xray::CArmPreset unit, xray::load_c_arm(data_dir() / "carms.toml", a.unit));
  xray::FluoroscopyRequest request;
  request.arm = unit.arm;
  TROCAR_TRY(const auto angles, parse_pair("--carm", a.carm));
  request.arm.lao_deg = angles[0];
  request.arm.cranial_deg = angles[1];
  if (!a.at.empty()) {
    TROCAR_TRY(request.arm.isocentre_P, parse_place("--at", a.at));
  }
  if (a.field_mm > 0.0) request.arm.field_mm = a.field_mm;
  request.arm.pixels = a.pixels;
  TROCAR_TRY(request.arm.collimation, parse_pair("--collimate", a.collimate));
  TROCAR_TRY_STATUS(xray::check_c_arm(request.arm));
  TROCAR_TRY_STATUS(check_reach(a, unit, request.arm));
  request.filters = {unit.kv, unit.aluminium_mm, unit.copper_mm};
  request.dose_mode = a.dose == "low"    ? xray::DoseMode::kLow
                      : a.dose == "high" ? xray::DoseMode::kHigh
                                         : xray::DoseMode::kNormal;
  if (a.is_subtracted) {  // at the dose of fluoroscopy it is mostly noise
    request.mode = xray::ImageMode::kSubtraction;
    request.dose_mode = xray::DoseMode::kAcquisition;
  }
  request.display.is_inverted = a.is_inverted;
  return request;
}

Status check_xray_output(const XrayArguments& a) {
  const std::string ending = std::filesystem::path(a.out).extension().string();
  if (ending != ".png" && ending != ".nrrd" && ending != ".dcm")
    return fail_usage("the file name must end in .png, .nrrd or .dcm", a.out, "rename the output");
  if (a.frames > 1 && ending != ".dcm")
    return fail_usage("only a .dcm holds several images", a.out, "write a .dcm, or omit --frames");
  if (a.is_subtracted && ending == ".nrrd")
    return fail_usage("a subtraction cannot be written as .nrrd", a.out, "write a .png, or omit --subtract");
  return {};
}

}  // namespace trocar::cli
