#include "io/patient/motion_files.h"

#include <system_error>
#include <utility>

#include "core/files/input_file.h"
#include "io/image/detail/raw_volume.h"
#include "io/image/detail/volume_file.h"
#include "io/patient/detail/patient_toml.h"
#include "motion/motion_file.h"

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

Result<volume::FloatGrid> read_volume(const fs::path& folder, const char* name) {
  const fs::path file = folder / name;
  TROCAR_TRY_STATUS(detail::check_volume_path(file));
  TROCAR_TRY(const detail::RawVolume raw, detail::read_volume_file(file, detail::Check::kUnpack, folder));
  return detail::to_grid<float>(raw, file.string(), detail::convert_voxels);
}

}  // namespace

Result<std::shared_ptr<const motion::MotionModel>> load_motion_model(const fs::path& folder) {
  const fs::path file = folder / detail::kMotionFile;
  std::error_code error;
  if (!fs::exists(fs::symlink_status(file, error))) return std::shared_ptr<const motion::MotionModel>();
  TROCAR_TRY(const InputFile input, InputFile::open(file, FileKind::kToml, folder));
  TROCAR_TRY(const std::string text, input.read_all());
  TROCAR_TRY(motion::MotionDescription description, motion::parse_motion(text, file.string()));
  motion::MotionParts& parts = description.parts;
  TROCAR_TRY(const volume::FloatGrid modes, read_volume(folder, detail::kMotionModesFile));
  TROCAR_TRY_STATUS(motion::unstack_modes(modes, parts, (folder / detail::kMotionModesFile).string()));
  if (parts.regions.size() > 1) {
    TROCAR_TRY(parts.border_mm, read_volume(folder, detail::kMotionBorderFile));
  }
  TROCAR_TRY(auto model, motion::MotionModel::make(std::move(parts), file.string()));
  if (model->hash() == description.hash) return model;
  return fail("its displacements or its border are those of another model", file.string(),
              "make the model again: trocar patient motion DIR --force");
}

}  // namespace trocar::io
