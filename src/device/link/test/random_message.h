#pragma once

#include <array>
#include <bit>
#include <limits>
#include <string>

#include "core/random.h"
#include "link/test/message_fields.h"

namespace trocar::link {

/// Seeded random messages that a decoder must accept: every field differs from its default, texts have characters of
/// one to four bytes, and forces may be NaN or infinite.
class RandomMessages {
 public:
  explicit RandomMessages(std::uint64_t seed) : random_(seed) {}

  ClientMessage client_message() { return {random_.next(), random_.next(), any<ClientBody>()}; }
  ServerMessage server_message() { return {random_.next(), random_.next(), any<ServerBody>()}; }
  /// One message of every kind of body, and of every command.
  std::vector<ClientMessage> client_messages();
  std::vector<ServerMessage> server_messages();

  template <class T>
  T some() {
    T value;
    fill(value);
    return value;
  }

 private:
  static constexpr std::size_t kMostItems = 6;
  std::size_t below(std::size_t end) { return static_cast<std::size_t>(random_.next() % end); }

  /// The alternative `index` of a variant, with random content.
  template <class Variant, std::size_t... I>
  Variant alternative(std::size_t index, std::index_sequence<I...>) {
    Variant variant;
    ((index == I ? static_cast<void>(variant = some<std::variant_alternative_t<I, Variant>>()) : void()), ...);
    return variant;
  }
  template <class Variant>
  Variant alternative(std::size_t index) {
    return alternative<Variant>(index, std::make_index_sequence<std::variant_size_v<Variant>>());
  }
  template <class Variant>
  Variant any() {
    return alternative<Variant>(below(std::variant_size_v<Variant>));
  }

  void fill(bool& value) { value = random_.next() % 2 == 0; }
  /// A value within the range of every field; sometimes negative zero.
  void fill(double& value) { value = below(16) == 0 ? -0.0 : random_.uniform(); }
  void fill(int& value) { value = static_cast<int>(below(7)); }
  void fill(std::uint8_t& value) { value = static_cast<std::uint8_t>(random_.next()); }
  void fill(std::uint32_t& value) { value = static_cast<std::uint32_t>(random_.next()); }
  void fill(std::uint64_t& value) { value = random_.next(); }
  /// An enumeration of telemetry.
  template <class Enum>
  requires requires(Enum value) { last_of(value); }
  void fill(Enum& value) { value = static_cast<Enum>(below(static_cast<std::size_t>(last_of(value)) + 1)); }
  void fill(ServerState& value) {
    value = static_cast<ServerState>(below(static_cast<std::size_t>(kLastServerState) + 1));
  }
  void fill(ServerCommand& value) {
    value = static_cast<ServerCommand>(below(static_cast<std::size_t>(kLastServerCommand) + 1));
  }
  void fill(std::string& text) {
    constexpr std::array<const char*, 5> kCharacters = {"n", "=", "ä", "→", "𝛿"};
    for (std::size_t n = below(20); n > 0; --n) text += kCharacters[below(kCharacters.size())];
  }
  void fill(Vec3& v) { v = Vec3(random_.normal(), random_.normal(), random_.normal()).normalized(); }
  void fill(Pose& pose) {
    const Eigen::Quaterniond q(random_.normal(), random_.normal(), random_.normal(), random_.normal());
    pose = Pose(q.normalized().toRotationMatrix(), 1000.0 * some<Vec3>());
  }
  void fill(motion::MotionDrive& drive) {
    each_field(drive, [this](auto& field) { fill(field); });
    drive.period_s = 1.0 + std::abs(drive.period_s);
    drive.hold_limit_s = 1.0 + std::abs(drive.hold_limit_s);
    drive.first_depth = 1.0 + std::abs(drive.first_depth);
    drive.pause_share *= 0.6;
    drive.irregularity *= 0.4;
    drive.drift_per_s *= 0.1;
    drive.cough_every_s = below(2) == 0 ? 0.0 : 5.0 + std::abs(drive.cough_every_s);
  }
  void fill(LoadScene& scene) {
    each_field(scene, [this](auto& field) { fill(field); });
    scene.tissues_toml += "\r\n\tk = 0.5\n";
  }
  void fill(SetParameters& parameters) {
    each_field(parameters, [this](auto& field) { fill(field); });
    parameters.tissues_toml += "\n";
  }
  void fill(Reply& reply) {
    each_field(reply, [this](auto& field) { fill(field); });
    reply.tissues_toml += "\n";
  }
  void fill(telemetry::TickSample& sample) {
    each_field(sample, [this](auto& field) { fill(field); });
    using Limits = std::numeric_limits<double>;
    const double other_nan = std::bit_cast<double>(0xFFF8'0000'DEAD'BEEFULL);
    const std::array odd = {Limits::quiet_NaN(), other_nan, Limits::infinity(), -0.0, Limits::denorm_min()};
    sample.f_friction_n = odd[below(odd.size())];
    sample.device_f_n.y() = odd[below(odd.size())];
    sample.device_rotation_wxyz[3] = odd[below(odd.size())];
  }
  void fill(telemetry::NeedleShape& shape) {
    fill(shape.time_s);
    shape.spans = static_cast<std::uint8_t>(below(telemetry::NeedleShape::kMostSpans + 1));
    for (std::size_t i = 0; i < shape.spans; ++i)
      shape.beside_mm[i] = {static_cast<float>(random_.normal()), static_cast<float>(random_.normal())};
  }
  template <class T>
  void fill(std::optional<T>& value) {
    if (random_.next() % 2 == 0) value = some<T>();
  }
  template <class T>
  void fill(std::vector<T>& list) {
    list.resize(below(kMostItems));
    for (T& item : list) fill(item);
  }
  template <class T, std::size_t N>
  void fill(std::array<T, N>& list) {
    for (T& item : list) fill(item);
  }
  template <class... Alternatives>
  void fill(std::variant<Alternatives...>& variant) {
    variant = any<std::variant<Alternatives...>>();
  }
  template <class Struct>
  void fill(Struct& value) {
    each_field(value, [this](auto& field) { fill(field); });
  }

  Random random_;
};

inline std::vector<ClientMessage> RandomMessages::client_messages() {
  std::vector<ClientMessage> messages;
  for (std::size_t i = 0; i < std::variant_size_v<ClientBody>; ++i) {
    messages.push_back({random_.next(), random_.next(), alternative<ClientBody>(i)});
  }
  using What = decltype(Command::what);
  for (std::size_t i = 0; i < std::variant_size_v<What>; ++i) {
    messages.push_back({1, random_.next(), Command{some<std::uint32_t>(), alternative<What>(i)}});
  }
  return messages;
}

inline std::vector<ServerMessage> RandomMessages::server_messages() {
  std::vector<ServerMessage> messages;
  for (std::size_t i = 0; i < std::variant_size_v<ServerBody>; ++i) {
    messages.push_back({random_.next(), random_.next(), alternative<ServerBody>(i)});
  }
  messages.push_back({1, 2, StateBatch{3, {some<telemetry::TickSample>()}, some<ServerStatus>()}});
  return messages;
}

}  // namespace trocar::link
