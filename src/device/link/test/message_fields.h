#pragma once

#include <type_traits>

#include "link/messages.h"
#include "telemetry/tick_fields.h"

namespace trocar::link {

/// Calls `visit` for every field of a struct of messages.h. A field that is added there but not here is a compile
/// error.
template <class T, class Visit>
void each_field(T& value, Visit&& visit) {
  using Plain = std::remove_const_t<T>;
  const auto all = [&](auto&... fields) { (visit(fields), ...); };
  if constexpr (std::is_same_v<Plain, Hello>) {
    auto& [a, b] = value;
    all(a, b);
  } else if constexpr (std::is_same_v<Plain, Heartbeat>) {
    auto& [a, b, c] = value;
    all(a, b, c);
  } else if constexpr (std::is_same_v<Plain, LoadScene>) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r] = value;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r);
  } else if constexpr (std::is_same_v<Plain, TissueSetting>) {
    auto& [a, b, c] = value;
    all(a, b, c);
  } else if constexpr (std::is_same_v<Plain, SetParameters>) {
    auto& [a, b, c, d, e, f, g] = value;
    all(a, b, c, d, e, f, g);
  } else if constexpr (std::is_same_v<Plain, motion::MotionDrive>) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o] = value;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o);
  } else if constexpr (std::is_same_v<Plain, Command>) {
    auto& [a, b] = value;
    all(a, b);
  } else if constexpr (std::is_same_v<Plain, HandTarget>) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p] = value;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p);
  } else if constexpr (std::is_same_v<Plain, DeviceSummary>) {
    auto& [a, b, c, d, e, f, g, h, i] = value;
    all(a, b, c, d, e, f, g, h, i);
  } else if constexpr (std::is_same_v<Plain, Welcome>) {
    auto& [a, b, c, d, e] = value;
    all(a, b, c, d, e);
  } else if constexpr (std::is_same_v<Plain, Reply>) {
    auto& [a, b, c, d, e, f] = value;
    all(a, b, c, d, e, f);
  } else if constexpr (std::is_same_v<Plain, Refusal>) {
    auto& [a] = value;
    all(a);
  } else if constexpr (std::is_same_v<Plain, Pong>) {
    auto& [a, b] = value;
    all(a, b);
  } else if constexpr (std::is_same_v<Plain, realtime::LatencySummary>) {
    auto& [a, b, c, d] = value;
    all(a, b, c, d);
  } else if constexpr (std::is_same_v<Plain, realtime::LoopSummary>) {
    auto& [a, b, c, d, e, f, g] = value;
    all(a, b, c, d, e, f, g);
  } else if constexpr (std::is_same_v<Plain, ServerStatus>) {
    auto& [a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u] = value;
    all(a, b, c, d, e, f, g, h, i, j, k, l, m, n, o, p, q, r, s, t, u);
  } else if constexpr (std::is_same_v<Plain, telemetry::TickEvent>) {
    auto& [a, b] = value;
    all(a, b);
  } else if constexpr (std::is_same_v<Plain, telemetry::TickSample>) {
    telemetry::for_each_tick_field([&](const auto& field) { visit(value.*field.member); });
  } else if constexpr (std::is_same_v<Plain, StateBatch>) {
    auto& [a, b, c, d, e] = value;
    all(a, b, c, d, e);
  } else if constexpr (std::is_same_v<Plain, telemetry::NeedleShape>) {
    visit(value.time_s);
    visit(value.spans);
    for (auto& [x, y] : value.beside_mm) all(x, y);
  } else {
    static_assert(std::is_same_v<Plain, Goodbye>);
  }
}

}  // namespace trocar::link
