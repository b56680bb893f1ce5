#include "report/stitch_report.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "image/image.h"
#include "png/png_file.h"
#include "registration/intensity/gray_levels.h"
#include "registration/shadow/shadow_mask.h"
#include "report/detail/html.h"

namespace trocar::report::detail {

/// Index axes of a slice: its rows run along `along` (the sound, downwards), its columns along `column`.
struct SliceAxes {
  int column = 0, along = 1, across = 2;
};

/// The axes of the grid nearest to the beam, the lateral and the elevation direction.
SliceAxes slice_axes(const registration::Beams& beams, const volume::GridGeometry& geometry);

/// A slice of an ultrasound volume as an SVG image; one unit is half a millimetre.
struct VolumeSlice {
  image::RgbImage image;
  volume::GridGeometry geometry;
  SliceAxes axes;

  double width() const noexcept;
  double height() const noexcept;
  /// Place (x, y) of a point of the volume, projected on the slice.
  std::array<double, 2> place(const Vec3& p_P) const noexcept;
  std::string svg(double x) const;
};

/// Gray levels as far as the volume uses them. `region`: shadows are drawn bluish; may be null.
VolumeSlice cut_slice(const volume::LabelGrid& gray, const registration::ImagedRegion* region, const SliceAxes& axes,
                      std::int64_t index);
/// With lines where `source` changes.
VolumeSlice cut_borders(const volume::LabelGrid& gray, const volume::LabelGrid& source, const SliceAxes& axes,
                        std::int64_t index);

}  // namespace trocar::report::detail

