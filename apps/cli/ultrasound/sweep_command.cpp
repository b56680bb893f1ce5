// trocar ultrasound sweep: a volume of a mechanical 3D transducer, or a tracked freehand sweep.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <filesystem>

#include "cli/commands.h"
#include "cli/ultrasound/scan.h"
#include "config/json.h"
#include "io/image/image_file.h"
#include "io/sequence/sequence_file.h"
#include "io/sequence/transform_file.h"
#include "ultrasound/sweep/freehand_sweep.h"
#include "ultrasound/sweep/mechanical_sweep.h"

namespace trocar::cli {
namespace {
namespace fs = std::filesystem;

struct SweepArguments {
  ScanArguments scan;
  std::string out, tracked;
  double angle_deg = 0.0;  ///< 0: that of the transducer; freehand: translation only.
  double step_deg = 0.75;
  double spacing_mm = 0.7;
  bool is_in_patient = false;
  double length_mm = 60.0;
  int frames = 0;  ///< Freehand sweep; 0: one frame per mm, or per step.
  bool is_json = false;
};

std::string text_of(const Vec3& v) {
  return fmt::format("{:.9g} {:.9g} {:.9g}", v.x(), v.y(), v.z());
}

std::string text_of(const Pose& X) {
  std::string text;
  for (int row = 0; row < 3; ++row)
    text += text_of(Vec3(X.R().row(row).transpose())) + fmt::format(" {:.9g} ", X.p()[row]);
  return text + "0 0 0 1";
}

/// Fan geometry for stitching and registration, in the frame of the volume: T or P.
io::ImageFields fan_fields(const Scan& scan, const ultrasound::SweepVolume& volume, bool is_in_patient) {
  const ultrasound::SweepGeometry& sweep = volume.geometry;
  const Pose X = is_in_patient ? scan.X_PT : Pose();
  io::ImageFields fields = {
      {"trocar_apex_mm", text_of(X * Vec3(0.0, -sweep.scan.radius_mm, 0.0))},
      {"trocar_radius_mm", fmt::format("{:.9g}", sweep.scan.radius_mm)},
      {"trocar_depth_mm", fmt::format("{:.9g}", sweep.scan.depth_mm)},
      {"trocar_fov_rad", fmt::format("{:.9g}", scan.transducer.field_of_view_rad)},
      {"trocar_beam_axis", "+y"},
      {"trocar_sweep_rad", fmt::format("{:.9g}", sweep.sweep_rad)},
      {"trocar_sweep_radius_mm", fmt::format("{:.9g}", sweep.radius_mm)},
      {"trocar_sweep_axis_mm", text_of(X * Vec3(0.0, -sweep.radius_mm, 0.0))},
      {"trocar_sweep_frames", fmt::format("{}", sweep.frames)},
      {"trocar_transducer", scan.transducer.name},
      {"trocar_frequency_mhz", fmt::format("{:.9g}", scan.acquisition.frequency_mhz)},
      {"trocar_frame", is_in_patient ? "P" : "T"},
  };
  if (is_in_patient) fields.emplace("trocar_X_PT", text_of(scan.X_PT));
  return fields;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void print_done(const SweepArguments& arguments, const config::Json& json, const std::string& line) {
  if (arguments.is_json) {
    print_json(json);
  } else {
    fmt::print("{}\n", line);
  }
}

Status sweep_by_motor(const SweepArguments& arguments, const Scan& scan, const Progress& progress) {
  ultrasound::MechanicalSweepOptions options;
  options.acquisition = scan.acquisition;
  options.display = scan.display;
  options.sweep_rad = arguments.angle_deg * kRadPerDeg;
  options.step_rad = arguments.step_deg * kRadPerDeg;
  options.spacing_mm = arguments.spacing_mm;
  options.seed = arguments.scan.seed;
  const auto start = std::chrono::steady_clock::now();
  TROCAR_TRY(const ultrasound::SweepVolume volume,
             ultrasound::make_mechanical_sweep(scan.scene, scan.transducer, scan.X_PT, options, progress));
  const double seconds = seconds_since(start);
  const bool is_in_patient = arguments.is_in_patient;
  const io::ImageFields fields = fan_fields(scan, volume, is_in_patient);
  TROCAR_TRY_STATUS(
      io::write_image(is_in_patient ? ultrasound::in_patient(volume, scan.X_PT) : volume.gray, arguments.out, fields));
  warn_of_contact(volume.mean_contact);
  warn_of_visibility(scan);

  const auto& size = volume.gray.geometry.size;
  config::Json json = to_json(scan);
  json["out"] = arguments.out;
  json["frame"] = is_in_patient ? "P" : "T";
  json["size"] = size;
  json["spacing_mm"] = arguments.spacing_mm;
  json["frames"] = volume.geometry.frames;
  json["sweep_deg"] = volume.geometry.sweep_rad / kRadPerDeg;
  json["coupled"] = volume.mean_contact;
  json["seconds"] = seconds;
  print_done(
      arguments, json,
      fmt::format("{} voxels of {:g} mm from {} frames over {:.0f} degrees in {:.1f} s, in {}", fmt::join(size, " x "),
                  arguments.spacing_mm, volume.geometry.frames, volume.geometry.sweep_rad / kRadPerDeg, seconds,
                  is_in_patient ? "the patient's axes" : "the transducer's axes"));
  return {};
}

std::vector<Pose> hand_poses(const SweepArguments& arguments, const Scan& scan) {
  if (arguments.angle_deg > 0.0) {
    const int steps = static_cast<int>(std::ceil(arguments.angle_deg / arguments.step_deg));
    const int frames = arguments.frames > 0 ? arguments.frames : std::max(2, steps + 1);
    return ultrasound::tilt_on_skin(scan.X_PT, arguments.angle_deg * kRadPerDeg, scan.transducer.sweep_radius_mm,
                                    frames);
  }
  const int frames = arguments.frames > 0 ? arguments.frames : std::max(2, static_cast<int>(arguments.length_mm) + 1);
  return ultrasound::slide_over_skin(scan.scene->skin_distance_mm, scan.X_PT, arguments.length_mm, frames);
}

Status sweep_by_hand(const SweepArguments& arguments, const Scan& scan, const Progress& progress) {
  ultrasound::FreehandSweepOptions options;
  options.acquisition = scan.acquisition;
  options.display = scan.display;
  options.seed = arguments.scan.seed;
  const std::vector<Pose> poses = hand_poses(arguments, scan);
  const auto start = std::chrono::steady_clock::now();
  const ultrasound::FreehandSweep sweep =
      ultrasound::make_freehand_sweep(scan.scene, scan.transducer, poses, options, progress);
  const double seconds = seconds_since(start);
  TROCAR_TRY_STATUS(io::write_sequence(sweep.sequence, arguments.tracked));
  warn_of_contact(sweep.mean_contact);
  warn_of_visibility(scan);
  config::Json json = to_json(scan);
  json["out"] = arguments.tracked;
  json["frames"] = poses.size();
  json["coupled"] = sweep.mean_contact;
  json["seconds"] = seconds;
  print_done(arguments, json,
             fmt::format("{} tracked pictures of {} x {} pixels in {:.1f} s", poses.size(), sweep.sequence.columns,
                         sweep.sequence.rows, seconds));
  return {};
}

Status check_arguments(const SweepArguments& arguments) {
  if (arguments.out.empty() == arguments.tracked.empty())
    return fail_usage("exactly one of --out and --tracked is needed", "--out, --tracked",
                      "give --out VOLUME.nrrd or --tracked SEQUENCE.igs.mha");
  if (!arguments.out.empty() && fs::path(arguments.out).extension() != ".nrrd")
    return fail_usage("the file name must end in .nrrd", arguments.out, "rename the output");
  if (!arguments.tracked.empty() && fs::path(arguments.tracked).extension() != ".mha")
    return fail_usage("the file name must end in .igs.mha", arguments.tracked, "rename the output");
  return check_outputs({arguments.out, arguments.tracked, arguments.scan.save_pose});
}

Status sweep(const SweepArguments& arguments) {
  TROCAR_TRY_STATUS(check_arguments(arguments));
  const bool is_by_motor = !arguments.out.empty();
  const ProgressPrinter printer;
  TROCAR_TRY(const Scan scan, prepare_scan(arguments.scan, is_by_motor ? "4DC7-3" : "", printer.callback()));
  TROCAR_TRY_STATUS(is_by_motor ? sweep_by_motor(arguments, scan, printer.callback())
                                : sweep_by_hand(arguments, scan, printer.callback()));
  return arguments.scan.save_pose.empty() ? Status{} : save_pose(scan, arguments.scan.save_pose);
}

}  // namespace

void add_ultrasound_sweep_command(Command& ultrasound, Action& action) {
  Command command = ultrasound.add_command("sweep", "Simulate a 3D acquisition");
  command.footer(
      "Examples:\n  trocar ultrasound sweep --patient my_patient --pose probe.tfm --out volume.nrrd\n"
      "  trocar ultrasound sweep --patient abdomen --view liver-right-kidney --in-patient --out liver.nrrd\n"
      "  trocar ultrasound sweep --patient abdomen --view liver-right-kidney --tracked sweep.igs.mha\n");
  const auto a = std::make_shared<SweepArguments>();
  add_scan_options(command, a->scan);
  command.add_option(
      "--out", a->out,
      "Output volume of a mechanical 3D transducer: .nrrd, one byte per voxel, with the fan geometry in the header");
  command.add_option("--tracked", a->tracked, "Alternative output: tracked images of a freehand sweep, .igs.mha");
  command
      .add_option("--angle-deg", a->angle_deg,
                  "Total angle of the sweep; default: that of the transducer. Freehand sweep: tilt without translation")
      .number_within(1.0, 90.0, "degrees");
  command.add_option("--step-deg", a->step_deg, "Angle between frames")
      .number_within(0.1, 10.0, "degrees")
      .show_default();
  command.add_option("--spacing", a->spacing_mm, "Voxel size").number_within(0.2, 5.0, "mm").show_default();
  command.add_flag("--in-patient", a->is_in_patient,
                   "Write the volume in the patient's frame; when left out in the transducer's frame at mid sweep");
  command.add_option("--length-mm", a->length_mm, "Freehand sweep: distance along the skin")
      .number_within(1.0, 300.0, "mm")
      .show_default();
  command.add_option("--frames", a->frames, "Freehand sweep: number of frames; one per mm or angle step when left out")
      .whole_number_within(2, 1000);
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.when_parsed([&action, a] { action = [a] { return sweep(*a); }; });
}

}  // namespace trocar::cli
