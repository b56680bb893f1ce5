#include "cli/ultrasound/volume.h"

#include "cli/output.h"
#include "core/result.h"
#include "io/image/image_file.h"

namespace trocar::cli {

Result<UltrasoundVolume> read_ultrasound_volume(const std::string& path, const std::string& beam_axis) {
  UltrasoundVolume volume;
  volume.name = io::name_without_ending(path);
  std::vector<std::string> warnings;
  TROCAR_TRY(volume.gray, io::read_gray_levels(path, warnings));
  for (const std::string& warning : warnings) print_warning(warning);
  TROCAR_TRY(const io::ImageFields fields, io::read_image_fields(path));
  auto beams = registration::Beams::choose(beam_axis, fields, volume.gray.geometry);
  if (!beams) return fail_at(path, beams.error());
  volume.beams = *std::move(beams);
  return volume;
}

}  // namespace trocar::cli
