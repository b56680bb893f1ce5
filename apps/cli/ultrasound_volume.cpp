#include "ultrasound_volume.h"

#include <algorithm>
#include <filesystem>

#include "io/image/image_file.h"

namespace trocar::cli {

std::string name_without_ending(const std::string& path) {
  std::string name = std::filesystem::path(path).filename().string();
  std::size_t longest = 0;
  for (const std::string_view ending : io::image_endings())
    if (name.size() > ending.size() && name.ends_with(ending)) longest = std::max(longest, ending.size());
  name.resize(name.size() - longest);
  return name;
}

Result<volume::LabelGrid> read_gray_levels(const std::string& path) {
  auto gray = io::read_labels(path);
  if (!gray && gray.error().what.find("label") != std::string::npos)
    return fail("the ultrasound has values that are not whole gray levels from 0 to 255", path,
                "export it with one byte per voxel");
  return gray;
}

Result<UltrasoundVolume> read_ultrasound_volume(const std::string& path, const std::string& beam_axis) {
  UltrasoundVolume volume;
  volume.name = name_without_ending(path);
  TROCAR_TRY(volume.gray, read_gray_levels(path));
  if (!beam_axis.empty()) {
    TROCAR_TRY(volume.beams, registration::Beams::along_axis(beam_axis, volume.gray.geometry));
    return volume;
  }
  TROCAR_TRY(const io::ImageFields fields, io::read_image_fields(path));
  auto beams = registration::Beams::from_header(fields, volume.gray.geometry);
  if (!beams) return fail(beams.error().what, path, beams.error().advice);
  volume.beams = *std::move(beams);
  return volume;
}

}  // namespace trocar::cli
