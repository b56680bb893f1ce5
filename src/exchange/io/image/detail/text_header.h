#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/input_file.h"

namespace trocar::io::detail {

/// The text header of a NRRD or MetaImage file.
struct TextHeader {
  std::map<std::string, std::string> fields;  ///< Keys in lower case; NRRD's "key:=value" pairs are not among them.
  std::uint64_t end = 0;                      ///< Offset of the first byte after the header.

  bool has(const std::string& key) const { return fields.contains(key); }
  /// Value of a field, or the fallback.
  std::string get(const std::string& key, std::string fallback = {}) const;
};

enum class TextHeaderKind { kNrrd, kMeta };

/// Reads "field: value" lines up to an empty line (NRRD), "Field = Value" lines up to ElementDataFile (MetaImage).
/// Bounded, because the libraries that read the header afterwards overflow or take minutes for one that is not: 10,000
/// lines and 4 MiB; 500 characters a field (MetaImage: 250), 64 KiB a pair or comment; no control characters; no field
/// and no key twice. Errors: such a header, or none.
Result<TextHeader> read_text_header(const InputFile& input, TextHeaderKind kind);
/// True if images have poses of their own (Seq_Frame0000_ProbeToTrackerTransform): a sequence, not a volume.
bool has_frame_transforms(const TextHeader& header);

std::string trim(std::string_view text);
/// Whole or finite numbers between white space; empty if the text contains anything else.
std::vector<std::int64_t> whole_numbers(std::string_view text);
std::vector<double> real_numbers(std::string_view text);

}  // namespace trocar::io::detail
