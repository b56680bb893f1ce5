// trocar register: the pose of an ultrasound volume in a CT.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <filesystem>
#include <optional>

#include "cli/commands.h"
#include "cli/ultrasound/volume.h"
#include "config/json.h"
#include "core/interruption.h"
#include "core/result.h"
#include "io/image/image_file.h"
#include "io/markups_file.h"
#include "io/sequence/transform_file.h"
#include "png/png_file.h"
#include "registration/ct_ultrasound/deformable_registration.h"
#include "registration/ct_ultrasound/landmark_fit.h"
#include "registration/ct_ultrasound/overlay_picture.h"
#include "registration/ct_ultrasound/rigid_registration.h"

namespace trocar::cli {
namespace {
namespace fs = std::filesystem;

constexpr double kLandmarkReach_mm = 15.0;  ///< From the fit of landmarks.

struct RegisterArguments {
  std::string ct, us, out, checkerboard;
  std::vector<std::string> landmarks;
  std::string init = "header";
  std::string beam_axis;  ///< Empty: that of the header, else +y.
  std::uint64_t seed = 1;
  bool is_deformable = false;
  bool is_json = false;

  /// "us_to_ct.deformable.tfm" beside "us_to_ct.tfm".
  fs::path deformation() const { return fs::path(out).replace_extension(".deformable.tfm"); }
};

/// Results of the command.
struct Found {
  registration::RigidRegistration rigid;
  std::optional<registration::DeformableRegistration> deformable;
};

struct Inputs {
  volume::CtGrid ct;
  UltrasoundVolume us;
  std::optional<registration::LandmarkFit> landmarks;
};

Status check_arguments(const RegisterArguments& arguments) {
  if (fs::path(arguments.out).extension() != ".tfm")
    return fail_usage("the file name must end in .tfm", arguments.out, "rename the output");
  TROCAR_TRY_STATUS(check_new(arguments.out));
  if (arguments.is_deformable) TROCAR_TRY_STATUS(check_new(arguments.deformation(), "--deformable"));
  if (arguments.checkerboard.empty()) return {};
  if (fs::path(arguments.checkerboard).extension() != ".png")
    return fail_usage("the file name must end in .png", arguments.checkerboard, "rename the output");
  return check_new(arguments.checkerboard, "--checkerboard");
}

Result<std::vector<registration::NamedPoint>> read_points(const std::string& path) {
  TROCAR_TRY(const std::vector<anatomy::Landmark> landmarks, io::read_landmarks(path));
  std::vector<registration::NamedPoint> points;
  for (const anatomy::Landmark& landmark : landmarks) points.push_back({landmark.name, landmark.p_P});
  return points;
}

Result<Inputs> read_inputs(const RegisterArguments& arguments) {
  Inputs inputs;
  if (!arguments.landmarks.empty()) {
    TROCAR_TRY(const auto ct, read_points(arguments.landmarks[0]));
    TROCAR_TRY(const auto us, read_points(arguments.landmarks[1]));
    auto fit = registration::fit_landmarks(ct, us);
    if (!fit) return fail_at(arguments.landmarks[1], fit.error());
    inputs.landmarks = *std::move(fit);
  }
  TROCAR_TRY(inputs.us, read_ultrasound_volume(arguments.us, arguments.beam_axis));
  TROCAR_TRY(inputs.ct, io::read_ct(arguments.ct));
  return inputs;
}

void warn_of_landmarks(const std::optional<registration::LandmarkFit>& landmarks) {
  if (!landmarks) return;
  if (!landmarks->unmatched.empty())
    print_warning(fmt::format("landmarks without a partner are ignored: {}", fmt::join(landmarks->unmatched, ", ")));
  if (!landmarks->warning.empty()) print_warning(landmarks->warning);
}

config::Json to_json(const Found& result, const Inputs& inputs, double seconds) {
  const registration::RigidRegistration& found = result.rigid;
  config::Json json;
  json["metric"] = found.metric;
  json["overlap"] = found.overlap;
  json["confidence"] = found.confidence;
  json["agreement"] = found.agreement;
  json["distinction"] = found.distinction;
  json["shadow"] = found.shadow_share;
  json["seconds"] = seconds;
  if (inputs.landmarks) {
    json["landmarks"] = {{"pairs", inputs.landmarks->names.size()},
                         {"rms_mm", inputs.landmarks->fit.rms_mm},
                         {"scale", inputs.landmarks->fit.scale},
                         {"worst", inputs.landmarks->worst},
                         {"worst_mm", inputs.landmarks->worst_mm}};
  }
  if (const auto& deformable = result.deformable) {
    json["deformable"] = {{"metric_before", deformable->metric_before},
                          {"metric", deformable->metric},
                          {"mean_mm", deformable->mean_mm},
                          {"largest_mm", deformable->largest_mm},
                          {"least_jacobian", deformable->least_jacobian}};
  }
  return json;
}

void print_summary(const Found& found, const Inputs& inputs, double seconds) {
  fmt::print("registered in {:.1f} s: mutual information {:.3f}, overlap {:.2f}, confidence {:.2f}\n", seconds,
             found.rigid.metric, found.rigid.overlap, found.rigid.confidence);
  if (const auto& landmarks = inputs.landmarks)
    fmt::print("{} landmark pairs: rms {:.1f} mm, scale {:.3f}, worst \"{}\" {:.1f} mm\n", landmarks->names.size(),
               landmarks->fit.rms_mm, landmarks->fit.scale, landmarks->worst, landmarks->worst_mm);
  if (const auto& deformable = found.deformable)
    fmt::print("deformed by {:.1f} mm on average, {:.1f} mm at most: mutual information {:.3f} to {:.3f}\n",
               deformable->mean_mm, deformable->largest_mm, deformable->metric_before, deformable->metric);
}

Result<Found> find_poses(const RegisterArguments& arguments, const Inputs& inputs, const Progress& progress) {
  registration::RigidOptions options;
  options.seed = arguments.seed;
  options.is_search = arguments.init == "search" && !inputs.landmarks;
  options.is_cancelled = [] { return is_interrupted(); };
  if (inputs.landmarks) {
    options.X_CU = inputs.landmarks->fit.X_AB;
    options.reach_mm = kLandmarkReach_mm;
  }
  Found found;
  TROCAR_TRY(found.rigid, registration::register_rigid(inputs.ct, inputs.us.gray, inputs.us.beams, options,
                                                       [&](std::string_view step, double part) {
                                                         core::report(progress, step, 0.2 + 0.5 * part);
                                                       }));
  TROCAR_TRY_STATUS(registration::check_confidence(found.rigid, "nothing was written"));
  if (!arguments.is_deformable) return found;
  registration::DeformableOptions deformable;
  deformable.seed = arguments.seed;
  deformable.is_cancelled = options.is_cancelled;
  TROCAR_TRY(found.deformable,
             registration::register_deformable(
                 inputs.ct, inputs.us.gray, inputs.us.beams, found.rigid.X_CU, deformable,
                 [&](std::string_view step, double part) { core::report(progress, step, 0.7 + 0.2 * part); }));
  return found;
}

/// The transforms; the deformation first, so that a file at --out means that all was written.
Status write_registration(const RegisterArguments& arguments, const Found& found) {
  if (found.deformable)
    TROCAR_TRY_STATUS(io::write_deformation(found.rigid.X_CU, found.deformable->field_U, arguments.deformation()));
  return io::write_transform(found.rigid.X_CU, arguments.out);
}

Status register_volumes(const RegisterArguments& arguments) {
  TROCAR_TRY_STATUS(check_arguments(arguments));
  const InterruptibleWork interruptible;
  const ProgressPrinter printer;
  const Progress progress = printer.callback();
  core::report(progress, "reading the volumes", 0.0);
  const auto start = std::chrono::steady_clock::now();
  TROCAR_TRY(const Inputs inputs, read_inputs(arguments));
  warn_of_landmarks(inputs.landmarks);
  const auto found = find_poses(arguments, inputs, progress);
  if (is_interrupted()) return tl::unexpected(interruption_error(arguments.out));
  if (!found) return fail_at(arguments.us, found.error());
  if (!arguments.checkerboard.empty()) {
    TROCAR_TRY(const image::RgbImage picture,
               registration::overlay_picture(inputs.ct, inputs.us.gray, inputs.us.beams, found->rigid.X_CU));
    TROCAR_TRY_STATUS(png::write_png(picture, arguments.checkerboard));
  }
  TROCAR_TRY_STATUS(write_registration(arguments, *found));
  core::report(progress, "done", 1.0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (arguments.is_json) {
    print_json(to_json(*found, inputs, seconds));
  } else {
    print_summary(*found, inputs, seconds);
  }
  return {};
}

}  // namespace

void add_register_command(Command& program, Action& action) {
  Command command = program.add_command("register", "Register an ultrasound volume to a CT");
  command.footer(
      "The transform maps points of the ultrasound to points of the CT (ITK, LPS mm). A result of low confidence is\n"
      "refused: exit status 1, nothing is written.\n"
      "Examples:\n  trocar register --ct ct.nrrd --us liver.nrrd --out us_to_ct.tfm --checkerboard check.png\n"
      "  trocar register --ct ct.nrrd --us liver.nrrd --landmarks ct.mrk.json us.mrk.json --out us_to_ct.tfm\n");
  const auto a = std::make_shared<RegisterArguments>();
  command.add_option("--ct", a->ct, "CT: .nii .nii.gz .nrrd .mha .mhd, or a DICOM folder").required();
  command.add_option("--us", a->us, "Ultrasound volume, one byte per voxel: the same formats").required();
  command
      .add_option("--landmarks", a->landmarks,
                  "Start: landmarks of CT and ultrasound, two Slicer markups (.mrk.json), paired by label")
      .values(2)
      .type_name("CT US");
  command
      .add_option(
          "--init", a->init,
          "Start without landmarks: header (the volumes share a frame) or search (transducer anywhere on the skin)")
      .one_of({"header", "search"})
      .show_default();
  command.add_option("--beam-axis", a->beam_axis,
                     "Direction of sound along the index axes: +x, -x, … -z; default: the header's, else +y");
  command.add_option("--out", a->out, "Output: rigid transform, .tfm").required();
  command.add_flag(
      "--deformable", a->is_deformable,
      "Also deform by a B-spline: written beside the rigid transform as NAME.deformable.tfm (ITK composite)");
  command.add_option("--checkerboard", a->checkerboard, "Picture of both volumes to judge the result by: .png");
  command.add_option("--seed", a->seed, "Random seed of samples and starts").show_default();
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.when_parsed([&action, a] { action = [a] { return register_volumes(*a); }; });
}

}  // namespace trocar::cli
