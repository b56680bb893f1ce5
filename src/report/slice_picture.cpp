#include "report/slice_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace trocar {
namespace {

/// Directions of the picture in P (LPS): +u to the right of the picture, +v down.
struct ViewAxes {
  Vec3 u_P, v_P;
};

ViewAxes view_axes(SliceOrientation orientation) {
  switch (orientation) {
    case SliceOrientation::kAxial:  // seen from the feet
      return {Vec3::UnitX(), Vec3::UnitY()};
    case SliceOrientation::kCoronal:  // seen from the front
      return {Vec3::UnitX(), -Vec3::UnitZ()};
    case SliceOrientation::kSagittal:  // seen from the patient's left
      break;
  }
  return {Vec3::UnitY(), -Vec3::UnitZ()};
}

struct Extent {
  double low, high;
};

/// What is shown along a direction of P: the volume's box (voxel borders, not centres) or the part inside the field.
Extent extent_mm(const GridGeometry& geometry, const Vec3& direction_P, const SliceOptions& options) {
  Extent box{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 index;
    for (int a = 0; a < 3; ++a)
      index[a] = (corner >> a & 1) != 0 ? static_cast<double>(geometry.size[static_cast<std::size_t>(a)]) - 0.5 : -0.5;
    const double along = direction_P.dot(geometry.to_mm(index));
    box.low = std::min(box.low, along);
    box.high = std::max(box.high, along);
  }
  if (!(options.field_mm > 0.0)) return box;
  const double side = std::min(options.field_mm, box.high - box.low);
  const double low = direction_P.dot(options.center_P) - 0.5 * side;
  const double inside = std::clamp(low, box.low, box.high - side);
  return {inside, inside + side};
}

SlicePlane plane_through(const GridGeometry& geometry, SliceOrientation orientation, const Vec3& through_P,
                         const SliceOptions& options) {
  const ViewAxes axes = view_axes(orientation);
  const Extent u = extent_mm(geometry, axes.u_P, options);
  const Extent v = extent_mm(geometry, axes.v_P, options);
  const double longer_mm = options.field_mm > 0.0 ? options.field_mm : std::max(u.high - u.low, v.high - v.low);
  const double step_mm = longer_mm / options.size_px;
  SlicePlane plane;
  plane.columns = std::max(1, static_cast<int>(std::lround((u.high - u.low) / step_mm)));
  plane.rows = std::max(1, static_cast<int>(std::lround((v.high - v.low) / step_mm)));
  plane.step_u_P = step_mm * axes.u_P;
  plane.step_v_P = step_mm * axes.v_P;
  // The point keeps its coordinate across the plane; the first pixel's centre lies half a pixel inside the box.
  const Vec3 across_P = axes.u_P.cross(axes.v_P);
  plane.origin_P =
      across_P * across_P.dot(through_P) + axes.u_P * (u.low + 0.5 * step_mm) + axes.v_P * (v.low + 0.5 * step_mm);
  return plane;
}

std::uint8_t grey_of(float hu, const Window& window) {
  const double fraction = (static_cast<double>(hu) - window.center_hu) / window.width_hu + 0.5;
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(fraction, 0.0, 1.0)));
}

/// Fat and muscle fill the whole body: they are the ground on which structures are drawn.
bool is_drawn(const Label& label) {
  return label.tissue != "adipose" && label.tissue != "muscle" && label.tissue != "skin";
}

Rgb mix(const Rgb& below, const Rgb& above, double opacity) {
  Rgb out;
  for (std::size_t c = 0; c < 3; ++c)
    out[c] = static_cast<std::uint8_t>(std::lround((1.0 - opacity) * below[c] + opacity * above[c]));
  return out;
}

/// Label ids of the picture's pixels, 0 where no structure is drawn.
std::vector<std::uint8_t> sample_labels(const VirtualPatient& patient, const SlicePlane& plane) {
  std::array<bool, 256> drawn{};
  for (const Label& label : patient.label_table.labels) drawn[label.id] = is_drawn(label);
  std::vector<std::uint8_t> ids;
  ids.reserve(static_cast<std::size_t>(plane.columns) * static_cast<std::size_t>(plane.rows));
  for (int v = 0; v < plane.rows; ++v) {
    for (int u = 0; u < plane.columns; ++u) {
      const Vec3 p_P = plane.origin_P + u * plane.step_u_P + v * plane.step_v_P;
      const std::uint8_t id = sample_nearest<std::uint8_t>(patient.labels, p_P, 0);
      ids.push_back(drawn[id] ? id : std::uint8_t{0});
    }
  }
  return ids;
}

void draw_labels(const VirtualPatient& patient, const SliceOptions& options, SlicePicture& picture) {
  const std::vector<std::uint8_t> ids = sample_labels(patient, picture.plane);
  std::array<Rgb, 256> colors{};
  for (const Label& label : patient.label_table.labels) colors[label.id] = label.color;
  const int columns = picture.image.columns;
  const int rows = picture.image.rows;
  const auto id_at = [&](int u, int v) -> std::uint8_t {
    const bool is_inside = u >= 0 && v >= 0 && u < columns && v < rows;
    return is_inside
               ? ids[static_cast<std::size_t>(v) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(u)]
               : std::uint8_t{0};
  };
  for (int v = 0; v < rows; ++v) {
    for (int u = 0; u < columns; ++u) {
      const std::uint8_t id = id_at(u, v);
      if (id == 0) continue;
      const bool is_edge =
          id_at(u - 1, v) != id || id_at(u + 1, v) != id || id_at(u, v - 1) != id || id_at(u, v + 1) != id;
      const double opacity = is_edge && options.has_outlines ? 1.0 : options.label_opacity;
      picture.image.at(u, v) = mix(picture.image.at(u, v), colors[id], opacity);
    }
  }
}

}  // namespace

Eigen::Vector2d SlicePicture::to_pixel(const Vec3& p_P) const noexcept {
  const Vec3 from_origin = p_P - plane.origin_P;
  return {from_origin.dot(plane.step_u_P) / plane.step_u_P.squaredNorm(),
          from_origin.dot(plane.step_v_P) / plane.step_v_P.squaredNorm()};
}

SlicePicture make_slice_picture(const VirtualPatient& patient, SliceOrientation orientation, const Vec3& through_P,
                                const SliceOptions& options) {
  constexpr float kAir_hu = -1024.0F;
  SlicePicture picture;
  picture.orientation = orientation;
  picture.plane = plane_through(patient.ct.geometry, orientation, through_P, options);
  picture.image = RgbImage(picture.plane.columns, picture.plane.rows);
  std::vector<float> hu(picture.image.pixels.size());
  sample_slice(patient.ct, picture.plane, kAir_hu, hu);
  for (std::size_t i = 0; i < hu.size(); ++i) {
    const std::uint8_t grey = grey_of(hu[i], options.window);
    picture.image.pixels[i] = {grey, grey, grey};
  }
  if (!patient.labels.empty()) draw_labels(patient, options, picture);
  return picture;
}

}  // namespace trocar
