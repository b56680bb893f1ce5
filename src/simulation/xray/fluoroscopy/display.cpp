#include "xray/fluoroscopy/display.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/check.h"
#include "core/parallel.h"
#include "xray/detector/image_blur.h"
#include "xray/fluoroscopy/detail/resample_image.h"

namespace trocar::xray {
namespace {

constexpr float kDirect = 0.5F;
constexpr float kBrightSide = 1.5F;  ///< Widest part of a window above the median's brightness, in that below it.
constexpr std::size_t kGrainShown = 16384;

std::size_t percentile(std::size_t count, double share) {
  return std::min(count - 1, static_cast<std::size_t>(share * static_cast<double>(count)));
}

/// Continues the values at the field's edge behind the shutters, so that filters see no step there.
void continue_field(std::vector<float>& values, int columns, int rows, const FieldPixels& field) {
  const auto line = [&](int row) { return values.begin() + static_cast<std::ptrdiff_t>(row) * columns; };
  for (int row = field.first_row; row < field.last_row; ++row) {
    std::fill(line(row), line(row) + field.first_column, *(line(row) + field.first_column));
    std::fill(line(row) + field.last_column, line(row) + columns, *(line(row) + field.last_column - 1));
  }
  for (int row = 0; row < rows; ++row)
    if (row < field.first_row || row >= field.last_row)
      std::copy_n(line(std::clamp(row, field.first_row, field.last_row - 1)), columns, line(row));
}

/// Means of cells of an image.
std::vector<float> cell_means(const std::vector<float>& values, int columns, int rows, int cells) {
  std::vector<float> means(static_cast<std::size_t>(cells) * static_cast<std::size_t>(cells), 0.0F);
  std::vector<int> count(means.size(), 0);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const auto cell = static_cast<std::size_t>(row * cells / rows * cells + column * cells / columns);
      means[cell] +=
          values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
      ++count[cell];
    }
  for (std::size_t n = 0; n < means.size(); ++n) means[n] /= static_cast<float>(std::max(count[n], 1));
  return means;
}

/// Takes off a share of the differences that are wider than a tenth of the image.
void compress_range(std::vector<float>& values, int columns, int rows, double share) {
  constexpr int kCells = 64;
  constexpr double kSigma_cells = 6.0;
  const int cells = std::min({kCells, columns, rows});
  std::vector<float> slow = cell_means(values, columns, rows, cells);
  blur_image(slow, cells, cells, kSigma_cells);
  const float mean = std::accumulate(slow.begin(), slow.end(), 0.0F) / static_cast<float>(slow.size());
  slow = detail::resample_image(slow, cells, cells, columns, rows);
  const auto part = static_cast<float>(share);
  parallel_for(values.size(), kGrainShown, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) values[n] -= part * (slow[n] - mean);
  });
}

}  // namespace

bool DisplaySettings::operator==(const DisplaySettings& other) const noexcept {
  const bool has_same_window = window.has_value() == other.window.has_value() &&
                               (!window || (window->low == other.window->low && window->high == other.window->high));
  return has_same_window && is_logarithmic == other.is_logarithmic && is_inverted == other.is_inverted &&
         range_compression == other.range_compression && edge_gain == other.edge_gain &&
         edge_sigma_px == other.edge_sigma_px;
}

FieldPixels field_pixels(const CArm& arm) noexcept {
  const auto first = [&](double share) { return static_cast<int>(std::lround(0.5 * (1.0 - share) * arm.pixels)); };
  const int column = first(arm.collimation[0]), row = first(arm.collimation[1]);
  return {column, arm.pixels - column, row, arm.pixels - row};
}

std::vector<float> shown_values(std::span<const float> signal, int columns, int rows, const DisplaySettings& settings,
                                const FieldPixels& field) {
  std::vector<float> values(signal.size());
  parallel_for(signal.size(), kGrainShown, [&](std::size_t first, std::size_t last) {
    if (settings.is_logarithmic)
      for (std::size_t n = first; n < last; ++n) values[n] = -std::log(std::max(signal[n], kLeastSignal));
    else
      for (std::size_t n = first; n < last; ++n) values[n] = -signal[n];
  });
  continue_field(values, columns, rows, field);
  const double compression = std::clamp(settings.range_compression, 0.0, 0.9);
  if (compression > 0.0) compress_range(values, columns, rows, compression);
  const auto gain = static_cast<float>(std::clamp(settings.edge_gain, 0.0, 4.0));
  if (gain == 0.0F) return values;
  std::vector<float> smooth = values;
  blur_image(smooth, columns, rows, std::clamp(settings.edge_sigma_px, 0.7, 20.0));
  parallel_for(values.size(), kGrainShown, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) values[n] += gain * (values[n] - smooth[n]);
  });
  return values;
}

GrayWindow window_of(std::span<const float> values, std::span<const float> signal, int columns,
                     const FieldPixels& field, float least_width) {
  std::vector<float> behind, all;
  const int step = std::max(1, (field.last_row - field.first_row) / 128);
  for (int row = field.first_row; row < field.last_row; row += step)
    for (int column = field.first_column; column < field.last_column; column += step) {
      const std::size_t n =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
      all.push_back(values[n]);
      if (signal[n] <= kDirect) behind.push_back(values[n]);
    }
  std::vector<float>& used = 20 * behind.size() >= all.size() ? behind : all;
  if (used.empty()) return {};
  const auto value_at = [&](double share) {
    const auto place = used.begin() + static_cast<std::ptrdiff_t>(percentile(used.size(), share));
    std::nth_element(used.begin(), place, used.end());
    return *place;
  };
  GrayWindow window{value_at(0.01), value_at(0.99)};
  const float median = value_at(0.5);
  window.low = std::max(window.low, median - kBrightSide * (window.high - median));
  if (const float missing = least_width - (window.high - window.low); missing > 0.0F) {
    window.low -= 0.5F * missing;
    window.high += 0.5F * missing;
  }
  return window;
}

GrayImage to_gray(std::span<const float> values, int columns, int rows, const GrayWindow& window, bool is_inverted,
                  const FieldPixels& field) {
  TROCAR_CHECK(values.size() == static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  GrayImage image{columns, rows, std::vector<std::uint8_t>(values.size(), 0)};
  const float width = std::max(window.high - window.low, 1e-6F);
  const float scale = (is_inverted ? 255.0F : -255.0F) / width;
  const float origin = is_inverted ? window.low : window.high;
  for (int row = field.first_row; row < field.last_row; ++row)
    for (int column = field.first_column; column < field.last_column; ++column) {
      const std::size_t n =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
      image.pixels[n] = static_cast<std::uint8_t>(std::clamp(scale * (values[n] - origin) + 0.5F, 0.0F, 255.0F));
    }
  return image;
}

}  // namespace trocar::xray
