#pragma once

#include <array>
#include <optional>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "link/test/message_fields.h"

namespace trocar::link {

/// A set of overloaded functions, one per type.
template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

/// Visits the values of a message recursively. A value that `visit` accepts (by T&) is passed to it and not descended
/// into; a leaf that it does not accept is skipped.
template <class Visit>
class FieldWalk {
 public:
  explicit FieldWalk(Visit& visit) : visit_(visit) {}

  template <class T>
  void go(T& value) {
    if constexpr (std::is_invocable_v<Visit&, T&>) {
      visit_(value);
    } else if constexpr (!std::is_arithmetic_v<T> && !std::is_enum_v<T> && !std::is_same_v<T, std::string>) {
      into(value);
    }
  }

 private:
  void into(Vec3& v) { go(v.x()), go(v.y()), go(v.z()); }
  void into(Pose& pose) {
    Mat3 R = pose.R();
    Vec3 p = pose.p();
    for (double& entry : R.reshaped()) go(entry);
    go(p);
    pose = Pose(R, p);
  }
  template <class... Alternatives>
  void into(std::variant<Alternatives...>& variant) {
    std::visit([this](auto& alternative) { go(alternative); }, variant);
  }
  template <class T>
  void into(std::optional<T>& value) {
    if (value) go(*value);
  }
  template <class T>
  void into(std::vector<T>& list) {
    for (T& item : list) go(item);
  }
  template <class T, std::size_t N>
  void into(std::array<T, N>& list) {
    for (T& item : list) go(item);
  }
  template <class Struct>
  void into(Struct& value) {
    each_field(value, [this](auto& field) { go(field); });
  }

  Visit& visit_;
};

template <class Body, class Visit>
void walk(Envelope<Body>& message, Visit visit) {
  FieldWalk<Visit>(visit).go(message.body);
}

}  // namespace trocar::link
