#include "slices/paint_slice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/result.h"
#include "motion/rest_plane.h"

namespace trocar::slices {
namespace {

/// A label's colour blended with gray: (gray * gray_share + color) / 256, rounded. All zero: the label is not drawn.
struct Ink {
  std::array<std::uint32_t, 3> color{};
  std::uint32_t gray_share = 256;
};

Ink ink_of(const image::Rgb& color, double opacity) {
  Ink ink;
  const auto share = static_cast<std::uint32_t>(std::lround(256.0 * std::clamp(opacity, 0.0, 1.0)));
  ink.gray_share = 256 - share;
  for (std::size_t c = 0; c < 3; ++c) ink.color[c] = share * color[c] + 128;
  return ink;
}

struct Inks {
  std::array<bool, 256> is_drawn{};
  std::array<Ink, 256> fill;
  std::array<Ink, 256> outline;
};

Inks inks_of(const anatomy::LabelTable& table, const SliceStyle& style) {
  Inks inks;
  for (const anatomy::Label& label : table.labels) {
    if (!is_drawn(label)) continue;
    inks.is_drawn[label.id] = true;
    inks.fill[label.id] = ink_of(label.color, style.label_opacity);
    inks.outline[label.id] = style.has_outlines ? ink_of(label.color, 1.0) : inks.fill[label.id];
  }
  return inks;
}

image::Rgb lay_over(std::uint8_t gray, const Ink& ink) {
  image::Rgb out;
  for (std::size_t c = 0; c < 3; ++c) out[c] = static_cast<std::uint8_t>((gray * ink.gray_share + ink.color[c]) >> 8U);
  return out;
}

/// One row of labels over gray. `above` and `below` are the adjacent rows; outside the picture there is no label.
struct LabelRow {
  const std::uint8_t* ids;
  const std::uint8_t* above;
  const std::uint8_t* below;
};

void draw_row(const LabelRow& row, const std::uint8_t* gray, const Inks& inks, std::size_t columns, image::Rgb* out) {
  for (std::size_t u = 0; u < columns; ++u) {
    const std::uint8_t id = row.ids[u];
    if (!inks.is_drawn[id]) continue;
    const std::uint8_t left = u > 0 ? row.ids[u - 1] : std::uint8_t{0};
    const std::uint8_t right = u + 1 < columns ? row.ids[u + 1] : std::uint8_t{0};
    const bool is_edge = left != id || right != id || row.above[u] != id || row.below[u] != id;
    out[u] = lay_over(gray[u], is_edge ? inks.outline[id] : inks.fill[id]);
  }
}

void hide_lesions(const anatomy::LabelTable& table, std::span<std::uint8_t> ids) {
  const std::array<std::uint8_t, 256> shown = anatomy::lesions_as_organs(table);
  for (std::uint8_t& id : ids) id = shown[id];
}

void draw_labels(const anatomy::VirtualPatient& patient, const volume::SlicePlane& plane, const SliceStyle& style,
                 SliceBuffers& buffers, image::RgbImage& picture, bool is_moved) {
  // A row of "no label" precedes the first row and follows the last one.
  const auto columns = static_cast<std::size_t>(plane.columns);
  const auto rows = static_cast<std::size_t>(plane.rows);
  buffers.ids.assign((rows + 2) * columns, 0);
  const std::span<std::uint8_t> ids_of_plane = std::span(buffers.ids).subspan(columns, rows * columns);
  if (is_moved)
    for (std::size_t n = 0; n < ids_of_plane.size(); ++n)
      ids_of_plane[n] = volume::sample_nearest(patient.labels, buffers.rest_A[n].cast<double>(), std::uint8_t{0});
  else
    volume::sample_slice_nearest(patient.labels, plane, 0, ids_of_plane);
  if (style.hides_lesions) hide_lesions(patient.label_table, buffers.ids);
  const Inks inks = inks_of(patient.label_table, style);
  for (std::size_t v = 0; v < rows; ++v) {
    const std::uint8_t* ids = buffers.ids.data() + (v + 1) * columns;
    draw_row({ids, ids - columns, ids + columns}, buffers.gray.data() + v * columns, inks, columns,
             picture.pixels.data() + v * columns);
  }
}

}  // namespace

bool is_drawn(const anatomy::Label& label) noexcept {
  return label.tissue != "adipose" && label.tissue != "muscle" && label.tissue != "skin";
}

void paint_slice(const anatomy::VirtualPatient& patient, const volume::SlicePlane& plane, const SliceStyle& style,
                 SliceBuffers& buffers, image::RgbImage& picture, const motion::PatientMotion& motion) {
  constexpr float kAir_hu = -1024.0F;
  const std::size_t count = static_cast<std::size_t>(plane.columns) * static_cast<std::size_t>(plane.rows);
  picture.columns = plane.columns;
  picture.rows = plane.rows;
  picture.pixels.resize(count);
  buffers.hu.resize(count);
  buffers.gray.resize(count);
  if (motion.is_rest()) {
    volume::sample_slice(patient.ct, plane, kAir_hu, buffers.hu);
  } else {
    motion::rest_of_plane(motion, plane, buffers.rest_A);
    volume::sample_points(patient.ct, buffers.rest_A, kAir_hu, buffers.hu);
  }
  apply_window(buffers.hu, style.window, buffers.gray);
  for (std::size_t n = 0; n < count; ++n) picture.pixels[n].fill(buffers.gray[n]);
  const bool shows_labels = style.label_opacity > 0.0 || style.has_outlines;
  if (shows_labels && !patient.labels.empty()) draw_labels(patient, plane, style, buffers, picture, !motion.is_rest());
}

std::string_view window_name(const Window& window) noexcept {
  constexpr double kSame_hu = 0.5;
  for (const WindowPreset& preset : kWindowPresets)
    if (std::abs(preset.window.center_hu - window.center_hu) < kSame_hu &&
        std::abs(preset.window.width_hu - window.width_hu) < kSame_hu)
      return preset.name;
  return {};
}

void apply_window(std::span<const float> hu, const Window& window, std::span<std::uint8_t> gray) {
  TROCAR_CHECK(hu.size() == gray.size() && window.width_hu > 0.0);
  const auto steps_per_hu = static_cast<float>(255.0 / window.width_hu);
  const auto center_hu = static_cast<float>(window.center_hu);
  constexpr float kMiddle = 127.5F + 0.5F;  // 0.5 for rounding
  for (std::size_t n = 0; n < hu.size(); ++n) {
    const float step = (hu[n] - center_hu) * steps_per_hu + kMiddle;
    const float positive = step > 0.0F ? step : 0.0F;  // also NaN
    gray[n] = static_cast<std::uint8_t>(static_cast<int>(positive < 255.0F ? positive : 255.0F));
  }
}

namespace {

constexpr std::array<double, 3> kOrange{1.0, 0.6, 0.15};

std::uint8_t to_byte(double value) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(value, 0.0, 255.0)));
}

