#include "dicom/elements/element_walk.h"

#include <algorithm>
#include <array>

namespace trocar::dicom {
namespace {

bool is_capital(char letter) noexcept {
  return letter >= 'A' && letter <= 'Z';
}

}  // namespace

bool is_value_representation(std::string_view text) noexcept {
  return text.size() == 2 && is_capital(text[0]) && is_capital(text[1]);
}

bool has_long_length(std::string_view vr) noexcept {
  constexpr std::array<std::string_view, 13> kLong = {"OB", "OW", "OF", "OD", "OL", "OV", "SQ",
                                                      "UC", "UR", "UT", "UN", "SV", "UV"};
  return std::find(kLong.begin(), kLong.end(), vr) != kLong.end();
}

std::uint32_t ElementWalk::peek(std::size_t offset, int count) const noexcept {
  std::uint32_t value = 0;
  for (int n = 0; n < count; ++n) {
    const auto byte = static_cast<unsigned char>(bytes_[at_ + offset + static_cast<std::size_t>(n)]);
    value |= static_cast<std::uint32_t>(byte) << 8 * (encoding_.is_big_endian ? count - 1 - n : n);
  }
  return value;
}

bool ElementWalk::read_start(Start& start, bool is_implicit) noexcept {
  if (left() < 8) return false;
  start.tag = tag(static_cast<std::uint16_t>(peek(0, 2)), static_cast<std::uint16_t>(peek(2, 2)));
  start.is_unknown = false;
  if (is_implicit || start.tag >> 16 == 0xfffe) {
    start.length = peek(4, 4);
    at_ += 8;
    return true;
  }
  const std::string_view vr = bytes_.substr(at_ + 4, 2);
  if (!is_value_representation(vr)) return false;
  if (!has_long_length(vr)) {
    start.length = peek(6, 2);
    at_ += 8;
    return true;
  }
  if (left() < 12) return false;
  start.length = peek(8, 4);
  // An unknown value of undefined length is encoded like an implicit one (PS3.5, 6.2.2).
  start.is_unknown = vr == "UN";
  at_ += 12;
  return true;
}

bool ElementWalk::skip(std::size_t length) noexcept {
  if (length > left()) return false;
  at_ += length;
  return true;
}

bool ElementWalk::skip_sequence(bool is_implicit, int depth) noexcept {
  if (depth > kMostNestedSequences) return false;
  while (true) {
    const std::size_t end = at_;
    Start item;
    if (!read_start(item, true)) return false;
    if (item.tag == kSequenceEnd) {
      value_end_ = end;
      return true;
    }
    if (item.tag != kItem) return false;
    if (!(item.length == kUndefinedLength ? skip_item(is_implicit, depth) : skip(item.length))) return false;
  }
}

bool ElementWalk::skip_item(bool is_implicit, int depth) noexcept {
  while (true) {
    const std::size_t end = at_;
    Start element;
    if (!read_start(element, is_implicit)) return false;
    if (element.tag == kItemEnd) {
      value_end_ = end;
      return true;
    }
    const bool is_done = element.length == kUndefinedLength
                             ? skip_sequence(is_implicit || element.is_unknown, depth + 1)
                             : skip(element.length);
    if (!is_done) return false;
  }
}

ElementWalk::Step ElementWalk::next(Element& element) noexcept {
  if (left() < 8) return Step::kEnd;
  Start start;
  if (!read_start(start, encoding_.is_implicit)) return Step::kDamaged;
  element.tag = start.tag;
  element.begin = at_;
  element.has_undefined_length = start.length == kUndefinedLength;
  element.inside = encoding_;
  if (start.is_unknown) element.inside.is_implicit = true;
  const bool is_done = element.has_undefined_length ? skip_sequence(element.inside.is_implicit, 0) : skip(start.length);
  if (!is_done) return Step::kDamaged;
  element.size = element.has_undefined_length ? value_end_ - element.begin : start.length;
  return Step::kElement;
}

ElementWalk::Step ElementWalk::next_item(Element& item) noexcept {
  if (left() == 0) return Step::kEnd;
  Start start;
  if (!read_start(start, true)) return Step::kDamaged;
  if (start.tag == kSequenceEnd) return Step::kEnd;
  if (start.tag != kItem) return Step::kDamaged;
  item.tag = start.tag;
  item.begin = at_;
  item.has_undefined_length = start.length == kUndefinedLength;
  item.inside = encoding_;
  if (!(item.has_undefined_length ? skip_item(encoding_.is_implicit, 0) : skip(start.length))) return Step::kDamaged;
  item.size = item.has_undefined_length ? value_end_ - item.begin : start.length;
  return Step::kElement;
}

}  // namespace trocar::dicom
