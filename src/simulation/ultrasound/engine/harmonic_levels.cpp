#include "ultrasound/engine/harmonic_levels.h"

#include <algorithm>
#include <cmath>

namespace trocar::ultrasound {

std::vector<float> harmonic_levels(const Beam& beam, const ScanGeometry& geometry) {
  // Between depths of a table: harmonic_share() integrates from the face each time.
  constexpr double kStep_mm = 2.0;
  const double at_focus = harmonic_share(beam, beam.focus_mm);
  std::vector<double> table;
  for (double depth_mm = 0.0; depth_mm < geometry.depth_mm + 2.0 * kStep_mm; depth_mm += kStep_mm)
    table.push_back(harmonic_share(beam, depth_mm) / at_focus);
  std::vector<float> levels;
  for (int s = 0; s < geometry.samples; ++s) {
    const double place = (static_cast<double>(s) + 0.5) * geometry.sample_mm() / kStep_mm;
    const auto below = static_cast<std::size_t>(place);
    const double part = place - static_cast<double>(below);
    levels.push_back(static_cast<float>(table[below] + part * (table[below + 1] - table[below])));
  }
  return levels;
}

double harmonic_gain_db(float level) noexcept {
  constexpr double kLeast = 1e-6;
  return std::min(-20.0 * std::log10(std::max(static_cast<double>(level), kLeast)), kMostHarmonicGain_db);
}

}  // namespace trocar::ultrasound
