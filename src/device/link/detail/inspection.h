#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "core/result.h"
#include "geometry/pose.h"
#include "link/detail/messages_generated.h"
#include "link/detail/plain_text.h"

namespace trocar::link::detail {

/// Both ends belong to it.
struct Range {
  double low, high;
};

// Far beyond what a real message holds, near enough that no later sum or square overflows. [assumed]
inline constexpr double kMostPosition_mm = 1e5;
inline constexpr double kMostTime_s = 1e10;  ///< 300 years of a steady clock.
inline constexpr Range kTimes_s = {-kMostTime_s, kMostTime_s};
inline constexpr Range kDurations_s = {0.0, kMostTime_s};
inline constexpr std::size_t kMostSettings = 256;  ///< In one list; the trainer has some dozens. [assumed]
inline constexpr Range kMagnitudes = {0.0, 1e9};   ///< Of what is only shown.

/// Takes values out of a verified message of strangers and keeps the first complaint. After a complaint values are
/// empty or zero; no value leaves it unchecked.
class Inspection {
 public:
  /// `text_budget`: bytes of all texts together, so that one text named often does not multiply.
  explicit Inspection(std::size_t text_budget) : text_budget_(text_budget) {}

  /// UTF-8 without control characters, at most kMostTextBytes; absent is empty.
  std::string text(const flatbuffers::String* text, const char* field, Layout layout = Layout::kLine);
  /// Refuses a list of more than `most` items.
  bool has_room(std::size_t items, std::size_t most, const char* field);
  /// A list of at most kMostSettings lines; absent is empty.
  std::vector<std::string> texts(const flatbuffers::Vector<flatbuffers::Offset<flatbuffers::String>>* list,
                                 const char* field);
  double number(double value, Range range, const char* field);
  std::optional<double> number(std::optional<double> value, Range range, const char* field) {
    return value ? std::optional(number(*value, range, field)) : std::nullopt;
  }
  int whole_number(std::int32_t value, int low, int high, const char* field);
  /// Finite, and no longer than `longest`.
  Vec3 vector(const Vec3& vector, double longest, const char* field);
  Vec3 vector(const wire::Vec3& packed, double longest, const char* field);
  /// A rotation that is one within 1e-6 (made exact when it is off by more than rounding), not too far away.
  Pose pose(const wire::Pose& pose, const char* field);
  /// `last` is the enumeration's last value; an enumeration of the schema has the same numbers.
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

}  // namespace trocar::link::detail
