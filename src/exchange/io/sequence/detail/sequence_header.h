#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "core/files/input_file.h"
#include "ultrasound/sweep/tracked_sequence.h"

namespace trocar::io::detail {

/// Header data of a tracked sequence.
struct SequenceHeader {
  ultrasound::TrackedSequence sequence;  ///< Without pixels.
  std::filesystem::path data_file;       ///< Relative to the header; empty: pixels follow the header.
  std::uint64_t pixel_offset = 0;        ///< Start of the pixels or of their compressed stream.
  std::uint64_t packed_bytes = 0;        ///< Length of the compressed stream, 0 if the header does not state it.
  bool is_compressed = false;
  bool is_column_flipped = false;  ///< Columns run to the unmarked side (U).
  bool is_row_flipped = false;     ///< Rows run to the face (N).
};

/// Reads and checks the header; the errors name the file.
Result<SequenceHeader> read_sequence_header(const InputFile& file);

/// Header text of a sequence in one file, up to and including the line before the pixels.
std::string sequence_header_text(const ultrasound::TrackedSequence& sequence, std::size_t packed_bytes);

}  // namespace trocar::io::detail
