#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace trocar::dicom {

/// (group, element), for example tag(0x0028, 0x0010).
constexpr std::uint32_t tag(std::uint16_t group, std::uint16_t element) {
  return (static_cast<std::uint32_t>(group) << 16) | element;
}

inline constexpr std::uint32_t kTransferSyntax = tag(0x0002, 0x0010);
inline constexpr std::uint32_t kCharacterSet = tag(0x0008, 0x0005);
inline constexpr std::uint32_t kSeriesUid = tag(0x0020, 0x000e);
inline constexpr std::uint32_t kPixelData = tag(0x7fe0, 0x0010);
inline constexpr std::uint32_t kItem = tag(0xfffe, 0xe000);
inline constexpr std::uint32_t kItemEnd = tag(0xfffe, 0xe00d);
inline constexpr std::uint32_t kSequenceEnd = tag(0xfffe, 0xe0dd);
inline constexpr std::uint32_t kUndefinedLength = 0xffffffff;
inline constexpr int kMostNestedSequences = 32;

// UIDs of transfer syntaxes (PS3.5, annex A).
inline constexpr const char* kImplicitLittle = "1.2.840.10008.1.2";
inline constexpr const char* kExplicitBig = "1.2.840.10008.1.2.2";
inline constexpr const char* kDeflated = "1.2.840.10008.1.2.1.99";

/// How elements are written (PS3.5, annex A).
struct Encoding {
  bool is_big_endian = false;
  bool is_implicit = false;  ///< Without the letters of the value representation.
};

/// The place of an element in the bytes of its file.
struct Element {
  std::uint32_t tag = 0;
  std::size_t begin = 0;  ///< First byte of the value.
  std::size_t size = 0;   ///< Of the value, without the delimiter that ends an undefined length.
  bool has_undefined_length = false;
  Encoding inside;  ///< Encoding of the items, if the value is a sequence.
};

/// Iterates over the elements of one data set. Sequences of undefined length are skipped as a whole, after every length
/// in them was compared with the bytes that are there; they may be nested 32 deep. Elements as in DICOM PS3.5,
/// section 7.
class ElementWalk {
 public:
  enum class Step { kElement, kEnd, kDamaged };

  /// Walks over `bytes` from `at`. Positions of elements count from the start of `bytes`.
  ElementWalk(std::string_view bytes, Encoding encoding, std::size_t at = 0) noexcept
      : bytes_(bytes), encoding_(encoding), at_(at) {}

  /// Reads the next element and steps over its value. kEnd also with fewer than 8 bytes left: some writers pad the end.
  Step next(Element& element) noexcept;
  /// The same for the items of a sequence, or for the fragments of compressed pixels: elements without encoding.
  Step next_item(Element& item) noexcept;
  std::size_t at() const noexcept { return at_; }
  /// The group of the next element; 0 if there is none.
  std::uint32_t next_group() const noexcept { return left() < 8 ? 0 : peek(0, 2); }

 private:
  struct Start {
    std::uint32_t tag = 0;
    std::uint32_t length = 0;
    bool is_unknown = false;  ///< Value representation UN.
  };

  std::size_t left() const noexcept { return bytes_.size() - at_; }
  std::uint32_t peek(std::size_t offset, int count) const noexcept;
  bool read_start(Start& start, bool is_implicit) noexcept;
  bool skip(std::size_t length) noexcept;
  bool skip_sequence(bool is_implicit, int depth) noexcept;
  bool skip_item(bool is_implicit, int depth) noexcept;

  std::string_view bytes_;
  Encoding encoding_;
  std::size_t at_ = 0;
  std::size_t value_end_ = 0;  ///< End of the content of the sequence or item that was skipped last.
};

/// True for two capital letters, as every value representation has them.
bool is_value_representation(std::string_view text) noexcept;
/// True for value representations with a 32-bit length (PS3.5, 7.1.2).
bool has_long_length(std::string_view vr) noexcept;

}  // namespace trocar::dicom
