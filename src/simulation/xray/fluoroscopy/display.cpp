#include "xray/fluoroscopy/display.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/parallel.h"
#include "core/result.h"
#include "xray/detector/scatter.h"

namespace trocar::xray::detail {

/// Bilinear values of an image on another raster over the same area. All cores.
std::vector<float> resample_image(const std::vector<float>& image, int columns, int rows, int new_columns,
                                  int new_rows);

}  // namespace trocar::xray::detail

namespace trocar::xray {
namespace {

constexpr float kDirect = 0.5F;
constexpr float kBrightSide = 2.0F;  ///< Widest part of a window above the median's brightness, in that below it.
constexpr std::size_t kGrainShown = 16384;

std::size_t percentile(std::size_t count, double share) {
  return std::min(count - 1, static_cast<std::size_t>(share * static_cast<double>(count)));
}

/// About 128² values of the field, without those of direct radiation if the rest covers a twentieth of it.
std::vector<float> sampled_values(std::span<const float> values, std::span<const float> signal, int columns,
                                  const FieldPixels& field) {
  std::vector<float> behind, all;
  const int step = std::max(1, (field.last_row - field.first_row) / 128);
  for (int row = field.first_row; row < field.last_row; row += step)
    for (int column = field.first_column; column < field.last_column; column += step) {
      const std::size_t n =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
      all.push_back(values[n]);
      if (signal[n] <= kDirect) behind.push_back(values[n]);
    }
  return 20 * behind.size() >= all.size() ? behind : all;
}

float value_at(std::vector<float>& values, double share) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(percentile(values.size(), share));
  std::nth_element(values.begin(), place, values.end());
  return *place;
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

/// The base of an image, a·v + b of its values v: their local mean where they differ little, the values themselves at
/// great steps, so that a step gets no halo. Fast guided filter (He and Sun, arXiv:1505.00996).
struct Base {
  std::vector<float> a, b;  ///< For each pixel.
  float mean = 0.0F;
};
Base base_of(const std::vector<float>& values, int columns, int rows) {
  constexpr int kCells = 64;
  constexpr double kSigma_cells = 3.0;
  constexpr float kSmallVariance = 0.1F;  ///< [assumed]: more than that of ribs, less than that of the lung's edge.
  const int cells = std::min({kCells, columns, rows});
  std::vector<float> mean = cell_means(values, columns, rows, cells), square = mean;
  Base base;
  base.mean = std::accumulate(mean.begin(), mean.end(), 0.0F) / static_cast<float>(mean.size());
  for (float& value : square) value *= value;
  blur_image(mean, cells, cells, kSigma_cells);
  blur_image(square, cells, cells, kSigma_cells);
  std::vector<float> a(mean.size()), b(mean.size());
  for (std::size_t n = 0; n < mean.size(); ++n) {
    const float variance = std::max(square[n] - mean[n] * mean[n], 0.0F);
    a[n] = variance / (variance + kSmallVariance);
    b[n] = mean[n] * (1.0F - a[n]);
  }
  for (std::vector<float>* one : {&a, &b}) blur_image(*one, cells, cells, kSigma_cells);
  base.a = detail::resample_image(a, cells, cells, columns, rows);
  base.b = detail::resample_image(b, cells, cells, columns, rows);
  return base;
}

/// Takes off a share of the differences of the base. Values below `least`, those of direct radiation, count as `least`
/// there: the step to them would take the contrast of what lies beside it.
void compress_range(std::vector<float>& values, int columns, int rows, float least, double share) {
  std::vector<float> within(values.size());
  std::ranges::transform(values, within.begin(), [&](float value) { return std::max(value, least); });
  const Base base = base_of(within, columns, rows);
  const auto part = static_cast<float>(share);
  parallel_for(values.size(), kGrainShown, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) values[n] -= part * (base.a[n] * within[n] + base.b[n] - base.mean);
  });
}

/// Brightness, 0 to 1, of a place in the window, 0 (dense) to 1: even over most of it; towards both ends it flattens,
/// as on film, so that what lies beyond the window is not one flat area at once.
float brightness_at(float place) noexcept {
  constexpr float kKnee = 0.05F, kSlope = (1.0F - 2.0F * kKnee) / kKnee;
  const float from_end = std::min(place, 1.0F - place);
  if (from_end >= 0.0F) return kKnee + (1.0F - 2.0F * kKnee) * place;
  const float rest = kKnee * std::exp(kSlope * from_end);
  return place < 0.0F ? rest : 1.0F - rest;
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
      for (std::size_t n = first; n < last; ++n) values[n] = -std::log(std::max(kLeastSignal, signal[n]));
    else
      for (std::size_t n = first; n < last; ++n) values[n] = -signal[n];
  });
  continue_field(values, columns, rows, field);
  const double compression = std::clamp(settings.range_compression, 0.0, 0.9);
  if (compression > 0.0) {
    std::vector<float> sample = sampled_values(values, signal, columns, field);
    if (!sample.empty()) compress_range(values, columns, rows, value_at(sample, 0.05), compression);
  }
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
  std::vector<float> used = sampled_values(values, signal, columns, field);
  if (used.empty()) return {};
  GrayWindow window{value_at(used, 0.01), value_at(used, 0.99)};
  const float median = value_at(used, 0.5);
  window.low = std::max(window.low, median - kBrightSide * (window.high - median));
  if (const float missing = least_width - (window.high - window.low); missing > 0.0F) {
    window.low -= 0.5F * missing;
    window.high += 0.5F * missing;
  }
  return window;
}

