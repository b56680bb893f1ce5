// trocar ultrasound keypoints: 3D SIFT keypoints of a volume.
#include <fmt/format.h>

#include <chrono>

#include "cli/commands.h"
#include "cli/json_parts.h"
#include "cli/ultrasound/volume.h"
#include "config/json.h"
#include "core/files/output_file.h"
#include "registration/panorama/pair_registration.h"

namespace trocar::cli {
namespace {

struct KeypointsArguments {
  std::string volume, out, beam_axis;
  std::optional<double> shadow_threshold;
  registration::PreparationOptions options;
  bool is_json = false;
};

config::Json to_json(const registration::PreparedVolume& volume, double seconds) {
  config::Json keypoints = config::Json::array();
  for (const registration::Keypoint& k : volume.keypoints.keypoints)
    keypoints.push_back({{"p_mm", vector_json(k.p_P)},
                         {"sigma_mm", k.sigma_mm},
                         {"contrast", k.contrast},
                         {"ratio", k.ratio},
                         {"octave", k.octave},
                         {"orientations", config::Json::array()}});
  for (const registration::Feature& feature : volume.keypoints.features.features) {
    const Mat3& R = feature.R_PK;
    keypoints[feature.keypoint]["orientations"].push_back(
        {vector_json(R.col(0)), vector_json(R.col(1)), vector_json(R.col(2))});
  }
  return {{"volume", volume.name},
          {"shadow_threshold", volume.shadow_threshold},
          {"shadow_share", volume.region.shadow_share},
          {"seconds", seconds},
          {"keypoints", std::move(keypoints)}};
}

Status find(const KeypointsArguments& arguments) {
  TROCAR_TRY_STATUS(check_new(arguments.out));
  const ProgressPrinter printer;
  TROCAR_TRY(UltrasoundVolume volume, read_ultrasound_volume(arguments.volume, arguments.beam_axis));
  registration::PreparationOptions options = arguments.options;
  options.shadow_threshold = arguments.shadow_threshold;
  const auto start = std::chrono::steady_clock::now();
  TROCAR_TRY(const registration::PreparedVolume prepared,
             registration::prepare(volume.name, std::move(volume.gray), volume.beams, options, printer.callback()));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  TROCAR_TRY_STATUS(write_file_atomically(arguments.out, to_json(prepared, seconds).dump(1) + "\n"));
  const std::size_t keypoints = prepared.keypoints.keypoints.size();
  const std::size_t descriptors = prepared.keypoints.features.features.size();
  if (arguments.is_json) {
    print_json({{"keypoints", keypoints},
                {"descriptors", descriptors},
                {"shadow_threshold", prepared.shadow_threshold},
                {"shadow_share", prepared.region.shadow_share},
                {"seconds", seconds}});
  } else {
    fmt::print("{} keypoints with {} descriptors in {:.2f} s; {:.0f} % of the volume in shadow (below gray {:.0f})\n",
               keypoints, descriptors, seconds, 100.0 * prepared.region.shadow_share, prepared.shadow_threshold);
  }
  return {};
}

}  // namespace

void add_ultrasound_keypoints_command(Command& ultrasound, Action& action) {
  Command command = ultrasound.add_command("keypoints", "Find the 3D SIFT keypoints of a volume");
  command.footer("Example:\n  trocar ultrasound keypoints volume.nrrd --out keypoints.json\n");
  const auto a = std::make_shared<KeypointsArguments>();
  command.add_option("VOLUME", a->volume, "Ultrasound volume, gray levels 0..255: .nrrd .nii .nii.gz .mha").required();
  command
      .add_option("--out", a->out, "JSON file to write: place (LPS, mm), scale, contrast, orientations (x, y, z axes)")
      .required();
  command.add_option("--beam-axis", a->beam_axis,
                     "Direction of sound along the axes of the volume: +x to -z; default: the header's, or +y");
  command
      .add_option("--shadow-threshold", a->shadow_threshold,
                  "Gray level below which the end of a beam is shadow; default: estimated from the volume")
      .number_within(0.0, 255.0, "");
  command
      .add_option("--contrast", a->options.keypoints.least_contrast,
                  "Least contrast of a keypoint, in local standard deviations")
      .show_default();
  command
      .add_option("--edge-ratio", a->options.keypoints.largest_ratio, "Largest ratio of the curvatures of a keypoint")
      .show_default();
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.when_parsed([&action, a] { action = [a] { return find(*a); }; });
}

}  // namespace trocar::cli
