#include "report/detail/volume_slice.h"

#include <fmt/format.h>

#include <algorithm>

#include "png/png_file.h"
#include "registration/intensity/bright_gray.h"
#include "report/detail/html.h"

namespace trocar::report::detail {
namespace {

constexpr double kUnitsPerMm = 2.0;
constexpr volume::Rgb kBorder = {255, 190, 60};

volume::Index3 voxel_of(const SliceAxes& axes, std::int64_t column, std::int64_t row, std::int64_t index) {
  volume::Index3 ijk{0, 0, 0};
  ijk[static_cast<std::size_t>(axes.column)] = column;
  ijk[static_cast<std::size_t>(axes.along)] = row;
  ijk[static_cast<std::size_t>(axes.across)] = index;
  return ijk;
}

}  // namespace

SliceAxes slice_axes(const registration::Beams& beams, const volume::GridGeometry& geometry) {
  const Vec3 middle =
      geometry.to_mm(0.5 * Vec3(static_cast<double>(geometry.size[0] - 1), static_cast<double>(geometry.size[1] - 1),
                                static_cast<double>(geometry.size[2] - 1)));
  const Vec3 beam_V = geometry.R_PV.transpose() * beams.direction(middle);
  SliceAxes axes;
  beam_V.cwiseAbs().maxCoeff(&axes.along);
  axes.column = axes.along == 0 ? 1 : 0;
  axes.across = 3 - axes.along - axes.column;
  return axes;
}

double VolumeSlice::width() const noexcept {
  return kUnitsPerMm * image.columns * geometry.spacing_mm[axes.column];
}
double VolumeSlice::height() const noexcept {
  return kUnitsPerMm * image.rows * geometry.spacing_mm[axes.along];
}

std::array<double, 2> VolumeSlice::place(const Vec3& p_P) const noexcept {
  const Vec3 index = geometry.to_index(p_P);
  return {kUnitsPerMm * (index[axes.column] + 0.5) * geometry.spacing_mm[axes.column],
          kUnitsPerMm * (index[axes.along] + 0.5) * geometry.spacing_mm[axes.along]};
}

std::string VolumeSlice::svg(double x) const {
  return fmt::format(
      "<image x=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" preserveAspectRatio=\"none\" "
      "href=\"data:image/png;base64,{}\"/>",
      x, width(), height(), base64(png::encode_png(image)));
}

VolumeSlice cut_slice(const volume::LabelGrid& gray, const registration::ImagedRegion* region, const SliceAxes& axes,
                      std::int64_t index) {
  const auto& size = gray.geometry.size;
  VolumeSlice slice;
  slice.geometry = gray.geometry;
  slice.axes = axes;
  slice.image = volume::RgbImage(static_cast<int>(size[static_cast<std::size_t>(axes.column)]),
                                 static_cast<int>(size[static_cast<std::size_t>(axes.along)]));
  const double white = registration::bright_gray(gray);
  index = std::clamp<std::int64_t>(index, 0, size[static_cast<std::size_t>(axes.across)] - 1);
  for (int row = 0; row < slice.image.rows; ++row) {
    for (int column = 0; column < slice.image.columns; ++column) {
      const volume::Index3 ijk = voxel_of(axes, column, row, index);
      const auto g = static_cast<std::uint8_t>(std::min(255.0, 255.0 * gray[ijk] / white));
      slice.image.at(column, row) = {g, g, g};
      if (region && region->inside[ijk] != 0 && region->usable[ijk] == 0)
        slice.image.at(column, row) = {static_cast<std::uint8_t>(g / 2), static_cast<std::uint8_t>(g / 2 + 30),
                                       static_cast<std::uint8_t>(std::min(255, g + 70))};
    }
  }
  return slice;
}

VolumeSlice cut_borders(const volume::LabelGrid& gray, const volume::LabelGrid& source, const SliceAxes& axes,
                        std::int64_t index) {
  VolumeSlice slice = cut_slice(gray, nullptr, axes, index);
  for (int row = 0; row + 1 < slice.image.rows; ++row) {
    for (int column = 0; column + 1 < slice.image.columns; ++column) {
      const std::uint8_t here = source[voxel_of(axes, column, row, index)];
      if (here != source[voxel_of(axes, column + 1, row, index)] ||
          here != source[voxel_of(axes, column, row + 1, index)])
        slice.image.at(column, row) = kBorder;
    }
  }
  return slice;
}

}  // namespace trocar::report::detail
