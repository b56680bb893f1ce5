#include "registration/ct_ultrasound/overlay_picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/parallel.h"
#include "image/image.h"
#include "registration/ct_ultrasound/detail/working_images.h"
#include "registration/intensity/gray_levels.h"
#include "volume/sampling.h"

namespace trocar::registration {
namespace {

constexpr double kPixel_mm = 0.6;
constexpr double kField_mm = 20.0;
constexpr double kBlack_hu = -150.0, kWhite_hu = 250.0;
constexpr int kMost = 600;  ///< Pixels of a panel's side.
constexpr int kGap = 4, kTitle = 16;

/// Two directions of the ultrasound's grid in a picture, through a point.
struct Plane {
  Vec3 centre, right, down;  ///< Unit directions.
  double half_width_mm = 0.0, up_mm = 0.0, down_mm = 0.0;
};

/// Extent of the grid's box from `centre` along a direction of one of its axes.
std::pair<double, double> reach(const volume::GridGeometry& grid, const Vec3& centre, const Vec3& direction) {
  double low = 0.0, high = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 index(corner & 1 ? static_cast<double>(grid.size[0] - 1) : 0.0,
                     corner & 2 ? static_cast<double>(grid.size[1] - 1) : 0.0,
                     corner & 4 ? static_cast<double>(grid.size[2] - 1) : 0.0);
    const double along = (grid.to_mm(index) - centre).dot(direction);
    low = std::min(low, along);
    high = std::max(high, along);
  }
  return {low, high};
}

std::array<Plane, 2> planes_of(const volume::GridGeometry& grid, const Beams& beams, const Vec3& centre) {
  const Vec3 beam =
      beams.is_fan() ? beams.direction(beams.to_point({0.0, 0.0, beams.depth_mm()})) : beams.direction(centre);
  const Vec3 beam_V = grid.R_PV.transpose() * beam;
  int depth = 0;
  beam_V.cwiseAbs().maxCoeff(&depth);
  const Vec3 down = (beam_V[depth] < 0.0 ? -1.0 : 1.0) * grid.R_PV.col(depth);
  std::array<Plane, 2> planes;
  int n = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == depth) continue;
    Plane& plane = planes[static_cast<std::size_t>(n++)];
    plane.centre = centre;
    plane.right = grid.R_PV.col(axis);
    plane.down = down;
    const auto side = reach(grid, centre, plane.right);
    plane.half_width_mm = std::max(-side.first, side.second);
    std::tie(plane.up_mm, plane.down_mm) = reach(grid, centre, down);
  }
  return planes;
}

/// Gray levels of both volumes at one pixel; ultrasound below 0: not imaged.
struct Pixel {
  double us = -1.0, ct = 0.0;
};

class Painter {
 public:
  Painter(const volume::CtGrid& ct, const volume::LabelGrid& us, const volume::MaskGrid& inside, const Pose& X_CU)
      : ct_(ct), us_(us), inside_(inside), X_CU_(X_CU), bright_(bright_gray(us)) {}

  Pixel pixel(const Vec3& p_U) const {
    Pixel pixel;
    if (volume::sample_nearest(inside_, p_U, std::uint8_t{0}) != 0)
      pixel.us = std::min(255.0, 255.0 * volume::sample_linear(us_, p_U) / bright_);
    const Vec3 p_C = X_CU_ * p_U;
    const double hu =
        volume::sample_nearest(ct_, p_C, std::int16_t{-1024}) == -1024 ? -1024.0 : volume::sample_linear(ct_, p_C);
    pixel.ct = std::clamp(255.0 * (hu - kBlack_hu) / (kWhite_hu - kBlack_hu), 0.0, 255.0);
    return pixel;
  }

 private:
  const volume::CtGrid& ct_;
  const volume::LabelGrid& us_;
  const volume::MaskGrid& inside_;
  Pose X_CU_;
  double bright_;
};

image::Rgb gray_of(double value) {
  const auto v = static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0));
  return {v, v, v};
}

image::Rgb blend_of(const Pixel& pixel) {
  if (pixel.us < 0.0) return gray_of(0.6 * pixel.ct);
  const double ct = 0.55 * pixel.ct;
  const auto channel = [&](double weight) {
    return static_cast<std::uint8_t>(std::clamp(ct + weight * pixel.us, 0.0, 255.0));
  };
  return {channel(0.9), channel(0.5), channel(0.1)};
}

}  // namespace

Result<image::RgbImage> overlay_picture(const volume::CtGrid& ct, const volume::LabelGrid& us, const Beams& beams,
                                        const Pose& X_CU) {
  TROCAR_TRY(const detail::WorkingUltrasound prepared, detail::prepare_ultrasound(us, beams));
  const std::array<Plane, 2> planes = planes_of(us.geometry, beams, prepared.centre);
  const double width_mm = 2.0 * std::max(planes[0].half_width_mm, planes[1].half_width_mm);
  const double height_mm = planes[0].down_mm - planes[0].up_mm;
  const double pixel_mm = std::max(kPixel_mm, std::max(width_mm, height_mm) / kMost);
  const int columns = static_cast<int>(width_mm / pixel_mm) + 1, rows = static_cast<int>(height_mm / pixel_mm) + 1;
  image::RgbImage image(4 * columns + 3 * kGap, 2 * rows + kGap + kTitle, {12, 12, 12});
  const Painter painter(ct, us, prepared.inside, X_CU);
  for (std::size_t p = 0; p < planes.size(); ++p) {
    const Plane& plane = planes[p];
    const int top = kTitle + static_cast<int>(p) * (rows + kGap);
    parallel_for(static_cast<std::size_t>(rows), 8, [&](std::size_t first, std::size_t last) {
      for (auto row = static_cast<int>(first); row < static_cast<int>(last); ++row)
        for (int column = 0; column < columns; ++column) {
          const double right_mm = pixel_mm * (column - 0.5 * (columns - 1));
          const double down_mm = plane.up_mm + pixel_mm * row;
          const Pixel pixel = painter.pixel(plane.centre + right_mm * plane.right + down_mm * plane.down);
          const bool is_us = (std::lround(std::floor(right_mm / kField_mm) + std::floor(down_mm / kField_mm)) & 1) == 0;
          const double us_gray = std::max(0.0, pixel.us);
          const auto put = [&](int panel, const image::Rgb& colour) {
            image.at(panel * (columns + kGap) + column, top + row) = colour;
          };
          put(0, gray_of(us_gray));
          put(1, gray_of(pixel.ct));
          put(2, gray_of(is_us && pixel.us >= 0.0 ? us_gray : pixel.ct));
          put(3, blend_of(pixel));
        }
    });
  }
  const std::array<const char*, 4> titles = {"ULTRASOUND", "CT", "CHECKERBOARD 20 MM", "BLEND"};
  for (int n = 0; n < 4; ++n)
    image::draw_text(image, n * (columns + kGap) + 4, 4, titles[static_cast<std::size_t>(n)], {230, 230, 230});
  return image;
}

}  // namespace trocar::registration
