#include "io/sequence/detail/sequence_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "core/text.h"
#include "io/detail/number_text.h"
#include "io/image/detail/image_header.h"

namespace trocar::io::detail {
namespace {

constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20;
constexpr std::uint64_t kMaxSequenceHeaderBytes = std::uint64_t{64} << 20;  ///< 100,000 frames of three transforms.
constexpr std::size_t kMaxSequenceFields = 1'000'000, kMaxOtherFields = 10'000;  ///< Short lines need much memory.
constexpr double kMaxFrameSide = 65'535;
constexpr double kMaxFrames = 1'000'000;
constexpr double kMaxPixels = 2e9;
constexpr std::string_view kFramePrefix = "Seq_Frame";
constexpr std::string_view kTransform = "Transform", kStatus = "Status";
constexpr const char* kNeeded = "give a tracked sequence (.igs.mha) as PLUS or 3D Slicer writes it";

using Fields = std::map<std::string, std::string, std::less<>>;

struct HeaderText {
  Fields fields;
  std::map<std::size_t, Fields> frames;  ///< By frame number: "ProbeToTrackerTransform" -> text.
  std::uint64_t end = 0;
};

struct FrameKey {
  std::size_t frame;
  std::string_view name;
};

/// "Seq_Frame0012_Timestamp" -> 12, "Timestamp".
std::optional<FrameKey> find_frame_key(std::string_view key) {
  if (!key.starts_with(kFramePrefix)) return std::nullopt;
  key.remove_prefix(kFramePrefix.size());
  const auto frame = find_leading_number<std::size_t>(key);
  if (!frame || frame->rest.size() < 2 || frame->rest.front() != '_') return std::nullopt;
  return FrameKey{frame->value, frame->rest.substr(1)};
}

/// The lines "key = value" up to ElementDataFile. Errors: no such line, too long.
Result<HeaderText> read_text(const InputFile& input) {
  const std::string where = input.path().string();
  std::ifstream file(input.pinned_path(), std::ios::binary);
  HeaderText text;
  const auto line = std::make_unique_for_overwrite<char[]>(kMaxLineBytes);
  std::size_t lines = 0;
  while (file.getline(line.get(), static_cast<std::streamsize>(kMaxLineBytes))) {
    text.end += static_cast<std::uint64_t>(file.gcount());
    const std::string_view content(line.get());
    const auto separator = content.find('=');
    if (separator == std::string_view::npos) break;
    if (text.end > kMaxSequenceHeaderBytes || ++lines > kMaxSequenceFields || text.fields.size() > kMaxOtherFields)
      return fail("the header is too large for a tracked sequence", where, "record or save a shorter sequence");
    const std::string_view key = trimmed(content.substr(0, separator));
    const std::string value(trimmed(content.substr(separator + 1)));
    if (const auto frame_key = find_frame_key(key)) {
      text.frames[frame_key->frame].insert_or_assign(std::string(frame_key->name), value);
    } else {
      text.fields.insert_or_assign(std::string(key), value);
    }
    if (key == "ElementDataFile") return text;
  }
  if (text.fields.contains("NDims") || text.fields.contains("ObjectType"))
    return fail("the header ends before ElementDataFile", where, kExportAgain);
  return fail("not a tracked sequence", where, kNeeded);
}

bool is_true(const Fields& fields, std::string_view key) {
  const auto found = fields.find(key);
  return found != fields.end() && !found->second.empty() && (found->second[0] == 'T' || found->second[0] == 't');
}

std::string value_of(const Fields& fields, std::string_view key, std::string_view fallback = {}) {
  const auto found = fields.find(key);
  return found == fields.end() ? std::string(fallback) : found->second;
}

Status take_size(const HeaderText& text, const std::string& where, ultrasound::TrackedSequence& sequence) {
  const auto sizes = find_numbers(value_of(text.fields, "DimSize"), 4);
  if (!sizes || sizes->size() < 3)
    return fail("the field DimSize does not give columns, rows and frames", where, kNeeded);
  // Some versions of PLUS write depth 1 between rows and frames.
  if (sizes->size() == 4 && (*sizes)[2] != 1.0)
    return fail("is a sequence of volumes, not of pictures", where, kNeeded);
  const double columns = (*sizes)[0], rows = (*sizes)[1], frames = sizes->back();
  for (const double size : {columns, rows, frames})
    if (size < 1.0 || size != std::floor(size)) return fail("the field DimSize is damaged", where, kExportAgain);
  if (columns > kMaxFrameSide || rows > kMaxFrameSide || frames > kMaxFrames || columns * rows * frames > kMaxPixels)
    return fail("the header claims an impossible size", where, kExportAgain);
  if (text.frames.empty()) return fail("has no fields of tracked frames (Seq_Frame...)", where, kNeeded);
  if (text.frames.size() != static_cast<std::size_t>(frames) || text.frames.rbegin()->first >= text.frames.size())
    return fail(fmt::format("has {} pictures, but the fields of {} frames up to number {}", frames, text.frames.size(),
                            text.frames.rbegin()->first),
                where, "record or save it again: each picture needs its Seq_Frame fields");
  sequence.columns = static_cast<int>(columns);
  sequence.rows = static_cast<int>(rows);
  sequence.frames.resize(static_cast<std::size_t>(frames));
  return {};
}

Status check_pixel_type(const Fields& fields, const std::string& where) {
  const std::string type = value_of(fields, "ElementType");
  if (type != "MET_UCHAR")
    return fail(type.empty() ? "the field ElementType is missing" : fmt::format("has pixels of type {}", type), where,
                "give a sequence of one byte (MET_UCHAR) a pixel");
  if (value_of(fields, "ElementNumberOfChannels", "1") != "1")
    return fail("has several values a pixel", where, "give a gray sequence, not one in colour");
  if (is_true(fields, "BinaryData") || !fields.contains("BinaryData")) return {};
  return fail("has its pixels written as text", where, "save it with binary data");
}

Status take_orientation(const Fields& fields, const std::string& where, SequenceHeader& header) {
  const std::string orientation = value_of(fields, "UltrasoundImageOrientation", "MFA");
  if (orientation.empty() || orientation.starts_with("XX")) return {};  // PLUS: unknown
  const bool is_known = orientation.size() >= 2 &&
                        std::string_view("MU").find(orientation[0]) != std::string_view::npos &&
                        std::string_view("FN").find(orientation[1]) != std::string_view::npos;
  if (!is_known)
    return fail(fmt::format("has the unknown image orientation {}", orientation), where,
                "save it with UltrasoundImageOrientation MFA");
  header.is_column_flipped = orientation[0] == 'U';
  header.is_row_flipped = orientation[1] == 'N';
  return {};
}

Status take_place_of_pixels(const HeaderText& text, const std::string& where, SequenceHeader& header) {
  header.is_compressed = is_true(text.fields, "CompressedData");
  const auto packed = find_numbers(value_of(text.fields, "CompressedDataSize", "0"), 1);
  if (!packed || packed->size() != 1 || packed->front() < 0.0 || packed->front() > 1e15)
    return fail("the field CompressedDataSize is damaged", where, kExportAgain);
  header.packed_bytes = static_cast<std::uint64_t>(packed->front());
  const std::string data_file = value_of(text.fields, "ElementDataFile");
  if (data_file == "LOCAL" || data_file == "Local" || data_file == "local") {
    header.pixel_offset = text.end;
    return {};
  }
  if (data_file.empty() || data_file.starts_with("LIST") || data_file.find('%') != std::string::npos)
    return fail("the pictures are in several files", where, "save it as one .igs.mha file");
  header.data_file = data_file;
  return {};
}

/// Reads one field of a frame; ignores unknown ones.
Status take_field(const Fields& fields, const std::string& name, const std::string& value,
                  ultrasound::TrackedSequence::Frame& frame) {
  if (name == "ImageStatus") {
    frame.is_valid = value == "OK";
  } else if (name == "Timestamp") {
    const auto time_s = find_numbers(value, 1);
    if (!time_s || time_s->empty()) return fail("is not a time in seconds", "Timestamp", "record the sequence again");
    frame.time_s = time_s->front();
  } else if (name.ends_with(kTransform) && name.size() > kTransform.size()) {
    if (value_of(fields, name + std::string(kStatus), "OK") != "OK") return {};
    TROCAR_TRY(const auto matrix, parse_matrix(value));
    frame.transforms.emplace(name.substr(0, name.size() - kTransform.size()), matrix);
  }
  return {};
}

Status take_frames(const HeaderText& text, const std::string& where, ultrasound::TrackedSequence& sequence) {
  for (const auto& [number, fields] : text.frames) {
    for (const auto& [name, value] : fields) {
      const Status taken = take_field(fields, name, value, sequence.frames[number]);
      if (!taken)
        return fail(fmt::format("the field {}{:04}_{} {}", kFramePrefix, number, name, taken.error().what), where,
                    "mark it as INVALID or record it again");
    }
  }
  return {};
}

}  // namespace

Result<SequenceHeader> read_sequence_header(const InputFile& file) {
  const std::string where = file.path().string();
  TROCAR_TRY(const HeaderText text, read_text(file));
  SequenceHeader header;
  TROCAR_TRY_STATUS(take_size(text, where, header.sequence));
  TROCAR_TRY_STATUS(check_pixel_type(text.fields, where));
  TROCAR_TRY_STATUS(take_orientation(text.fields, where, header));
  TROCAR_TRY_STATUS(take_place_of_pixels(text, where, header));
  TROCAR_TRY_STATUS(take_frames(text, where, header.sequence));
  return header;
}

std::string sequence_header_text(const ultrasound::TrackedSequence& sequence, std::size_t packed_bytes) {
  std::string text = fmt::format(
      "ObjectType = Image\nNDims = 3\nAnatomicalOrientation = RAI\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "CenterOfRotation = 0 0 0\nCompressedData = True\nCompressedDataSize = {}\nDimSize = {} {} {}\n"
      "Kinds = domain domain list\nElementSpacing = 1 1 1\nElementType = MET_UCHAR\nOffset = 0 0 0\n"
      "TransformMatrix = 1 0 0 0 1 0 0 0 1\nUltrasoundImageOrientation = MFA\nUltrasoundImageType = BRIGHTNESS\n",
      packed_bytes, sequence.columns, sequence.rows, sequence.frames.size());
  std::set<std::string> names;
  for (const auto& frame : sequence.frames)
    for (const auto& [name, matrix] : frame.transforms) names.insert(name);
  for (std::size_t n = 0; n < sequence.frames.size(); ++n) {
    const ultrasound::TrackedSequence::Frame& frame = sequence.frames[n];
    const std::string prefix = fmt::format("{}{:04}_", kFramePrefix, n);
    for (const std::string& name : names) {
      const auto found = frame.transforms.find(name);
      const bool is_known = found != frame.transforms.end();
      const ultrasound::TrackedSequence::Matrix4 matrix =
          is_known ? found->second : ultrasound::TrackedSequence::Matrix4::Identity();
      text += prefix + name + "Transform =";
      for (int value = 0; value < 16; ++value) text += fmt::format(" {}", matrix(value / 4, value % 4));
      text += fmt::format("\n{}{}TransformStatus = {}\n", prefix, name, is_known ? "OK" : "INVALID");
    }
    text += fmt::format("{0}Timestamp = {1}\n{0}ImageStatus = {2}\n", prefix, frame.time_s,
                        frame.is_valid ? "OK" : "INVALID");
  }
  return text + "ElementDataFile = LOCAL\n";
}

}  // namespace trocar::io::detail
