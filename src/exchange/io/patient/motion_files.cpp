#include "io/patient/motion_files.h"

#include <system_error>
#include <utility>

#include "core/files/input_file.h"
#include "core/files/output_file.h"
#include "core/parallel.h"
#include "io/image/detail/raw_volume.h"
#include "io/image/detail/volume_file.h"
#include "io/image/image_file.h"
#include "motion/motion_file.h"

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

constexpr const char* kModelFile = "motion.toml";
constexpr const char* kModesFile = "motion_modes.nrrd";
constexpr const char* kBorderFile = "motion_border.nrrd";

Result<volume::FloatGrid> read_volume(const fs::path& folder, const char* name) {
  const fs::path file = folder / name;
  TROCAR_TRY_STATUS(detail::check_volume_path(file));
  TROCAR_TRY(const detail::RawVolume raw, detail::read_volume_file(file, detail::Check::kUnpack, folder));
  return detail::to_grid<float>(raw, file.string(), detail::convert_voxels);
}

}  // namespace

Result<std::shared_ptr<const motion::MotionModel>> load_motion_model(const fs::path& folder) {
  const fs::path file = folder / kModelFile;
  std::error_code error;
  if (!fs::exists(fs::symlink_status(file, error))) return std::shared_ptr<const motion::MotionModel>();
  TROCAR_TRY(const InputFile input, InputFile::open(file, FileKind::kToml, folder));
  TROCAR_TRY(const std::string text, input.read_all());
  TROCAR_TRY(motion::MotionDescription description, motion::parse_motion(text, file.string()));
  motion::MotionParts& parts = description.parts;
  TROCAR_TRY(const volume::FloatGrid modes, read_volume(folder, kModesFile));
  TROCAR_TRY_STATUS(motion::unstack_modes(modes, parts, (folder / kModesFile).string()));
  if (parts.regions.size() > 1) {
    TROCAR_TRY(parts.border_mm, read_volume(folder, kBorderFile));
  }
  TROCAR_TRY(auto model, motion::MotionModel::make(std::move(parts), file.string()));
  if (model->hash() == description.hash) return model;
  return fail("its displacements or its border are those of another model", file.string(),
              "make the model again: trocar patient motion DIR --force");
}

Status save_motion_model(const motion::MotionModel& model, const fs::path& folder) {
  std::error_code ignored;
  fs::remove(folder / kModelFile, ignored);
  const motion::MotionParts& parts = model.parts();
  Status border;
  Status modes;
  parallel_invoke([&] { modes = write_image(motion::stack_modes(parts), folder / kModesFile); },
                  [&] {
                    if (!parts.border_mm.empty()) border = write_image(parts.border_mm, folder / kBorderFile);
                  });
  TROCAR_TRY_STATUS(modes);
  TROCAR_TRY_STATUS(border);
  return write_file_atomically(folder / kModelFile, motion::to_toml(model));
}

}  // namespace trocar::io