image::GrayImage to_gray(std::span<const float> values, int columns, int rows, const GrayWindow& window,
                         bool is_inverted, const FieldPixels& field) {
  TROCAR_CHECK(values.size() == static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  image::GrayImage image{columns, rows, std::vector<std::uint8_t>(values.size(), 0)};
  const float width = std::max(window.high - window.low, 1e-6F);
  for (int row = field.first_row; row < field.last_row; ++row)
    for (int column = field.first_column; column < field.last_column; ++column) {
      const std::size_t n =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column);
      const float bright = brightness_at((window.high - values[n]) / width);
      image.pixels[n] = static_cast<std::uint8_t>(255.0F * (is_inverted ? 1.0F - bright : bright) + 0.5F);
    }
  return image;
}

namespace {

constexpr float kWeight = 0.7F;  ///< Of the road map where it is shown fully.
constexpr std::size_t kGrainSubtracted = 16384;

}  // namespace

void MaskSubtraction::clear() noexcept {
  sum_.clear();
  frames_ = 0;
}

void MaskSubtraction::add_mask(std::span<const float> signal) {
  if (sum_.size() != signal.size()) {
    sum_.assign(signal.size(), 0.0F);
    frames_ = 0;
  }
  for (std::size_t n = 0; n < signal.size(); ++n) sum_[n] += signal[n];
  ++frames_;
}

std::vector<float> MaskSubtraction::difference(std::span<const float> signal) const {
  std::vector<float> difference(signal.size(), 0.0F);
  if (frames_ == 0 || sum_.size() != signal.size()) return difference;
  const float share = 1.0F / static_cast<float>(frames_);
  parallel_for(signal.size(), kGrainSubtracted, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      difference[n] = std::log(std::max(sum_[n] * share, kLeastSignal) / std::max(signal[n], kLeastSignal));
  });
  return difference;
}

void RoadMap::add(std::span<const float> difference) {
  if (greatest_.size() != difference.size()) {
    greatest_.assign(difference.begin(), difference.end());
    return;
  }
  for (std::size_t n = 0; n < difference.size(); ++n) greatest_[n] = std::max(greatest_[n], difference[n]);
}

void RoadMap::overlay(float least, float full, image::GrayImage& image) const {
  if (greatest_.size() != image.pixels.size()) return;
  const float scale = kWeight / std::max(full - least, 1e-6F);
  for (std::size_t n = 0; n < greatest_.size(); ++n) {
    const float share = std::clamp(scale * (greatest_[n] - least), 0.0F, kWeight);
    const auto gray = static_cast<float>(image.pixels[n]);
    image.pixels[n] = static_cast<std::uint8_t>(gray + share * (255.0F - gray) + 0.5F);
  }
}

}  // namespace trocar::xray

namespace trocar::xray::detail {
namespace {

constexpr std::size_t kGrainResampledRows = 32;

}  // namespace

std::vector<float> resample_image(const std::vector<float>& image, int columns, int rows, int new_columns,
                                  int new_rows) {
  struct Place {
    std::size_t first, second;
    float weight;
  };
  const auto place = [](int n, int fine, int coarse) {
    const double x = std::clamp((n + 0.5) * coarse / fine - 0.5, 0.0, coarse - 1.0);
    const auto first = static_cast<std::size_t>(x);
    return Place{first, std::min(first + 1, static_cast<std::size_t>(coarse - 1)),
                 static_cast<float>(x - static_cast<double>(first))};
  };
  std::vector<Place> across;
  for (int n = 0; n < new_columns; ++n) across.push_back(place(n, new_columns, columns));
  std::vector<float> made(static_cast<std::size_t>(new_columns) * static_cast<std::size_t>(new_rows));
  parallel_for(static_cast<std::size_t>(new_rows), kGrainResampledRows, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row) {
      const Place y = place(static_cast<int>(row), new_rows, rows);
      const float* const above = image.data() + y.first * static_cast<std::size_t>(columns);
      const float* const below = image.data() + y.second * static_cast<std::size_t>(columns);
      float* const to = made.data() + row * static_cast<std::size_t>(new_columns);
      for (std::size_t n = 0; n < across.size(); ++n) {
        const Place& x = across[n];
        const float left = above[x.first] + y.weight * (below[x.first] - above[x.first]);
        const float right = above[x.second] + y.weight * (below[x.second] - above[x.second]);
        to[n] = left + x.weight * (right - left);
      }
    }
  });
  return made;
}

}  // namespace trocar::xray::detail
