#pragma once

#include <array>
#include <bit>
#include <string>

#include "link/test/message_fields.h"

namespace trocar::link {

/// All fields of a message, bit for bit, as text: two messages are equal if their fingerprints are equal.
class Fingerprint {
 public:
  template <class Body>
  explicit Fingerprint(const Envelope<Body>& message) {
    add(message.session);
    add(message.sequence);
    add(message.body);
  }
  explicit Fingerprint(const telemetry::TickSample& sample) { add(sample); }
  const std::string& text() const { return text_; }
  bool operator==(const Fingerprint&) const = default;

 private:
  void add(const std::string& text) { text_ += text + '|'; }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
  void add(float value) { add(static_cast<double>(value)); }
  void add(const Vec3& v) { add(v.x()), add(v.y()), add(v.z()); }
  void add(const Pose& pose) {
    for (const double entry : pose.R().reshaped()) add(entry);
    add(pose.p());
  }
  template <class... Alternatives>
  void add(const std::variant<Alternatives...>& variant) {
    add(variant.index());
    std::visit([this](const auto& alternative) { add(alternative); }, variant);
  }
  template <class T>
  void add(const std::optional<T>& value) {
    add(value.has_value());
    if (value) add(*value);
  }
  template <class T>
  void add(const std::vector<T>& list) {
    add(list.size());
    for (const T& item : list) add(item);
  }
  template <class T, std::size_t N>
  void add(const std::array<T, N>& list) {
    for (const T& item : list) add(item);
  }
  template <class T>
  void add(const T& value) {
    if constexpr (std::is_enum_v<T>) {
      add(static_cast<std::underlying_type_t<T>>(value));
    } else if constexpr (std::is_integral_v<T>) {
      add(std::to_string(value));
    } else {
      each_field(value, [this](const auto& field) { add(field); });
    }
  }

  std::string text_;
};

}  // namespace trocar::link
