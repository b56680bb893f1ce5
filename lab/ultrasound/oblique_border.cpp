#include "lab/ultrasound/oblique_border.h"

#include <algorithm>
#include <cmath>

namespace trocar::ultrasound {
namespace {

constexpr double kFirst_mm = 60.0;
constexpr double kInFront_mm = 15.0, kGap_mm = 4.0;  ///< Where the organ's level is measured.
constexpr double kLeastAbove = 30.0;                 ///< Gray.
constexpr int kReach = 6;                            ///< Scanlines to each side for the slope.

struct Peak {
  int sample = -1;
  double gray = 0.0;
};

Peak brightest_peak(const EchoPatch& polar, int line) {
  Peak peak;
  for (int s = static_cast<int>(kFirst_mm / polar.sample_mm); s < polar.samples; ++s)
    if (polar.at(line, s) > peak.gray) peak = {s, polar.at(line, s)};
  return peak;
}

double mean_in_front(const EchoPatch& polar, int line, int sample) {
  const int end = sample - static_cast<int>(kGap_mm / polar.sample_mm);
  const int begin = std::max(0, end - static_cast<int>(kInFront_mm / polar.sample_mm));
  double sum = 0.0;
  for (int s = begin; s < end; ++s) sum += polar.at(line, s);
  return end > begin ? sum / (end - begin) : 0.0;
}

double extent_mm(const EchoPatch& polar, int line, int sample, double level) {
  int first = sample, last = sample;
  while (first > 0 && polar.at(line, first - 1) > level) --first;
  while (last + 1 < polar.samples && polar.at(line, last + 1) > level) ++last;
  return (last - first + 1) * polar.sample_mm;
}

}  // namespace

std::vector<ObliqueBorder> find_oblique_borders(const EchoPatch& polar, const ScanGeometry& scan) {
  std::vector<Peak> peaks;
  for (int line = 0; line < polar.lines; ++line) peaks.push_back(brightest_peak(polar, line));
  std::vector<ObliqueBorder> borders;
  for (int line = kReach; line + kReach < polar.lines; ++line) {
    const Peak& peak = peaks[static_cast<std::size_t>(line)];
    if (peak.sample < 0) continue;
    const double depth_mm = (peak.sample + 0.5) * polar.sample_mm;
    const double spacing_mm = scan.line_spacing_mm(depth_mm) * (scan.lines - 1) / (polar.lines - 1);
    const double before = peaks[static_cast<std::size_t>(line - kReach)].sample,
                 behind = peaks[static_cast<std::size_t>(line + kReach)].sample;
    const double bow_mm = std::abs(0.5 * (before + behind) - peak.sample) * polar.sample_mm;
    constexpr double kMostBow_mm = 1.5;
    if (before < 0.0 || behind < 0.0 || bow_mm > kMostBow_mm) continue;
    const double organ = mean_in_front(polar, line, peak.sample);
    if (peak.gray - organ < kLeastAbove) continue;
    ObliqueBorder border;
    border.above_gray = peak.gray - organ;
    border.incidence_rad = std::atan(std::abs(behind - before) * polar.sample_mm / (2.0 * kReach * spacing_mm));
    border.thickness_mm =
        extent_mm(polar, line, peak.sample, 0.5 * (peak.gray + organ)) * std::cos(border.incidence_rad);
    borders.push_back(border);
  }
  return borders;
}

}  // namespace trocar::ultrasound
