#include "link/detail/wire_sample.h"

#include <bit>
#include <cstring>

namespace trocar::link::detail {
namespace {

using telemetry::Quaternion;
using telemetry::TickEvents;
using telemetry::TickLimit;

constexpr double kLongestAxis = 2.0;  ///< A unit vector with room for rounding and for a tick without one (zero).
static_assert(std::endian::native == std::endian::little, "FlatBuffers stores little-endian numbers");

void put(std::byte* to, double value) {
  std::memcpy(to, &value, sizeof value);
}
void put(std::byte* to, const Vec3& value) {
  std::memcpy(to, value.data(), 3 * sizeof(double));
}
void put(std::byte* to, const Quaternion& value) {
  std::memcpy(to, value.data(), sizeof value);
}
void put(std::byte* to, const TickEvents& events) {
  for (const telemetry::TickEvent& event : events) {
    *to++ = static_cast<std::byte>(event.kind);
    *to++ = static_cast<std::byte>(event.id);
  }
}
template <class ByteValue>
requires(sizeof(ByteValue) == 1) void put(std::byte* to, ByteValue value) {
  *to = static_cast<std::byte>(value);
}

/// Takes one field out of a sample's bytes into `value`.
struct Taken {
  const std::byte* from;
  const char* name;
  TickLimit limit;
  Inspection& inspection;

  void into(double& value) const {
    std::memcpy(&value, from, sizeof value);
    if (limit == TickLimit::kTime) value = inspection.number(value, kTimes_s, name);
  }
  void into(Vec3& value) const {
    std::memcpy(value.data(), from, 3 * sizeof(double));
    if (limit == TickLimit::kPosition) value = inspection.vector(value, kMostPosition_mm, name);
    if (limit == TickLimit::kAxis) value = inspection.vector(value, kLongestAxis, name);
  }
  void into(Quaternion& value) const { std::memcpy(value.data(), from, sizeof value); }
  void into(TickEvents& events) const {
    const std::byte* next = from;
    for (telemetry::TickEvent& event : events) {
      const auto kind = std::to_integer<std::uint8_t>(*next++);
      event.kind = inspection.enumerator(kind, last_of(event.kind), name);
      event.id = std::to_integer<std::uint8_t>(*next++);
    }
  }
  void into(std::uint8_t& value) const { value = std::to_integer<std::uint8_t>(*from); }
  void into(bool& value) const { value = *from != std::byte{0}; }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void into(Enum& value) const {
    value = inspection.enumerator(std::to_integer<std::uint8_t>(*from), last_of(value), name);
  }
};

}  // namespace

void write_sample(const telemetry::TickSample& sample, wire::Sample& packed) noexcept {
  auto* bytes = reinterpret_cast<std::byte*>(&packed);
  for_each_wire_field([&](const auto& field, std::size_t offset) { put(bytes + offset, sample.*field.member); });
  std::memset(bytes + kWireBytes, 0, sizeof packed - kWireBytes);
}

void read_sample(const wire::Sample& packed, Inspection& inspection, telemetry::TickSample& sample) {
  const auto* bytes = reinterpret_cast<const std::byte*>(&packed);
  for_each_wire_field([&](const auto& field, std::size_t offset) {
    Taken{bytes + offset, field.name, field.limit, inspection}.into(sample.*field.member);
  });
}

}  // namespace trocar::link::detail
