#include "lab/ultrasound/picture_figures.h"

#include <algorithm>
#include <cmath>

namespace trocar::ultrasound {
namespace {

constexpr int kPolarLines = 400;
constexpr double kSample_mm = 0.15;
constexpr double kLevelBand_mm = 10.0;
constexpr double kPatchDepth_mm = 10.0;
constexpr double kPatchWidth_mm = 12.0;
constexpr double kFirstPatch_mm = 30.0;  ///< Deeper than the layers of skin, fat and muscle.
constexpr double kSpeckleBand_mm = 10.0;
constexpr std::size_t kLeastPatches = 15;
/// Criteria of homogeneous tissue: brighter than shadows and lumina, without edges and bright spots.
constexpr double kLeastGray = 14.0;
constexpr double kLeastDeviation = 0.5;  ///< Gray; rounding alone makes 0.29.
constexpr double kMostTrend = 0.7;       ///< Range of the quadratic trend over the mean.
constexpr double kMostKurtosis = 4.0;

double gray_at(const FanPicture& picture, double column, double row) {
  const int c = static_cast<int>(std::floor(column));
  const int r = static_cast<int>(std::floor(row));
  if (c < 0 || r < 0 || c + 1 >= picture.raster.columns || r + 1 >= picture.raster.rows) return 0.0;
  const double x = column - c;
  const double y = row - r;
  const auto pixel = [&](int at_column, int at_row) {
    return static_cast<double>(
        picture.pixels[static_cast<std::size_t>(at_row) * static_cast<std::size_t>(picture.raster.columns) +
                       static_cast<std::size_t>(at_column)]);
  };
  return (1.0 - y) * ((1.0 - x) * pixel(c, r) + x * pixel(c + 1, r)) +
         y * ((1.0 - x) * pixel(c, r + 1) + x * pixel(c + 1, r + 1));
}

EchoPatch cut(const EchoPatch& polar, int first_line, int lines, int first_sample, int samples, double line_mm) {
  EchoPatch patch;
  patch.lines = lines;
  patch.samples = samples;
  patch.line_mm = line_mm;
  patch.sample_mm = polar.sample_mm;
  patch.depth_mm = polar.depth_mm + first_sample * polar.sample_mm;
  patch.values.reserve(static_cast<std::size_t>(lines) * static_cast<std::size_t>(samples));
  for (int line = first_line; line < first_line + lines; ++line)
    for (int sample = first_sample; sample < first_sample + samples; ++sample)
      patch.values.push_back(polar.at(line, sample));
  return patch;
}

struct Shape {
  double mean = 0.0, standard_deviation = 0.0, skewness = 0.0, kurtosis = 0.0;
};
Shape shape_of(std::span<const float> values) {
  const auto n = static_cast<double>(values.size());
  Shape shape;
  for (const float value : values) shape.mean += value / n;
  double second = 0.0, third = 0.0, fourth = 0.0;
  for (const float value : values) {
    const double d = value - shape.mean;
    second += d * d / n;
    third += d * d * d / n;
    fourth += d * d * d * d / n;
  }
  shape.standard_deviation = std::sqrt(second);
  if (second <= 0.0) return shape;
  shape.skewness = third / (second * shape.standard_deviation);
  shape.kurtosis = fourth / (second * second);
  return shape;
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

GrayHistogram shares_of(const std::array<std::size_t, 256>& counts) {
  std::size_t total = 0;
  for (const std::size_t count : counts) total += count;
  GrayHistogram histogram{};
  for (std::size_t gray = 0; gray < histogram.size() && total > 0; ++gray)
    histogram[gray] = static_cast<double>(counts[gray]) / static_cast<double>(total);
  return histogram;
}

}  // namespace

EchoPatch polar_picture(const FanPicture& picture, int lines, double sample_mm) {
  EchoPatch polar;
  polar.lines = lines;
  polar.samples = static_cast<int>(picture.scan.depth_mm / sample_mm);
  polar.sample_mm = sample_mm;
  polar.depth_mm = 0.5 * sample_mm;
  polar.line_mm = picture.scan.line_spacing_mm(0.5 * picture.scan.depth_mm) * (picture.scan.lines - 1) / (lines - 1);
  polar.values.reserve(static_cast<std::size_t>(polar.lines) * static_cast<std::size_t>(polar.samples));
  for (int line = 0; line < lines; ++line) {
    const double at_line = static_cast<double>(line) * (picture.scan.lines - 1) / (lines - 1);
    for (int sample = 0; sample < polar.samples; ++sample) {
      const Vec2 pixel = picture.raster.to_pixel(picture.scan.to_cartesian({at_line, (sample + 0.5) * sample_mm}));
      polar.values.push_back(static_cast<float>(gray_at(picture, pixel.x(), pixel.y())));
    }
  }
  return polar;
}

void PictureStatistics::add(const FanPicture& picture) {
  const EchoPatch polar = polar_picture(picture, kPolarLines, kSample_mm);
  const auto bands = static_cast<std::size_t>(picture.scan.depth_mm / kLevelBand_mm);
  if (band_counts_.size() < bands) band_counts_.resize(bands);
  for (int line = 0; line < polar.lines; ++line)
    for (int sample = 0; sample < polar.samples; ++sample) {
      const auto gray = static_cast<std::size_t>(std::lround(polar.at(line, sample)));
      ++counts_[gray];
      const auto band = static_cast<std::size_t>((sample + 0.5) * polar.sample_mm / kLevelBand_mm);
      const bool is_middle = line >= polar.lines / 6 && line < polar.lines - polar.lines / 6;
      if (is_middle && band < bands) ++band_counts_[band][gray];
    }
  add_patches(polar, picture.scan);
  for (const ObliqueBorder& border : find_oblique_borders(polar, picture.scan)) borders_.push_back(border);
}

void PictureStatistics::add_texture(const EchoPatch& patch, const EchoPatch& flat) {
  const auto band = static_cast<std::size_t>((patch.depth_mm + 0.5 * kPatchDepth_mm) / kSpeckleBand_mm);
  if (textures_.size() <= band) textures_.resize(band + 1);
  const auto mean = static_cast<float>(shape_of(flat.values).mean);
  for (const float value : flat.values) textures_[band].push_back(value - mean);
}

void PictureStatistics::add_patches(const EchoPatch& polar, const ScanGeometry& scan) {
  const int depth = static_cast<int>(kPatchDepth_mm / polar.sample_mm);
  const int first = static_cast<int>(kFirstPatch_mm / polar.sample_mm);
  for (int from = first; from + depth <= polar.samples; from += depth / 2) {
    const double depth_mm = (from + 0.5 * depth) * polar.sample_mm;
    const double line_mm = scan.line_spacing_mm(depth_mm) * (scan.lines - 1) / (polar.lines - 1);
    const int width = static_cast<int>(std::lround(kPatchWidth_mm / line_mm));
    for (int line = 0; line + width <= polar.lines; line += std::max(1, width / 2)) {
      const EchoPatch patch = cut(polar, line, width, from, depth, line_mm);
      const EchoPatch flat = without_trend(patch);
      const Shape shape = shape_of(flat.values);
      double lowest = 1e9, highest = -1e9;  // of the trend
      for (std::size_t i = 0; i < patch.values.size(); ++i) {
        const double trend = patch.values[i] - flat.values[i];
        lowest = std::min(lowest, trend);
        highest = std::max(highest, trend);
      }
      constexpr double kFirstTexture_mm = 40.0, kLastTexture_mm = 100.0;
      const bool is_middle = line >= polar.lines / 4 && line + width <= polar.lines - polar.lines / 4;
      if (is_middle && depth_mm > kFirstTexture_mm && depth_mm < kLastTexture_mm && shape.mean >= kLeastGray &&
          highest - lowest < kMostTrend * shape.mean)
        add_texture(patch, flat);
      const bool is_homogeneous = shape.mean >= kLeastGray && shape.standard_deviation > kLeastDeviation &&
                                  shape.kurtosis < kMostKurtosis && highest - lowest < kMostTrend * shape.mean;
      if (!is_homogeneous) continue;
      const SpeckleCorrelation correlation = speckle_correlation(flat);
      if (std::isnan(correlation.axial_fwhm_mm) || std::isnan(correlation.lateral_fwhm_mm)) continue;
      patches_.push_back({depth_mm, shape.mean, shape.standard_deviation, shape.skewness, correlation.axial_fwhm_mm,
                          correlation.lateral_fwhm_mm});
    }
  }
}

namespace {

PictureFigures::Texture texture_of(const std::vector<std::vector<float>>& bands) {
  std::vector<float> all;
  for (const std::vector<float>& band : bands) {
    if (band.empty()) continue;
    const auto deviation = static_cast<float>(shape_of(band).standard_deviation);
    for (const float value : band) all.push_back(value / std::max(deviation, 1e-3F));
  }
  PictureFigures::Texture texture;
  texture.pixels = all.size();
  if (all.empty()) return texture;
  const Shape shape = shape_of(all);
  texture.skewness = shape.skewness;
  texture.kurtosis = shape.kurtosis;
  constexpr float kBright = 4.0F;
  const auto bright = std::count_if(all.begin(), all.end(), [](float value) { return value > kBright; });
  texture.bright_permille = 1e3 * static_cast<double>(bright) / static_cast<double>(all.size());
  return texture;
}

PictureFigures::Border border_of(const std::vector<ObliqueBorder>& borders) {
  constexpr double kLeast_rad = 0.436, kMost_rad = 0.785;  // 25 to 45 degrees
  std::vector<double> above, thickness_mm;
  for (const ObliqueBorder& border : borders) {
    if (border.incidence_rad < kLeast_rad || border.incidence_rad > kMost_rad) continue;
    above.push_back(border.above_gray);
    thickness_mm.push_back(border.thickness_mm);
  }
  if (above.empty()) return {};
  return {static_cast<int>(above.size()), median_of(above), median_of(thickness_mm)};
}

}  // namespace

PictureFigures PictureStatistics::figures() const {
  PictureFigures figures;
  figures.histogram = shares_of(counts_);
  for (std::size_t band = 0; band < band_counts_.size(); ++band) {
    const GrayHistogram histogram = shares_of(band_counts_[band]);
    figures.levels.push_back({(static_cast<double>(band) + 0.5) * kLevelBand_mm, mean_gray(histogram),
                              static_cast<double>(gray_percentile(histogram, 0.5)),
                              static_cast<double>(gray_percentile(histogram, 0.99))});
  }
  double deepest_mm = 0.0;
  for (const Patch& patch : patches_) deepest_mm = std::max(deepest_mm, patch.depth_mm);
  for (double from_mm = kFirstPatch_mm; from_mm <= deepest_mm; from_mm += kSpeckleBand_mm) {
    std::vector<Patch> here;
    for (const Patch& patch : patches_)
      if (patch.depth_mm >= from_mm && patch.depth_mm < from_mm + kSpeckleBand_mm) here.push_back(patch);
    if (here.size() < kLeastPatches) continue;
    const auto median = [&](double Patch::*value) {
      std::vector<double> values;
      for (const Patch& patch : here) values.push_back(patch.*value);
      return median_of(std::move(values));
    };
    figures.speckle.push_back({from_mm + 0.5 * kSpeckleBand_mm, static_cast<int>(here.size()), median(&Patch::mean),
                               median(&Patch::standard_deviation), median(&Patch::axial_fwhm_mm),
                               median(&Patch::lateral_fwhm_mm), median(&Patch::skewness)});
  }
  figures.texture = texture_of(textures_);
  figures.border = border_of(borders_);
  return figures;
}

}  // namespace trocar::ultrasound
