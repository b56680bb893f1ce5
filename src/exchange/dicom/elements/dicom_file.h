#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "dicom/elements/element_walk.h"

namespace trocar::dicom {

inline constexpr std::size_t kPreamble = 128;  ///< Bytes of a file in front of the mark "DICM" (PS3.10, 7.1).

/// The elements of a data set, or of one item of a sequence: a view of the bytes of a DicomFile, valid as long as it.
/// Nothing is stored, so that memory does not grow with the number of elements: every call walks over the elements.
class DicomItem {
 public:
  DicomItem(std::string_view bytes, Encoding encoding) noexcept : bytes_(bytes), encoding_(encoding) {}

  /// Empty if the element is missing, or comes after damaged ones.
  std::optional<Element> find(std::uint32_t tag) const noexcept;
  /// Text without its padding; empty if the element is missing.
  std::string_view text(std::uint32_t tag) const noexcept;
  /// Unsigned short (US).
  std::optional<int> number(std::uint32_t tag) const noexcept;
  /// decimals_in(text(tag)).
  std::vector<double> decimals(std::uint32_t tag) const;
  /// The items of a sequence; none if it is missing. Errors (without a place): a damaged sequence, more than 2^20
  /// items.
  Result<std::vector<DicomItem>> items(std::uint32_t tag) const;
  /// The first item of a sequence, if there is one that is not damaged.
  std::optional<DicomItem> first_item(std::uint32_t tag) const noexcept;

 private:
  std::string_view bytes_;
  Encoding encoding_;
};

/// A DICOM file in memory. Every length was compared with the bytes that are there: the elements of the top level, and
/// all sequences of undefined length. Other sequences are checked when their items are read.
class DicomFile {
 public:
  /// Empty if the file is not DICOM; an error if it is a damaged or truncated DICOM file, or above the limit of size.
  static Result<std::optional<DicomFile>> read(const std::filesystem::path& path);

  std::string_view bytes() const noexcept { return bytes_; }
  /// The elements of the data set; their positions count from the start of bytes().
  ElementWalk elements() const noexcept {
    return {std::string_view(bytes_).substr(0, data_set_end_), encoding_, data_set_begin_};
  }
  /// The data set, without the meta information and without what follows the pixels.
  DicomItem root() const noexcept {
    return {std::string_view(bytes_).substr(data_set_begin_, data_set_end_ - data_set_begin_), encoding_};
  }
  /// Empty if the file does not name it.
  const std::string& transfer_syntax() const noexcept { return transfer_syntax_; }
  bool is_big_endian() const noexcept { return encoding_.is_big_endian; }
  bool is_deflated() const noexcept;  ///< Then the data set cannot be read and is empty.
  bool is_compressed() const noexcept { return is_compressed_; }
  /// One span if the pixels are not compressed, else the fragments without the offset table. Empty if there are no
  /// pixels.
  std::vector<std::span<const char>> pixels() const;

 private:
  bool parse();
  bool take_fragments(const Element& pixels);

  std::string bytes_;
  std::string transfer_syntax_;
  Encoding encoding_;
  std::size_t data_set_begin_ = 0;
  std::size_t data_set_end_ = 0;
  std::vector<Element> pixels_;
  bool is_compressed_ = false;
};

/// A text without the spaces and zeros that fill it up.
std::string_view without_padding(std::string_view text) noexcept;
/// The numbers of a decimal or integer string "a\b\c" (DS, IS). Empty if one of them is no finite number, or more than
/// that ("4,8", "4.8 mm").
std::vector<double> decimals_in(std::string_view text);
/// The value of an element US; empty for fewer than two bytes.
std::optional<int> unsigned_short(std::string_view value, bool is_big_endian) noexcept;
/// The text in UTF-8 by the character set of the data set (0008,0005): ISO 8859-1 is converted, what cannot be
/// converted becomes '?'.
std::string to_utf8(std::string_view text, std::string_view character_set);

}  // namespace trocar::dicom