/// The CT becomes darker as the ultrasound becomes stronger, so that their sum is not saturated.
image::Rgb blend(const image::Rgb& ct, double us, double share) {
  image::Rgb out;
  for (std::size_t c = 0; c < 3; ++c) out[c] = to_byte((1.0 - share) * ct[c] + share * 1.4 * kOrange[c] * us);
  return out;
}

}  // namespace

void fuse_ultrasound(const PlacedUltrasound& ultrasound, const volume::SlicePlane& plane, const FusionStyle& style,
                     image::RgbImage& picture) {
  TROCAR_CHECK(picture.columns == plane.columns && picture.rows == plane.rows);
  if (style.kind == FusionKind::kOff) return;
  const Pose X_UP = ultrasound.X_PU.inverse();
  const Vec3 right_P = plane.step_u_P.normalized(), down_P = plane.step_v_P.normalized();
  const double share = std::clamp(style.share, 0.0, 1.0);
  for (int row = 0; row < plane.rows; ++row)
    for (int column = 0; column < plane.columns; ++column) {
      const Vec3 p_P = plane.origin_P + column * plane.step_u_P + row * plane.step_v_P;
      const Vec3 p_U = X_UP * p_P;
      if (volume::sample_nearest(ultrasound.imaged_U, p_U, std::uint8_t{0}) == 0) continue;
      const double us = std::min(255.0, 255.0 * volume::sample_linear(ultrasound.gray_U, p_U) / ultrasound.white);
      image::Rgb& pixel = picture.at(column, row);
      if (style.kind == FusionKind::kBlend) {
        pixel = blend(pixel, us, share);
        continue;
      }
      const double field = std::floor(right_P.dot(p_P) / style.field_mm) + std::floor(down_P.dot(p_P) / style.field_mm);
      if ((std::lround(field) & 1) == 0) pixel.fill(to_byte(us));
    }
}

}  // namespace trocar::slices
