#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/action.h"
#include "io/patient/patient_folder.h"
#include "xray/fluoroscopy/fluoroscope.h"

namespace trocar::cli {

/// Arguments of `trocar xray`, as written.
struct XrayArguments {
  io::PatientSource source;
  std::string breathing;  ///< As the next one for cases::breathing_of().
  std::optional<double> phase;
  std::string unit = "angiography";
  std::string carm = "0,0";
  std::string at;  ///< Empty: the needle's tip, the injection, the target of the patient's task, or the body's centre.
  double field_mm = 0.0;  ///< 0: the unit's largest.
  int pixels = 512;
  std::string collimate = "1,1";
  std::string dose = "normal";
  std::string needle;
  double needle_mm = 0.7;  ///< Outer diameter: 22 gauge.
  std::string tools;       ///< .mrk.json
  std::string contrast;
  double rate_ml_per_s = 1.0;
  double time_s = -1.0;  ///< Below 0: when the injection ends.
  int frames = 1;
  bool is_subtracted = false, is_inverted = false, is_json = false;
  std::uint64_t seed = 1;
  std::string out;
};

/// ML@x,y,z of --contrast.
struct Injection {
  double ml = 0.0, ml_per_s = 1.0;
  Vec3 place_P = Vec3::Zero();
};

void add_xray_options(Command& command, XrayArguments& a);
/// Empty without a text. Usage errors (exit status 2): not ML@x,y,z, a volume that is not above 0 and up to 200 ml.
Result<std::optional<Injection>> parse_injection(const std::string& text, double ml_per_s);
/// Guide wires, catheters and markers of --tools; none without a file. Errors: the file's; a name that is no tool of
/// data/xray_tools.toml.
Result<std::vector<xray::ToolShape>> read_tools(const std::string& file);
/// C-arm, exposure and display; the isocentre is --at, or 0. Usage errors: an unknown unit, angles or a field that it
/// does not have.
Result<xray::FluoroscopyRequest> parse_request(const XrayArguments& a);
/// The ending, and --frames with it.
Status check_xray_output(const XrayArguments& a);

}  // namespace trocar::cli
