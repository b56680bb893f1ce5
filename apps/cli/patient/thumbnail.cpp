// trocar patient thumbnail: the small picture of a patient for lists.
#include "cli/patient/thumbnail.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string>

#include "cases/prepare_case.h"
#include "cli/patient_option.h"
#include "core/progress.h"
#include "io/patient/patient_cache.h"
#include "png/png_file.h"
#include "scene/render_patient.h"

namespace trocar::cli {
namespace {

constexpr double kHalfBox_mm = 78.0;  ///< Half the edge of the displayed cube.
constexpr double kTurn_rad = 0.5;     ///< Camera beside the needle path.
constexpr double kRaise_rad = 0.25;
constexpr double kSkinOpacity = 0.22;

/// A camera position, and its turn towards the front or to a side: on the path itself, the path would be a point.
struct Side {
  Vec3 inwards_P;
  scene::CameraPreset preset;
  double turn_rad;
};

/// The side of the body where the path begins.
Side side_of(const slices::ThumbnailRegion& region) {
  using enum scene::CameraPreset;
  constexpr std::size_t kRightSide = 1;
  const std::array<Side, 4> sides{{{Vec3(0, 1, 0), kAnterior, kTurn_rad},
                                   {Vec3(1, 0, 0), kRightAnteriorOblique, 0.0},
                                   {Vec3(-1, 0, 0), kLeft, -kTurn_rad},
                                   {Vec3(0, -1, 0), kPosterior, kTurn_rad}}};
  if (!region.path_P) return sides[kRightSide];
  const Vec3 way_P = region.path_P->direction();
  return *std::max_element(sides.begin(), sides.end(), [&](const Side& a, const Side& b) {
    return a.inwards_P.dot(way_P) < b.inwards_P.dot(way_P);
  });
}

scene::CameraView camera_of(const slices::ThumbnailRegion& region) {
  std::vector<Vec3> points_P;
  for (int corner = 0; corner < 8; ++corner)
    points_P.push_back(region.centre_P + kHalfBox_mm * Vec3((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                                                            (corner & 4) != 0 ? 1 : -1));
  if (region.path_P) points_P.push_back(region.path_P->a);
  constexpr double kAspect = static_cast<double>(slices::kThumbnailColumns) / slices::kThumbnailRows;
  const Side side = side_of(region);
  return scene::orbited(scene::fit_camera(points_P, side.preset, kAspect), side.turn_rad, kRaise_rad);
}

struct ThumbnailArguments {
  io::PatientSource source;
  std::string task;
  std::string out;
};

/// The path planned for the task; without a task, the region of the patient's own data.
Result<slices::ThumbnailRegion> region_of(const std::shared_ptr<const anatomy::VirtualPatient>& patient,
                                          const std::string& task, const Progress& progress) {
  if (task.empty()) return slices::find_thumbnail_region(*patient);
  cases::CaseOptions options;
  options.task = task;
  TROCAR_TRY(const cases::Case the_case, cases::prepare_case(patient, options, progress));
  return slices::ThumbnailRegion{the_case.plan.line_P.b, the_case.plan.line_P};
}

Status write_thumbnail(const ThumbnailArguments& arguments) {
  const ProgressPrinter printer;
  const Progress progress = printer.callback();
  TROCAR_TRY(anatomy::VirtualPatient opened, io::open_patient(arguments.source, part_of(progress, 0.0, 0.4)));
  const auto patient = std::make_shared<const anatomy::VirtualPatient>(std::move(opened));
  TROCAR_TRY(const auto region, region_of(patient, arguments.task, part_of(progress, 0.4, 0.5)));
  TROCAR_TRY(const auto meshes, io::open_meshes(arguments.source, *patient, part_of(progress, 0.5, 0.9)));
  core::report(progress, "drawing", 0.9);
  TROCAR_TRY(const image::RgbImage image, make_thumbnail(*patient, meshes, region));
  return png::write_png(image, arguments.out);
}

}  // namespace

Result<image::RgbImage> make_thumbnail(const anatomy::VirtualPatient& patient,
                                       const std::vector<anatomy::NamedMesh>& meshes,
                                       const slices::ThumbnailRegion& region) {
  if (!scene::can_render()) return slices::make_slice_thumbnail(patient, region);
  scene::SceneOptions options;
  options.columns = slices::kThumbnailColumns;
  options.rows = slices::kThumbnailRows;
  options.skin_opacity = kSkinOpacity;
  options.view = camera_of(region);
  if (region.path_P) options.paths = {{"path", *region.path_P}};
  TROCAR_TRY(image::RgbImage image, scene::render_patient(patient, meshes, options));
  slices::add_coronal_inset(patient, region, image);
  return image;
}

void add_thumbnail_command(Command& patient, Action& action) {
  Command command = patient.add_command(
      "thumbnail", "Draw the small picture of a patient for lists: in 3D if an X server is available, else slices");
  const auto a = std::make_shared<ThumbnailArguments>();
  command.add_option("PATIENT", a->source.folder_or_name, "Patient folder, or an embedded patient's name").required();
  command.add_option("--seed", a->source.seed, "Seed of an embedded patient").seed().show_default();
  add_cache_option(command, a->source);
  command.add_option("--task", a->task,
                     "Task whose planned path is shown; default: the patient's first path or lesion");
  command.add_option("--out", a->out, "PNG file to write").required();
  command.footer("Example:\n  xvfb-run -a trocar patient thumbnail abdomen --task liver-biopsy --out abdomen.png\n");
  command.when_parsed([&action, a] { action = [a] { return write_thumbnail(*a); }; });
}

}  // namespace trocar::cli
