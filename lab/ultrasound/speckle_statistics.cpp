#include "lab/ultrasound/speckle_statistics.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/result.h"
#include "ultrasound/engine/b_mode.h"

namespace trocar::ultrasound {
namespace {

double mean_of(std::span<const float> values) {
  double sum = 0.0;
  for (const float value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

/// Derivative of ln Gamma for x > 0: upward recurrence, then its asymptotic series (Abramowitz & Stegun 6.3.18).
double digamma(double x) {
  double shift = 0.0;
  constexpr double kAsymptotic = 8.0;
  while (x < kAsymptotic) shift -= 1.0 / x++;
  const double square = 1.0 / (x * x);
  return shift + std::log(x) - 0.5 / x - square * (1.0 / 12.0 - square * (1.0 / 120.0 - square / 252.0));
}

/// The m with ln m - digamma(m) equal to the mean of ln(mean intensity / intensity). It decreases with m, so bisection
/// converges.
double most_likely_m(std::span<const float> envelope, double mean_intensity) {
  const double floor = mean_intensity * 1e-12;
  double mean_log = 0.0;
  for (const float a : envelope) mean_log += std::log(std::max(floor, static_cast<double>(a) * a));
  const double target = std::log(mean_intensity) - mean_log / static_cast<double>(envelope.size());
  double low = 0.01;
  double high = 1000.0;
  constexpr int kHalvings = 60;
  for (int i = 0; i < kHalvings; ++i) {
    const double m = std::sqrt(low * high);
    (std::log(m) - digamma(m) > target ? low : high) = m;
  }
  return std::sqrt(low * high);
}

/// Autocovariance at shifts 0, 1, .. up to half the patch along one direction, divided by that at 0.
std::vector<double> autocovariance(const EchoPatch& patch, double mean, bool is_axial) {
  const int length = is_axial ? patch.samples : patch.lines;
  std::vector<double> covariance(static_cast<std::size_t>(std::max(1, length / 2)), 0.0);
  for (std::size_t shift = 0; shift < covariance.size(); ++shift) {
    const int by = static_cast<int>(shift);
    const int lines = patch.lines - (is_axial ? 0 : by);
    const int samples = patch.samples - (is_axial ? by : 0);
    double sum = 0.0;
    for (int line = 0; line < lines; ++line)
      for (int sample = 0; sample < samples; ++sample) {
        const float other = is_axial ? patch.at(line, sample + by) : patch.at(line + by, sample);
        sum += (patch.at(line, sample) - mean) * (other - mean);
      }
    covariance[shift] = sum / (static_cast<double>(lines) * samples);
  }
  const double variance = covariance.front();
  if (variance > 0.0)
    for (double& value : covariance) value /= variance;
  return covariance;
}

/// Position of half the maximum between shifts i - 1 and i: on the Gaussian through both values, or linear if there is
/// none.
double half_height_shift(std::size_t i, double before, double here) {
  const auto x1 = static_cast<double>(i);
  const double x0 = x1 - 1.0;
  if (here <= 0.0) return x0 + (before - 0.5) / (before - here);
  const double part = std::log(2.0 * before) / std::log(before / here);
  return std::sqrt(x0 * x0 + part * (x1 * x1 - x0 * x0));
}

struct Widths {
  double fwhm = 0.0;
  double cell = 0.0;
};
/// In steps. The cell's integral ends at the first zero of the curve; beyond is noise.
Widths widths_of(const std::vector<double>& covariance) {
  Widths widths{std::numeric_limits<double>::quiet_NaN(), 1.0};
  for (std::size_t i = 1; i < covariance.size(); ++i) {
    const double before = covariance[i - 1];
    const double here = covariance[i];
    if (std::isnan(widths.fwhm) && here < 0.5) widths.fwhm = 2.0 * half_height_shift(i, before, here);
    if (here <= 0.0) break;
    widths.cell += 2.0 * here;
  }
  return widths;
}

constexpr int kTrendTerms = 6;
Eigen::Matrix<double, kTrendTerms, 1> trend_terms(const EchoPatch& patch, int line, int sample) {
  const double x = 2.0 * line / std::max(1, patch.lines - 1) - 1.0;
  const double y = 2.0 * sample / std::max(1, patch.samples - 1) - 1.0;
  Eigen::Matrix<double, kTrendTerms, 1> terms;
  terms << 1.0, x, y, x * x, x * y, y * y;
  return terms;
}

}  // namespace

EchoPatch envelope_patch(const BasebandFrame& frame, const PatchBounds& bounds) {
  const ScanGeometry& scan = frame.geometry;
  const int first_line = std::clamp(bounds.first_line, 0, scan.lines);
  const int last_line = std::clamp(bounds.last_line, first_line, scan.lines);
  const auto sample_at = [&](double depth_mm) {
    return std::clamp(static_cast<int>(std::lround(depth_mm / scan.sample_mm())), 0, scan.samples);
  };
  const int first = sample_at(bounds.near_mm);
  const int last = std::max(first, sample_at(bounds.far_mm));
  EchoPatch patch;
  patch.lines = last_line - first_line;
  patch.samples = last - first;
  patch.sample_mm = scan.sample_mm();
  patch.depth_mm = (first + 0.5) * scan.sample_mm();
  patch.line_mm = scan.line_spacing_mm(patch.depth_mm + 0.5 * (patch.samples - 1) * patch.sample_mm);
  patch.values.reserve(static_cast<std::size_t>(patch.lines) * static_cast<std::size_t>(patch.samples));
  for (int line = first_line; line < last_line; ++line)
    for (int sample = first; sample < last; ++sample) {
      const std::size_t at =
          static_cast<std::size_t>(line) * static_cast<std::size_t>(scan.samples) + static_cast<std::size_t>(sample);
      patch.values.push_back(std::hypot(frame.re[at], frame.im[at]));
    }
  return patch;
}

EchoPatch intensity_of(const EchoPatch& envelope) {
  EchoPatch intensity = envelope;
  for (float& value : intensity.values) value *= value;
  return intensity;
}

EchoPatch without_trend(const EchoPatch& patch) {
  Eigen::Matrix<double, kTrendTerms, kTrendTerms> normal = Eigen::Matrix<double, kTrendTerms, kTrendTerms>::Zero();
  Eigen::Matrix<double, kTrendTerms, 1> right = Eigen::Matrix<double, kTrendTerms, 1>::Zero();
  for (int line = 0; line < patch.lines; ++line)
    for (int sample = 0; sample < patch.samples; ++sample) {
      const auto terms = trend_terms(patch, line, sample);
      normal += terms * terms.transpose();
      right += terms * static_cast<double>(patch.at(line, sample));
    }
  const Eigen::Matrix<double, kTrendTerms, 1> trend = normal.ldlt().solve(right);
  const double mean = mean_of(patch.values);
  EchoPatch flat = patch;
  for (int line = 0; line < patch.lines; ++line)
    for (int sample = 0; sample < patch.samples; ++sample)
      flat.at(line, sample) -= static_cast<float>(trend.dot(trend_terms(patch, line, sample)) - mean);
  return flat;
}

SpeckleMoments speckle_moments(std::span<const float> envelope) {
  SpeckleMoments moments;
  if (envelope.empty()) return moments;
  const auto n = static_cast<double>(envelope.size());
  double second = 0.0;
  double fourth = 0.0;
  for (const float a : envelope) {
    const double intensity = static_cast<double>(a) * a;
    second += intensity / n;
    fourth += intensity * intensity / n;
  }
  moments.mean = mean_of(envelope);
  moments.mean_intensity = second;
  moments.standard_deviation = std::sqrt(std::max(0.0, second - moments.mean * moments.mean));
  if (moments.standard_deviation <= 0.0 || second <= 0.0) return moments;
  moments.snr = moments.mean / moments.standard_deviation;
  moments.nakagami_m = second * second / (fourth - second * second);
  moments.nakagami_m_ml = most_likely_m(envelope, second);
  return moments;
}

RayleighFit fit_rayleigh(std::span<const float> independent_envelope) {
  RayleighFit fit;
  if (independent_envelope.empty()) return fit;
  std::vector<float> sorted(independent_envelope.begin(), independent_envelope.end());
  std::sort(sorted.begin(), sorted.end());
  const auto n = static_cast<double>(sorted.size());
  double mean_intensity = 0.0;
  for (const float a : sorted) mean_intensity += static_cast<double>(a) * a / n;
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    const double expected = 1.0 - std::exp(-static_cast<double>(sorted[i]) * sorted[i] / mean_intensity);
    const double below = static_cast<double>(i) / n;
    fit.distance = std::max({fit.distance, expected - below, below + 1.0 / n - expected});
  }
  fit.statistic = (fit.distance - 0.2 / n) * (std::sqrt(n) + 0.26 + 0.5 / std::sqrt(n));
  return fit;
}

SpeckleCorrelation speckle_correlation(const EchoPatch& patch) {
  const double mean = mean_of(patch.values);
  const Widths axial = widths_of(autocovariance(patch, mean, true));
  const Widths lateral = widths_of(autocovariance(patch, mean, false));
  SpeckleCorrelation correlation;
  correlation.axial_fwhm_mm = axial.fwhm * patch.sample_mm;
  correlation.lateral_fwhm_mm = lateral.fwhm * patch.line_mm;
  correlation.axial_cell_mm = axial.cell * patch.sample_mm;
  correlation.lateral_cell_mm = lateral.cell * patch.line_mm;
  correlation.cells = (patch.samples / axial.cell) * (patch.lines / lateral.cell);
  return correlation;
}

std::vector<float> thinned(const EchoPatch& patch, const SpeckleCorrelation& correlation, double cells) {
  const auto step = [&](double cell_mm, double spacing_mm) {
    return std::max(1, static_cast<int>(std::ceil(cells * cell_mm / spacing_mm)));
  };
  const int line_step = step(correlation.lateral_cell_mm, patch.line_mm);
  const int sample_step = step(correlation.axial_cell_mm, patch.sample_mm);
  std::vector<float> values;
  for (int line = 0; line < patch.lines; line += line_step)
    for (int sample = 0; sample < patch.samples; sample += sample_step) values.push_back(patch.at(line, sample));
  return values;
}

double normalised_correlation(std::span<const float> a, std::span<const float> b) {
  TROCAR_CHECK(a.size() == b.size());
  const double mean_a = mean_of(a);
  const double mean_b = mean_of(b);
  double aa = 0.0, bb = 0.0, ab = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    aa += (a[i] - mean_a) * (a[i] - mean_a);
    bb += (b[i] - mean_b) * (b[i] - mean_b);
    ab += (a[i] - mean_a) * (b[i] - mean_b);
  }
  return aa > 0.0 && bb > 0.0 ? ab / std::sqrt(aa * bb) : 0.0;
}

std::vector<DepthLevel> level_against_depth(const EchoPatch& envelope, double band_mm) {
  const int band = std::max(1, static_cast<int>(std::lround(band_mm / envelope.sample_mm)));
  std::vector<DepthLevel> levels;
  for (int first = 0; first + band <= envelope.samples; first += band) {
    double sum = 0.0;
    for (int line = 0; line < envelope.lines; ++line)
      for (int sample = first; sample < first + band; ++sample)
        sum += static_cast<double>(envelope.at(line, sample)) * envelope.at(line, sample);
    constexpr double kFloor = 1e-30;  // Keeps an empty band's level finite.
    const double mean_square = sum / (static_cast<double>(band) * envelope.lines);
    levels.push_back(
        {envelope.depth_mm + (first + 0.5 * (band - 1)) * envelope.sample_mm, 10.0 * std::log10(mean_square + kFloor)});
  }
  return levels;
}

double level_slope_db_per_mm(std::span<const DepthLevel> levels) {
  if (levels.size() < 2) return 0.0;
  double depth = 0.0, level = 0.0;
  for (const DepthLevel& at : levels) {
    depth += at.depth_mm / static_cast<double>(levels.size());
    level += at.level_db / static_cast<double>(levels.size());
  }
  double covariance = 0.0, variance = 0.0;
  for (const DepthLevel& at : levels) {
    covariance += (at.depth_mm - depth) * (at.level_db - level);
    variance += (at.depth_mm - depth) * (at.depth_mm - depth);
  }
  return covariance / variance;
}

}  // namespace trocar::ultrasound
