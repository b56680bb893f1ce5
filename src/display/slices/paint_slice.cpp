#include "slices/paint_slice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "motion/rest_plane.h"

namespace trocar::slices {
namespace {

/// A label's colour blended with gray: (gray * gray_share + color) / 256, rounded. All zero: the label is not drawn.
struct Ink {
  std::array<std::uint32_t, 3> color{};
  std::uint32_t gray_share = 256;
};

Ink ink_of(const volume::Rgb& color, double opacity) {
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

volume::Rgb lay_over(std::uint8_t gray, const Ink& ink) {
  volume::Rgb out;
  for (std::size_t c = 0; c < 3; ++c) out[c] = static_cast<std::uint8_t>((gray * ink.gray_share + ink.color[c]) >> 8U);
  return out;
}

/// One row of labels over gray. `above` and `below` are the adjacent rows; outside the picture there is no label.
struct LabelRow {
  const std::uint8_t* ids;
  const std::uint8_t* above;
  const std::uint8_t* below;
};

void draw_row(const LabelRow& row, const std::uint8_t* gray, const Inks& inks, std::size_t columns, volume::Rgb* out) {
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
                 SliceBuffers& buffers, volume::RgbImage& picture, bool is_moved) {
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
                 SliceBuffers& buffers, volume::RgbImage& picture, const motion::PatientMotion& motion) {
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

}  // namespace trocar::slices
