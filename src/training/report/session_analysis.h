#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "storage/session_file.h"

namespace trocar::report {

/// A punctured layer.
struct Puncture {
  std::size_t tick = 0;
  std::string layer;
  double time_s = 0.0;
  double depth_mm = 0.0;
  double layer_force_n = 0.0;  ///< Force on the tip at the puncture.
  double resistance_n = 0.0;   ///< Sum of all axial forces at that tick.
  double drop_n = 0.0;         ///< Fall of the resistance within the next 0.1 s, before another puncture.
};
std::vector<Puncture> find_punctures(const storage::Session& session);

/// One insertion of the needle: the ticks from the first contact to the last tick before the needle is outside again.
struct Insertion {
  std::size_t first = 0;
  std::size_t deepest = 0;  ///< Tick of the greatest depth.
  std::size_t last = 0;
};
/// Insertions that reached at least `min_depth_mm`, in order.
std::vector<Insertion> find_insertions(const storage::Session& session, double min_depth_mm = 1.0);

/// An interval of one tissue along the path of the tip.
struct TissueRun {
  double from_mm = 0.0;
  double to_mm = 0.0;
  std::uint8_t tissue = 0;
};
/// Tissues that the tip passed during insertion, by depth: each depth counts when it is reached for the first time.
std::vector<TissueRun> tissues_along(const storage::Session& session, const Insertion& insertion);

/// An interval of one phase.
struct PhaseRun {
  double from_s = 0.0;
  double to_s = 0.0;
  telemetry::InsertionPhase phase = telemetry::InsertionPhase::kOutside;
};
std::vector<PhaseRun> phase_runs(const storage::Session& session);

/// Name of a tissue id; "#7" if the session has none.
std::string tissue_name(const storage::SessionInfo& info, std::uint8_t id);

}  // namespace trocar::report
