#pragma once

#include <optional>
#include <vector>

namespace trocar::metrics::detail {

/// Spectral arc length of a speed profile at equal intervals (Balasubramanian 2015): minus the length of the amplitude
/// spectrum, divided by its value at 0 Hz, over the frequency divided by the highest one. The highest frequency is the
/// last one up to 10 Hz at which the spectrum is 0.05 or more. 0 would be perfectly smooth. Empty: no motion.
std::optional<double> spectral_arc_length(const std::vector<double>& speed, double period_s);

}  // namespace trocar::metrics::detail
