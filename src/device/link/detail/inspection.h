#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/result.h"
#include "geometry/pose.h"
#include "link/codec.h"
#include "link/detail/messages_generated.h"

namespace trocar::link::detail {

enum class Layout { kLine, kLines };  ///< kLines: the text may contain tab, CR and newline.

/// True for valid UTF-8 (no overlong forms, surrogates or values beyond U+10FFFF) without C0, DEL and C1 control
/// characters.
bool is_plain_text(std::string_view text, Layout layout);

/// Closed interval.
struct Range {
  double low, high;
};

// Far above the values of real messages, and small enough that no later sum or square overflows. [assumed]
inline constexpr double kMostPosition_mm = 1e5;
inline constexpr double kMostTime_s = 1e10;  ///< 300 years of a steady clock.
inline constexpr Range kTimes_s = {-kMostTime_s, kMostTime_s};
inline constexpr Range kDurations_s = {0.0, kMostTime_s};
inline constexpr std::size_t kMostSettings = 256;  ///< Items in one list; the trainer uses some dozens. [assumed]
inline constexpr Range kMagnitudes = {0.0, 1e9};   ///< For values that are only displayed.

/// Reads and checks values of a verified but untrusted message, and keeps the first error (complaint). After an error,
/// values are empty or zero; every returned value is checked.
class Inspection {
 public:
  /// `text_budget`: limit of the bytes of all texts together, because a message can refer to one text many times.
  explicit Inspection(std::size_t text_budget) : text_budget_(text_budget) {}

  /// UTF-8 without control characters, at most kMostTextBytes. A missing text gives an empty one.
  std::string text(const flatbuffers::String* text, const char* field, Layout layout = Layout::kLine);
  /// Refuses a list of more than `most` items.
  bool has_room(std::size_t items, std::size_t most, const char* field);
  /// A list of at most kMostSettings lines. A missing list gives an empty one.
  std::vector<std::string> texts(const flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>* list,
                                 const char* field);
  double number(double value, Range range, const char* field);
  std::optional<double> number(std::optional<double> value, Range range, const char* field) {
    return value ? std::optional(number(*value, range, field)) : std::nullopt;
  }
  int whole_number(std::int32_t value, int low, int high, const char* field);
  /// A finite vector, at most `longest` long.
  Vec3 vector(const Vec3& vector, double longest, const char* field);
  Vec3 vector(const wire::Vec3& packed, double longest, const char* field);
  /// A pose whose rotation is orthonormal within 1e-6 (made exact if the error is above rounding) and whose position is
  /// at most kMostPosition_mm long.
  Pose pose(const wire::Pose& pose, const char* field);
  /// `last`: last value of the enumeration. An enumeration of the schema has the same values.
  template <class Enum>
  Enum enumerator(std::uint8_t value, Enum last, const char* field) {
    if (value <= static_cast<std::uint8_t>(last)) return static_cast<Enum>(value);
    refuse("a value that the enumeration does not have", field);
    return Enum{};
  }
  template <class WireEnum, class Enum>
  requires std::is_enum_v<WireEnum> Enum enumerator(WireEnum value, Enum last, const char* field) {
    static_assert(sizeof(WireEnum) == sizeof(std::uint8_t));
    return enumerator(static_cast<std::uint8_t>(value), last, field);
  }

  void refuse(std::string what, const char* field);
  bool is_valid() const { return !complaint_; }
  const std::optional<Error>& complaint() const { return complaint_; }

 private:
  std::size_t text_budget_;
  std::optional<Error> complaint_;
};

inline wire::Vec3 to_wire(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
inline Vec3 from_wire(const wire::Vec3& v) {
  return {v.x(), v.y(), v.z()};
}
wire::Pose to_wire(const Pose& pose);

inline constexpr char kClientIdentifier[] = "TRCC";  ///< File identifier of a client's message.
inline constexpr char kServerIdentifier[] = "TRCS";

/// An aligned copy of a message. Bytes from a socket may start at any address.
class AlignedBytes {
 public:
  explicit AlignedBytes(std::span<const std::byte> bytes);
  const std::uint8_t* data() const { return reinterpret_cast<const std::uint8_t*>(words_.data()); }
  std::size_t size() const { return size_; }

 private:
  std::vector<std::uint64_t> words_;  ///< Type with the strictest alignment in a message.
  std::size_t size_;
};

/// Check size, identifier and version before a byte is copied or another field is read.
Status check_size(std::size_t bytes);
Status check_frame(const AlignedBytes& bytes, const char* identifier);
flatbuffers::Verifier make_verifier(const AlignedBytes& bytes);

/// Returns the verified root; valid during the lifetime of `bytes`.
template <class Root>
Result<const Root*> find_root(const AlignedBytes& bytes, const char* identifier) {
  TROCAR_TRY_STATUS(check_frame(bytes, identifier));
  flatbuffers::Verifier verifier = make_verifier(bytes);
  if (!verifier.VerifyBuffer<Root>(identifier))
    return fail("a message that is cut or damaged", "link", "check the program on the other side");
  return flatbuffers::GetRoot<Root>(bytes.data());
}

/// A body as a member of the union in the root.
template <class Type>
using Member = std::pair<Type, flatbuffers::Offset<void>>;

/// Copies the built message out of the builder.
Bytes take_bytes(const flatbuffers::FlatBufferBuilder& builder);

/// FlatBuffers has 32-bit offsets; the built messages are far smaller.
using Builder = flatbuffers::FlatBufferBuilder;
using Text = flatbuffers::Offset<flatbuffers::String>;

}  // namespace trocar::link::detail