namespace trocar::report {
namespace {
using namespace detail;
using registration::PreparedVolume;
using registration::StitchEdge;
using Volumes = std::vector<PreparedVolume>;

constexpr std::size_t kMostFigures = 12;  ///< Pairs that are drawn.
constexpr std::size_t kMostOthers = 60;   ///< Matches drawn that do not agree.

std::string volume_table(const Volumes& volumes, const registration::Stitching& stitching) {
  std::string rows =
      "<table class=\"list\"><tr><th>volume</th><th>voxels</th><th>in shadow</th><th>keypoints</th><th>place in the "
      "first volume</th></tr>";
  for (std::size_t n = 0; n < volumes.size(); ++n) {
    const PreparedVolume& v = volumes[n];
    const auto& size = v.gray.geometry.size;
    std::string place = "not placed";
    if (stitching.X_0N[n]) {
      const Vec3 middle =
          v.gray.geometry.to_mm(0.5 * Vec3(static_cast<double>(size[0] - 1), static_cast<double>(size[1] - 1),
                                           static_cast<double>(size[2] - 1)));
      const Pose& X = *stitching.X_0N[n];
      place = fmt::format("moved {} mm, turned {}°", number_text((X * middle - middle).norm(), 1),
                          number_text(degrees(Eigen::AngleAxisd(X.R()).angle()), 1));
      if (n == 0) place = "reference";
    }
    rows +=
        fmt::format("<tr><td>{}</td><td>{} × {} × {}</td><td>{:.0f} %</td><td>{}</td><td>{}</td></tr>", escape(v.name),
                    size[0], size[1], size[2], 100.0 * v.region.shadow_share, v.keypoints.keypoints.size(), place);
  }
  return rows + "</table>";
}

/// Volumes on a circle, pairs as lines: thick with many inliers, dashed where removed or refused.
std::string graph_figure(const Volumes& volumes, const registration::Stitching& stitching) {
  constexpr double kWidth = 760.0, kHeight = 420.0;
  const auto place = [&](std::size_t n) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(n) / static_cast<double>(volumes.size());
    return Vec3(0.5 * kWidth - 250.0 * std::cos(angle), 0.5 * kHeight - 160.0 * std::sin(angle), 0.0);
  };
  std::string svg =
      fmt::format("<figure><svg viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"graph of pairs\">", kWidth, kHeight);
  for (const StitchEdge& edge : stitching.edges) {
    const bool is_drawn = edge.is_used || edge.pair.is_found || edge.pair.confidence > 0.05;
    if (!is_drawn) continue;
    const Vec3 a = place(edge.pair.a), b = place(edge.pair.b), label = a + 0.36 * (b - a);
    const double width = 1.5 + std::min(8.0, 0.4 * static_cast<double>(edge.pair.inliers.size()));
    svg += fmt::format(
        "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" stroke-width=\"{:.1f}\"{}/>",
        a.x(), a.y(), b.x(), b.y(), edge.is_used ? "#0b6e75" : "#b45309", edge.is_used ? width : 1.5,
        edge.is_used ? "" : " stroke-dasharray=\"6 4\"");
    svg += fmt::format(
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" stroke=\"#fff\" stroke-width=\"4\" "
        "paint-order=\"stroke\">{}</text>",
        label.x(), label.y() + 4.0, edge.pair.inliers.size());
  }
  for (std::size_t n = 0; n < volumes.size(); ++n) {
    const Vec3 p = place(n);
    const double width = text_width(volumes[n].name, 12.5) + 22.0;
    svg += fmt::format(
        "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"28\" rx=\"6\" fill=\"{}\" stroke=\"#51606d\"/>"
        "<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\" font-size=\"12.5\">{}</text>",
        p.x() - 0.5 * width, p.y() - 14.0, width, stitching.X_0N[n] ? "#e2f2f0" : "#fbe7d3", p.x(), p.y() + 4.0,
        escape(volumes[n].name));
  }
  return svg +
         "</svg><figcaption>Pairs of volumes, with the number of matches that agree. Solid: used. Dashed: too little "
         "confidence, or in contradiction with the "
         "other pairs. Wide lines: many matches that agree.</figcaption></figure>";
}

std::string pair_table(const Volumes& volumes, const registration::Stitching& stitching) {
  std::string rows =
      "<table class=\"list\"><tr><th>pair</th><th>matches</th><th>inliers</th><th>rms mm</th><th>correlation</th>"
      "<th>overlap</th><th>confidence</th><th>contradiction mm</th></tr>";
  for (const StitchEdge& edge : stitching.edges) {
    if (!edge.pair.is_found) continue;
    rows += fmt::format(
        "<tr><td>{} – {}</td><td>{}</td><td>{}</td><td>{}</td><td>{:.2f}</td><td>{:.0f} %</td><td>{:.2f}</td><td>{}"
        "</td></tr>",
        escape(volumes[edge.pair.a].name), escape(volumes[edge.pair.b].name), edge.pair.matches.size(),
        edge.pair.inliers.size(), number_text(edge.pair.keypoint_rms_mm, 2), edge.pair.ncc, 100.0 * edge.pair.overlap,
        edge.pair.confidence, edge.is_used ? number_text(edge.contradiction_mm, 2) : "removed");
  }
  return rows + "</table>";
}

double median(std::vector<double> values, double otherwise) {
  if (values.empty()) return otherwise;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Slice of one volume of a pair, through the middle of its agreeing keypoints.
VolumeSlice slice_of_pair(const PreparedVolume& volume, const StitchEdge& edge, bool is_a) {
  const SliceAxes axes = slice_axes(volume.beams, volume.gray.geometry);
  std::vector<double> across;
  for (const std::size_t n : edge.pair.inliers) {
    const registration::Match& m = edge.pair.matches[n];
    const Vec3& p = volume.keypoints.keypoints[is_a ? m.a : m.b].p_P;
    across.push_back(volume.gray.geometry.to_index(p)[axes.across]);
  }
  const auto last = static_cast<double>(volume.gray.geometry.size[static_cast<std::size_t>(axes.across)] - 1);
  return cut_slice(volume.gray, &volume.region, axes, std::lround(median(across, 0.5 * last)));
}

std::string match_figure(const Volumes& volumes, const StitchEdge& edge) {
  const PreparedVolume &a = volumes[edge.pair.a], &b = volumes[edge.pair.b];
  const VolumeSlice left = slice_of_pair(a, edge, true), right = slice_of_pair(b, edge, false);
  constexpr double kGap = 40.0;
  const double offset = left.width() + kGap;
  const double height = std::max(left.height(), right.height());
  std::string svg =
      fmt::format("<figure><svg viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"matches of a pair\">{}{}",
                  offset + right.width(), height, left.svg(0.0), right.svg(offset));
  const auto line = [&](std::size_t n, const char* style) {
    const registration::Match& m = edge.pair.matches[n];
    const auto p = left.place(a.keypoints.keypoints[m.a].p_P), q = right.place(b.keypoints.keypoints[m.b].p_P);
    svg += fmt::format("<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" {}/>", p[0], p[1], offset + q[0],
                       q[1], style);
  };
  std::vector<bool> agrees(edge.pair.matches.size(), false);
  for (const std::size_t n : edge.pair.inliers) agrees[n] = true;
  for (std::size_t n = 0, drawn = 0; n < agrees.size() && drawn < kMostOthers; ++n) {
    if (agrees[n]) continue;
    line(n, "stroke=\"#e07b39\" stroke-width=\"0.6\" opacity=\"0.45\"");
    ++drawn;
  }
  for (const std::size_t n : edge.pair.inliers) line(n, "stroke=\"#2fc48d\" stroke-width=\"1.6\"");
  return svg + fmt::format(
                   "</svg><figcaption>{} and {}: {} matches agree (green), {} do not (thin orange). Keypoints are "
                   "projected on the slices; shadows are blue.</figcaption></figure>",
                   escape(a.name), escape(b.name), edge.pair.inliers.size(),
                   edge.pair.matches.size() - edge.pair.inliers.size());
}

std::string panorama_figures(const registration::Panorama& panorama, const PreparedVolume& first) {
  std::string html;
  const SliceAxes axes = slice_axes(first.beams, first.gray.geometry);
  const auto& size = panorama.gray.geometry.size;
  for (const SliceAxes& cut : {axes, SliceAxes{axes.across, axes.along, axes.column}}) {
    const VolumeSlice plain = cut_slice(panorama.gray, nullptr, cut, size[static_cast<std::size_t>(cut.across)] / 2);
    const VolumeSlice seams =
        cut_borders(panorama.gray, panorama.source, cut, size[static_cast<std::size_t>(cut.across)] / 2);
    for (const VolumeSlice* slice : {&plain, &seams})
      html += fmt::format(
          "<figure><svg viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"panorama\">{}</svg>"
          "<figcaption>{}</figcaption></figure>",
          slice->width(), slice->height(), slice->svg(0.0),
          slice == &plain ? "Panorama" : "The same with the borders between the volumes that dominate");
  }
  return html + fmt::format(
                    "<p class=\"note\">Mean difference of the smoothed gray levels of two volumes at their border: {} "
                    "of 255.</p>",
                    number_text(panorama.seam_difference, 1));
}

}  // namespace

std::string stitch_report(const Volumes& volumes, const registration::Stitching& stitching,
                          const std::vector<registration::PlacedVolume>& placed,
                          const registration::Panorama& panorama) {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><meta name=\"viewport\" "
      "content=\"width=device-width, initial-scale=1\"><title>Stitched ultrasound volumes</title><style>";
  page += style_sheet() + "</style></head><body><main><header><h1>Stitched ultrasound volumes</h1>";
  page += fmt::format("<p>{} of {} volumes placed in the frame of {}.</p></header>", placed.size(), volumes.size(),
                      escape(volumes.front().name));
  for (std::size_t n = 0; n < volumes.size(); ++n)
    if (!stitching.X_0N[n])
      page += "<p class=\"warning\">" + escape(volumes[n].name) +
              " is not placed: no connection to the first volume is trustworthy.</p>";
  page += "<section><h2>Volumes</h2>" + volume_table(volumes, stitching) + "</section>";
  page += "<section><h2>Pairs</h2>" + graph_figure(volumes, stitching) + pair_table(volumes, stitching) + "</section>";
  page += "<section><h2>Matches</h2>";
  std::size_t drawn = 0;
  for (const StitchEdge& edge : stitching.edges)
    if (edge.is_used && drawn++ < kMostFigures) page += match_figure(volumes, edge);
  page += "</section><section><h2>Panorama and seams</h2>" + panorama_figures(panorama, volumes.front()) + "</section>";
  return page +
         "<footer>Made by Trocar, a training simulator and not a medical device.</footer></main></body></html>\n";
}

}  // namespace trocar::report

namespace trocar::report::detail {
namespace {

constexpr double kUnitsPerMm = 2.0;
constexpr image::Rgb kBorder = {255, 190, 60};

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
  slice.image = image::RgbImage(static_cast<int>(size[static_cast<std::size_t>(axes.column)]),
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
