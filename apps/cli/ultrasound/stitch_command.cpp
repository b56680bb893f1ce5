// trocar ultrasound stitch: one panorama from overlapping volumes whose poses are unknown.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <chrono>
#include <filesystem>
#include <set>

#include "cli/commands.h"
#include "cli/ultrasound/volume.h"
#include "config/json.h"
#include "core/files/output_file.h"
#include "core/progress.h"
#include "io/image/image_file.h"
#include "io/sequence/transform_file.h"
#include "registration/panorama/stitch.h"
#include "report/stitch_report.h"

namespace trocar::cli {
namespace {
namespace fs = std::filesystem;

struct StitchArguments {
  std::vector<std::string> volumes;
  std::string out, transforms, report, beam_axis;
  std::optional<double> shadow_threshold;
  double spacing_mm = 0.0;  ///< 0: that of the volumes.
  std::uint64_t seed = 1;
  bool is_json = false;
};

Status check_arguments(const StitchArguments& arguments) {
  if (arguments.volumes.size() < 2)
    return fail("a single volume cannot be stitched", arguments.volumes.front(), "give two or more volumes");
  if (fs::path(arguments.out).extension() != ".nrrd")
    return fail_usage("the file name must end in .nrrd", arguments.out, "rename the output");
  TROCAR_TRY_STATUS(check_new(arguments.out));
  TROCAR_TRY_STATUS(check_new(arguments.transforms, "--transforms"));
  if (!arguments.report.empty()) TROCAR_TRY_STATUS(check_new(arguments.report, "--report"));
  std::set<std::string> names;
  for (const std::string& path : arguments.volumes)
    if (!names.insert(io::name_without_ending(path)).second)
      return fail_usage("two volumes have the same file name", path, "rename one: transforms are named after them");
  return {};
}

std::string spacing_text(const volume::GridGeometry& geometry) {
  const Vec3& s = geometry.spacing_mm;
  return fmt::format("{:g} x {:g} x {:g} mm", s.x(), s.y(), s.z());
}

/// Without a common spacing, the scales of keypoints are not the same in all volumes.
Status check_spacing(const StitchArguments& arguments, const UltrasoundVolume& first, const UltrasoundVolume& other) {
  constexpr double kSame = 0.01;
  const Vec3 ratio = other.gray.geometry.spacing_mm.cwiseQuotient(first.gray.geometry.spacing_mm);
  if (arguments.spacing_mm > 0.0 || ((ratio.array() - 1.0).abs() < kSame).all()) return {};
  return fail(fmt::format("the volumes have different voxel sizes: {} has {}, {} has {}", first.name,
                          spacing_text(first.gray.geometry), other.name, spacing_text(other.gray.geometry)),
              {}, "give a common one with --spacing MM, or resample");
}

Result<std::vector<registration::PreparedVolume>> prepare_all(const StitchArguments& arguments,
                                                              const Progress& progress) {
  std::vector<UltrasoundVolume> read;
  for (const std::string& path : arguments.volumes) {
    core::report(progress, "reading " + io::name_without_ending(path), 0.0);
    TROCAR_TRY(UltrasoundVolume volume, read_ultrasound_volume(path, arguments.beam_axis));
    if (!read.empty()) TROCAR_TRY_STATUS(check_spacing(arguments, read.front(), volume));
    read.push_back(std::move(volume));
  }
  registration::PreparationOptions options;
  options.shadow_threshold = arguments.shadow_threshold;
  options.scale_space.spacing_mm = arguments.spacing_mm;
  std::vector<registration::PreparedVolume> prepared;
  for (UltrasoundVolume& volume : read) {
    const double done = static_cast<double>(prepared.size()) / static_cast<double>(read.size());
    core::report(progress, "keypoints of " + volume.name, done);
    TROCAR_TRY(registration::PreparedVolume next,
               registration::prepare(volume.name, std::move(volume.gray), volume.beams, options));
    prepared.push_back(std::move(next));
  }
  return prepared;
}

std::vector<std::string> unplaced(const std::vector<registration::PreparedVolume>& volumes,
                                  const registration::Stitching& stitching) {
  std::vector<std::string> names;
  for (std::size_t n = 0; n < volumes.size(); ++n)
    if (!stitching.X_0N[n]) names.push_back(volumes[n].name);
  return names;
}

Status write_transforms(const std::vector<registration::PreparedVolume>& volumes,
                        const registration::Stitching& stitching, const fs::path& folder) {
  return write_folder_atomically(folder, [&](const fs::path& temporary) -> Status {
    for (std::size_t n = 0; n < volumes.size(); ++n)
      if (stitching.X_0N[n])
        TROCAR_TRY_STATUS(io::write_transform(*stitching.X_0N[n], temporary / (volumes[n].name + ".tfm")));
    return {};
  });
}

config::Json to_json(const std::vector<registration::PreparedVolume>& volumes, const registration::Stitching& stitching,
                     double seconds) {
  config::Json pairs = config::Json::array();
  for (const registration::StitchEdge& edge : stitching.edges)
    pairs.push_back({{"a", volumes[edge.pair.a].name},
                     {"b", volumes[edge.pair.b].name},
                     {"matches", edge.pair.matches.size()},
                     {"inliers", edge.pair.inliers.size()},
                     {"ncc", edge.pair.ncc},
                     {"overlap", edge.pair.overlap},
                     {"confidence", edge.pair.confidence},
                     {"contradiction_mm", edge.contradiction_mm},
                     {"used", edge.is_used}});
  config::Json list = config::Json::array();
  for (std::size_t n = 0; n < volumes.size(); ++n)
    list.push_back({{"name", volumes[n].name},
                    {"placed", stitching.X_0N[n].has_value()},
                    {"keypoints", volumes[n].keypoints.keypoints.size()},
                    {"shadow_share", volumes[n].region.shadow_share}});
  return {{"volumes", std::move(list)}, {"pairs", std::move(pairs)}, {"seconds", seconds}};
}

void print_summary(const std::vector<registration::PreparedVolume>& volumes, const registration::Stitching& stitching,
                   double seconds) {
  for (const registration::StitchEdge& edge : stitching.edges) {
    if (!edge.is_used) continue;
    fmt::print("{} - {}: {} of {} matches agree, correlation {:.2f} over {:.0f} % of the volume, confidence {:.2f}\n",
               volumes[edge.pair.a].name, volumes[edge.pair.b].name, edge.pair.inliers.size(), edge.pair.matches.size(),
               edge.pair.ncc, 100.0 * edge.pair.overlap, edge.pair.confidence);
  }
  fmt::print("{} of {} volumes placed in {:.1f} s\n", volumes.size() - unplaced(volumes, stitching).size(),
             volumes.size(), seconds);
}

Status write_panorama(const StitchArguments& arguments, const std::vector<registration::PreparedVolume>& volumes,
                      const registration::Stitching& stitching, const Progress& progress) {
  std::vector<registration::PlacedVolume> placed;
  for (std::size_t n = 0; n < volumes.size(); ++n)
    if (stitching.X_0N[n]) placed.push_back({&volumes[n], *stitching.X_0N[n]});
  registration::BlendOptions options;
  options.spacing_mm = arguments.spacing_mm;
  TROCAR_TRY(const registration::Panorama panorama, registration::blend(placed, options, part_of(progress, 0.7, 0.95)));
  if (!arguments.report.empty()) {
    core::report(progress, "writing the report", 0.96);
    TROCAR_TRY_STATUS(
        write_file_atomically(arguments.report, report::stitch_report(volumes, stitching, placed, panorama)));
  }
  core::report(progress, "writing the panorama", 0.97);
  // The panorama last: its file means that all was written. Without it, nothing stays.
  Status written = write_transforms(volumes, stitching, arguments.transforms);
  if (written) written = io::write_image(panorama.gray, arguments.out);
  if (written) return {};
  std::error_code ignored;
  fs::remove_all(arguments.transforms, ignored);
  if (!arguments.report.empty()) fs::remove(arguments.report, ignored);
  return written;
}

Status stitch(const StitchArguments& arguments) {
  TROCAR_TRY_STATUS(check_arguments(arguments));
  const auto start = std::chrono::steady_clock::now();
  const ProgressPrinter printer;
  const Progress progress = printer.callback();
  TROCAR_TRY(const auto volumes, prepare_all(arguments, part_of(progress, 0.0, 0.3)));
  registration::StitchOptions options;
  options.pair.ransac.seed = arguments.seed;
  TROCAR_TRY(const registration::Stitching stitching,
             registration::stitch(volumes, options, part_of(progress, 0.3, 0.7)));
  const std::vector<std::string> missing = unplaced(volumes, stitching);
  if (missing.size() + 1 == volumes.size())
    return fail(fmt::format("no volume has a trustworthy connection to the first one; not placed: {}",
                            fmt::join(missing, ", ")),
                volumes.front().name, "give volumes that overlap by a third or more");
  TROCAR_TRY_STATUS(write_panorama(arguments, volumes, stitching, progress));
  core::report(progress, "done", 1.0);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  if (arguments.is_json) {
    print_json(to_json(volumes, stitching, seconds));
  } else {
    print_summary(volumes, stitching, seconds);
  }
  if (missing.empty()) return {};
  return fail(
      fmt::format("not placed, because no connection to the first volume is trustworthy: {}", fmt::join(missing, ", ")),
      volumes.front().name, "the panorama contains the other volumes; give volumes that overlap more");
}

}  // namespace

void add_ultrasound_stitch_command(Command& ultrasound, Action& action) {
  Command command = ultrasound.add_command("stitch", "Stitch overlapping volumes into a panorama");
  command.footer(
      "Examples:\n  trocar ultrasound stitch left.nrrd middle.nrrd right.nrrd --out panorama.nrrd --transforms poses\n"
      "  trocar ultrasound stitch sweep-*.nrrd --beam-axis +z --out panorama.nrrd --transforms poses --report "
      "stitch.html\n");
  const auto a = std::make_shared<StitchArguments>();
  command.add_option("VOLUMES", a->volumes, "Ultrasound volumes, gray levels 0..255; the first gives the frame")
      .required();
  command.add_option("--out", a->out, "Panorama to write: .nrrd; 0 = never imaged").required();
  command
      .add_option("--transforms", a->transforms,
                  "Folder to write: one .tfm a placed volume, from its points to points of the first volume")
      .required();
  command.add_option("--report", a->report, "Report to write: .html with matches, graph of pairs, seams");
  command.add_option("--beam-axis", a->beam_axis,
                     "Direction of sound along the axes of all volumes: +x to -z; default: the headers', or +y");
  command
      .add_option("--shadow-threshold", a->shadow_threshold,
                  "Gray level below which the end of a beam is shadow; default: estimated for each volume")
      .number_within(0.0, 255.0, "");
  command
      .add_option("--spacing", a->spacing_mm,
                  "Voxel size of the panorama and of the comparison; default: that of the volumes")
      .number_within(0.05, 10.0, "mm");
  command.add_option("--seed", a->seed, "Random seed of the search for poses").seed().show_default();
  command.add_flag("--json", a->is_json, "Print one JSON object");
  command.when_parsed([&action, a] { action = [a] { return stitch(*a); }; });
}

}  // namespace trocar::cli
