#include "xray_arguments.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "core/files/data_dir.h"
#include "number_option.h"
#include "xray/geometry/c_arm_presets.h"

namespace trocar::cli {
namespace {

constexpr double kMost_ml = 200.0;
constexpr double kFarthest_mm = 2000.0;

/// Two numbers, "30,-10".
Result<std::array<double, 2>> parse_pair(const char* option, const std::string& text) {
  std::array<double, 2> pair{};
  int read = 0;
  const bool is_read = std::sscanf(text.c_str(), "%lf,%lf%n", &pair[0], &pair[1], &read) == 2 &&
                       static_cast<std::size_t>(read) == text.size();
  if (is_read && std::isfinite(pair[0]) && std::isfinite(pair[1])) return pair;
  return fail_usage(fmt::format("{} is not two numbers with a comma between", option), text, "write it as 30,-10");
}

Result<Vec3> parse_place(const char* option, const std::string& text) {
  Vec3 p;
  int read = 0;
  const bool is_read = std::sscanf(text.c_str(), "%lf,%lf,%lf%n", &p.x(), &p.y(), &p.z(), &read) == 3 &&
                       static_cast<std::size_t>(read) == text.size();
  if (is_read && p.allFinite() && p.norm() < kFarthest_mm) return p;
  return fail_usage(fmt::format("{} is not a place x,y,z in mm (LPS), within 2 m", option), text,
                    "write it as -41,-12.5,25");
}

}  // namespace

void add_xray_options(CLI::App& command, XrayArguments& a) {
  command.add_option("--patient", a.source.folder_or_name, "Patient folder, or an embedded patient's name")->required();
  arguments::seed_number(command.add_option("--patient-seed", a.source.seed, "Seed of an embedded patient"))
      ->capture_default_str();
  command.add_option("--carm", a.carm, "LAO,CRAN in degrees; RAO and caudal are negative")->capture_default_str();
  command.add_option("--at", a.at,
                     "Middle of the image, x,y,z (mm, LPS); without it: the needle's tip, the injection or the body");
  command.add_option("--unit", a.unit, "X-ray unit of data/carms.toml")->capture_default_str();
  arguments::number_within(
      command.add_option("--field", a.field_mm, "Edge of the field; without it the unit's largest"), 50.0, 500.0, "mm");
  arguments::whole_number_within(command.add_option("--pixels", a.pixels, "Pixels along each edge"), 16, 2048)
      ->capture_default_str();
  command.add_option("--collimate", a.collimate, "Irradiated share of width and height, 0.05 to 1")
      ->capture_default_str();
  command.add_option("--dose", a.dose, "Dose at the detector")
      ->check(CLI::IsMember({"low", "normal", "high"}))
      ->capture_default_str();
  command.add_option("--needle", a.needle,
                     "X_PN: transform from the needle (tip at 0, +z towards the tip) to the patient (.tfm)");
  arguments::number_within(command.add_option("--needle-diameter", a.needle_mm, "Outer diameter of the needle"), 0.2,
                           5.0, "mm")
      ->capture_default_str();
  command.add_option("--contrast", a.contrast, "Contrast agent, ML@x,y,z: volume (ml) and place of the tip (mm, LPS)");
  arguments::number_within(command.add_option("--rate", a.rate_ml_per_s, "Rate of the injection"), 0.05, 20.0, "ml/s")
      ->capture_default_str();
  arguments::number_within(
      command.add_option("--time", a.time_s, "Time since the injection began; without it: when it ends"), 0.0, 3600.0,
      "s");
  arguments::whole_number_within(command.add_option("--frames", a.frames, "Images over that time, as one .dcm"), 1,
                                 1000)
      ->capture_default_str();
  command.add_flag("--subtract", a.is_subtracted, "Digital subtraction: only what the contrast agent adds");
  command.add_flag("--inverted", a.is_inverted, "Bones white, as in a radiograph");
  arguments::seed_number(command.add_option("--seed", a.seed, "Seed of the noise"))->capture_default_str();
  command.add_option("--out", a.out, "Output: .png, .nrrd (attenuation -ln of the signal) or .dcm (DICOM XA)")
      ->required();
  command.add_flag("--json", a.is_json, "Print one JSON object");
}

Result<std::optional<Injection>> parse_injection(const std::string& text, double ml_per_s) {
  if (text.empty()) return std::optional<Injection>();
  Injection injection;
  int read = 0;
  if (std::sscanf(text.c_str(), "%lf@%n", &injection.ml, &read) != 1 || read == 0 || !std::isfinite(injection.ml))
    return fail_usage("--contrast is not ML@x,y,z", text, "write it as 10@-36.8,-62.9,16.1");
  if (injection.ml <= 0.0 || injection.ml > kMost_ml)
    return fail_usage(fmt::format("--contrast is not from 0 to {} ml", kMost_ml), text, "give the volume of a syringe");
  TROCAR_TRY(injection.place_P, parse_place("--contrast", text.substr(static_cast<std::size_t>(read))));
  injection.ml_per_s = ml_per_s;
  return std::optional<Injection>(injection);
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
  request.filters = {unit.kv, unit.aluminium_mm, unit.copper_mm};
  request.dose_mode = a.dose == "low"    ? xray::DoseMode::kLow
                      : a.dose == "high" ? xray::DoseMode::kHigh
                                         : xray::DoseMode::kNormal;
  if (a.is_subtracted) request.mode = xray::ImageMode::kSubtraction;
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
