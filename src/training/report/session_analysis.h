#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "storage/session_file.h"

namespace trocar::report {

/// A layer that gave way.
struct Puncture {
  std::size_t tick = 0;
  std::string layer;
  double time_s = 0.0;
  double depth_mm = 0.0;
  double layer_force_n = 0.0;  ///< On the tip when the layer gave way.
  double resistance_n = 0.0;   ///< Of all axial forces at that tick.
  double drop_n = 0.0;         ///< Fall of the resistance within the next 0.1 s, before another layer gives way.
};
std::vector<Puncture> find_punctures(const storage::Session& session);

/// A stay of the needle in the body: the ticks from first contact to the last before it is outside again.
struct Insertion {
  std::size_t first = 0;
  std::size_t deepest = 0;  ///< Tick of the greatest depth.
  std::size_t last = 0;
};
/// Insertions that reached at least `min_depth_mm`, in order.
std::vector<Insertion> find_insertions(const storage::Session& session, double min_depth_mm = 1.0);

/// A run of one tissue along the way of the tip.
struct TissueRun {
  double from_mm = 0.0;
  double to_mm = 0.0;
  std::uint8_t tissue = 0;
};
/// Tissues that the tip passed during insertion, by depth: each depth counts when it is reached for the first time.
std::vector<TissueRun> tissues_along(const storage::Session& session, const Insertion& insertion);

/// A run of one phase.
struct PhaseRun {
  double from_s = 0.0;
  double to_s = 0.0;
  telemetry::InsertionPhase phase = telemetry::InsertionPhase::kOutside;
};
std::vector<PhaseRun> phase_runs(const storage::Session& session);

/// Name of a tissue id; "#7" where the session has none.
std::string tissue_name(const storage::SessionInfo& info, std::uint8_t id);

}  // namespace trocar::report
