#include "io/sequence/sequence_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/ascii.h"
#include "core/files/atomic_file.h"
#include "io/image/detail/image_header.h"
#include "io/image/detail/text_header.h"
#include "io/sequence/detail/sequence_header.h"
#include "io/sequence/detail/sequence_pixels.h"

namespace trocar::io {
namespace fs = std::filesystem;
namespace {

/// Converts all frames to columns towards the marked side and rows away from the face.
void turn_pictures(const detail::SequenceHeader& header, ultrasound::TrackedSequence& sequence) {
  const auto columns = static_cast<std::ptrdiff_t>(sequence.columns);
  for (std::size_t frame = 0; frame < sequence.frames.size(); ++frame) {
    const auto first = sequence.pixels.begin() + static_cast<std::ptrdiff_t>(frame * sequence.frame_pixels());
    for (int row = 0; row < sequence.rows && header.is_column_flipped; ++row)
      std::reverse(first + row * columns, first + (row + 1) * columns);
    for (int row = 0; row < sequence.rows / 2 && header.is_row_flipped; ++row)
      std::swap_ranges(first + row * columns, first + (row + 1) * columns, first + (sequence.rows - 1 - row) * columns);
  }
}

bool is_transform_name(const std::string& name) {
  const auto is_word = [](char c) { return ascii::is_letter_or_digit(c) || c == '_'; };
  return name.find("To", 1) != std::string::npos && std::all_of(name.begin(), name.end(), is_word);
}

Status check(const ultrasound::TrackedSequence& sequence) {
  const bool is_whole = sequence.pixels.size() == sequence.frame_pixels() * sequence.frames.size();
  if (sequence.pixels.empty() || !is_whole)
    return fail("there is no sequence to write", "sequence", "record at least one frame");
  for (const auto& frame : sequence.frames) {
    if (!std::isfinite(frame.time_s))
      return fail("a time of the sequence is not a number", "sequence", "give a finite time for every frame");
    for (const auto& [name, matrix] : frame.transforms) {
      if (!is_transform_name(name))
        return fail("is not a transform name, such as ProbeToTracker", name, "name it as FromToTo");
      if (!matrix.allFinite() || matrix.row(3) != Eigen::RowVector4d(0, 0, 0, 1))
        return fail("is not an affine transform of finite numbers", name,
                    "give a finite matrix with the last row 0 0 0 1");
    }
  }
  return {};
}

}  // namespace

Result<bool> is_sequence(const fs::path& path) {
  const std::string extension = ascii::lower_case(path.extension().string());
  if (extension != ".mha" && extension != ".mhd") return false;
  TROCAR_TRY(const InputFile file, InputFile::open(path, FileKind::kSequence));
  TROCAR_TRY(const detail::TextHeader header, detail::read_text_header(file, detail::TextHeaderKind::kMeta));
  return detail::has_frame_transforms(header);
}

Result<ultrasound::TrackedSequence> read_sequence(const fs::path& path) {
  TROCAR_TRY(InputFile file, InputFile::open(path, FileKind::kSequence));
  TROCAR_TRY(detail::SequenceHeader header, detail::read_sequence_header(file));
  if (!header.data_file.empty()) {
    TROCAR_TRY(file, detail::open_data_file(path, header.data_file, FileKind::kSequence));
  }
  TROCAR_TRY(header.sequence.pixels, detail::read_pixels(header, file, path.string()));
  turn_pictures(header, header.sequence);
  return std::move(header.sequence);
}

Status write_sequence(const ultrasound::TrackedSequence& sequence, const fs::path& path) {
  if (path.extension() != ".mha")
    return fail_usage("a sequence is written as .igs.mha", path.string(), "let the name end in .igs.mha");
  TROCAR_TRY_STATUS(check(sequence));
  TROCAR_TRY(const std::string packed, detail::pack(sequence.pixels));
  return write_file_atomically(path, detail::sequence_header_text(sequence, packed.size()) + packed);
}

}  // namespace trocar::io
