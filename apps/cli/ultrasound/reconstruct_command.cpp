// trocar ultrasound reconstruct: a volume from a tracked freehand sweep.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <filesystem>
#include <map>

#include "cli/commands.h"
#include "config/json.h"
#include "io/image/image_file.h"
#include "io/sequence/plus_config.h"
#include "io/sequence/sequence_file.h"
#include "ultrasound/sweep/freehand.h"

namespace trocar::cli {
namespace {
namespace fs = std::filesystem;

struct ReconstructArguments {
  std::string sequence;
  std::string calibration;
  std::string out;
  double spacing_mm = 0.0;
  std::string interpolation, compounding, holes, reference;  ///< Empty: as in the calibration file.
  std::string black;  ///< Empty: keep with reconstruction settings in the calibration file, else skip.
  bool is_json = false;
};

const std::map<std::string, ultrasound::FreehandInterpolation>& interpolations() {
  static const std::map<std::string, ultrasound::FreehandInterpolation> names{
      {"nearest", ultrasound::FreehandInterpolation::kNearest}, {"linear", ultrasound::FreehandInterpolation::kLinear}};
  return names;
}

const std::map<std::string, ultrasound::FreehandCompounding>& compoundings() {
  static const std::map<std::string, ultrasound::FreehandCompounding> names{
      {"mean", ultrasound::FreehandCompounding::kMean},
      {"maximum", ultrasound::FreehandCompounding::kMaximum},
      {"latest", ultrasound::FreehandCompounding::kLatest}};
  return names;
}

const std::map<std::string, ultrasound::HoleFilling::Kind>& hole_fillings() {
  static const std::map<std::string, ultrasound::HoleFilling::Kind> names{
      {"stick", ultrasound::HoleFilling::Kind::kStick},
      {"nearest", ultrasound::HoleFilling::Kind::kNearest},
      {"gaussian", ultrasound::HoleFilling::Kind::kGaussian}};
  return names;
}

template <class Value>
std::vector<std::string> keys_of(const std::map<std::string, Value>& values) {
  std::vector<std::string> names;
  for (const auto& [name, value] : values) names.push_back(name);
  return names;
}

/// Settings of the calibration file, overridden by the command line.
Result<io::PlusConfig> gather(const ReconstructArguments& arguments) {
  io::PlusConfig config;
  if (!arguments.calibration.empty()) {
    TROCAR_TRY(config, io::read_plus_config(arguments.calibration));
  }
  ultrasound::FreehandOptions& options = config.reconstruction;
  if (!config.has_reconstruction) options.holes = {ultrasound::HoleFilling{}};
  if (arguments.spacing_mm > 0.0) options.spacing_mm = Vec3::Constant(arguments.spacing_mm);
  if (!arguments.interpolation.empty()) options.interpolation = interpolations().at(arguments.interpolation);
  if (!arguments.compounding.empty()) options.compounding = compoundings().at(arguments.compounding);
  if (!arguments.reference.empty()) options.reference_frame = arguments.reference;
  if (arguments.holes == "none") {
    options.holes.clear();
  } else if (!arguments.holes.empty()) {
    ultrasound::HoleFilling way;
    way.kind = hole_fillings().at(arguments.holes);
    options.holes = {way};
  }
  options.is_black_left_out = arguments.black.empty() ? !config.has_reconstruction : arguments.black == "skip";
  return config;
}

config::Json to_json(const ultrasound::FreehandVolume& volume, const ultrasound::FreehandOptions& options,
                     double seconds) {
  const volume::GridGeometry& grid = volume.gray.geometry;
  config::Json json;
  json["size"] = grid.size;
  json["spacing_mm"] = {grid.spacing_mm[0], grid.spacing_mm[1], grid.spacing_mm[2]};
  json["origin_mm"] = {grid.origin_P[0], grid.origin_P[1], grid.origin_P[2]};
  json["reference"] = options.reference_frame;
  json["frames_used"] = volume.frames_used;
  json["frames_left_out"] = volume.frames_left_out;
  json["voxels_met"] = volume.voxels_met;
  json["holes_filled"] = volume.holes_filled;
  json["seconds"] = seconds;
  return json;
}

void print_summary(const ultrasound::FreehandVolume& volume, const ultrasound::FreehandOptions& options,
                   double seconds) {
  const volume::GridGeometry& grid = volume.gray.geometry;
  fmt::print("{} voxels of {:g} x {:g} x {:g} mm from {} frames in {:.2f} s\n", fmt::join(grid.size, " x "),
             grid.spacing_mm[0], grid.spacing_mm[1], grid.spacing_mm[2], volume.frames_used, seconds);
  fmt::print("{} voxels filled from image pixels, {} holes filled\n", volume.voxels_met, volume.holes_filled);
  fmt::print("axes of the frame {}, stored as LPS\n", options.reference_frame);
}

Status reconstruct(const ReconstructArguments& arguments) {
  const std::string extension = fs::path(arguments.out).extension().string();
  if (extension != ".nrrd") return fail_usage("the file name must end in .nrrd", arguments.out, "rename the output");
  TROCAR_TRY_STATUS(check_new(arguments.out));
  TROCAR_TRY(const io::PlusConfig config, gather(arguments));
  const ProgressPrinter printer;
  const Progress progress = printer.callback();
  core::report(progress, "reading the sequence", 0.0);
  TROCAR_TRY(const ultrasound::TrackedSequence sequence, io::read_sequence(arguments.sequence));
  const auto start = std::chrono::steady_clock::now();
  auto volume = ultrasound::reconstruct_freehand(
      sequence, config.transforms, config.reconstruction,
      [&](std::string_view step, double fraction) { core::report(progress, step, 0.4 + 0.4 * fraction); });
  if (!volume) return fail(volume.error().what, arguments.sequence, volume.error().advice);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  core::report(progress, "writing the volume", 0.8);
  TROCAR_TRY_STATUS(io::write_image(volume->gray, arguments.out));
  core::report(progress, "done", 1.0);
  for (const std::string& what : config.left_aside)
    print_warning(fmt::format("PLUS setting {} of {} is ignored", what, arguments.calibration));
  if (volume->frames_left_out > 0)
    print_warning(fmt::format("{} frames are omitted: invalid, or without a pose", volume->frames_left_out));
  if (arguments.is_json) {
    print_json(to_json(*volume, config.reconstruction, seconds));
  } else {
    print_summary(*volume, config.reconstruction, seconds);
  }
  return {};
}

}  // namespace

void add_ultrasound_reconstruct_command(Command& ultrasound, Action& action) {
  Command command = ultrasound.add_command("reconstruct", "Reconstruct a volume from a tracked freehand sweep");
  command.footer(
      "Examples:\n  trocar ultrasound reconstruct sweep.igs.mha --calibration PlusDeviceSet.xml --spacing 0.5 --out "
      "volume.nrrd\n  trocar ultrasound reconstruct sweep.igs.mha --spacing 1 --reference Tracker --out volume.nrrd\n");
  const auto a = std::make_shared<ReconstructArguments>();
  command.add_option("SEQUENCE", a->sequence, "Tracked images of PLUS or 3D Slicer: .igs.mha").required();
  command.add_option("--calibration", a->calibration,
                     "PLUS configuration (XML) with ImageToProbe; its <VolumeReconstruction> gives the defaults");
  command.add_option("--spacing", a->spacing_mm, "Voxel size; default: that of the calibration file, or 1 mm")
      .number_within(0.01, 100.0, "mm");
  command.add_option("--out", a->out, "Volume to write: .nrrd, one byte a voxel, LPS axes of the reference").required();
  command.add_option("--reference", a->reference, "Reference frame of the volume; default: Reference");
  command.add_option("--interpolation", a->interpolation, "nearest or linear; nearest when left out")
      .one_of(keys_of(interpolations()));
  command
      .add_option("--compounding", a->compounding,
                  "How pixels in one voxel are combined: mean, maximum or latest; mean when left out")
      .one_of(keys_of(compoundings()));
  auto holes = keys_of(hole_fillings());
  holes.emplace_back("none");
  command.add_option("--holes", a->holes, "How holes are filled: stick, nearest, gaussian or none; stick when left out")
      .one_of(holes);
  command
      .add_option("--black", a->black,
                  "Pixels that are black in all frames (margin outside the fan): skip or keep; default: skip, or keep "
                  "with a <VolumeReconstruction> in the calibration file")
      .one_of({"skip", "keep"});
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.when_parsed([&action, a] { action = [a] { return reconstruct(*a); }; });
}

}  // namespace trocar::cli
