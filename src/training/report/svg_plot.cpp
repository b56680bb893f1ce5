#include "report/svg_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "report/detail/html.h"

namespace trocar::report {
using detail::escape;
using detail::text_width;
namespace {

constexpr double kLeft = 58.0;
constexpr double kRight = 16.0;
constexpr double kBottom = 42.0;
constexpr double kRow = 17.0;  ///< Height of a row of legend, names or labels.
constexpr double kFont = 11.5;
constexpr double kColumn = 0.5;        ///< Width (px) of the columns to which curves are thinned.
constexpr double kTickSpacing = 62.0;  ///< Minimum space (px) for a number on the x axis,
constexpr double kTickHeight = 34.0;   ///< and on the y axis.

/// The plot area in the picture and the map from data to it.
struct Frame {
  double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;
  AxisRange x, y;
  double x_step = 1.0, y_step = 1.0;

  double px(double value) const { return left + (value - x.low) / (x.high - x.low) * (right - left); }
  double py(double value) const { return bottom - (value - y.low) / (y.high - y.low) * (bottom - top); }
};

AxisRange x_range_of(const Plot& plot) {
  if (plot.x_range) return *plot.x_range;
  std::vector<double> values;
  for (const PlotSeries& series : plot.series)
    for (const Point2& point : series.points) values.push_back(point.x());
  return range_of(values);
}

/// All curves and markers, always including zero.
AxisRange y_range_of(const Plot& plot) {
  std::vector<double> values{0.0};
  for (const PlotSeries& series : plot.series)
    for (const Point2& point : series.points) values.push_back(point.y());
  for (const PlotMarker& marker : plot.markers) values.push_back(marker.at.y());
  return range_of(values);
}

struct LegendEntry {
  const PlotSeries* series;
  double x;
  int row;
};

std::vector<LegendEntry> lay_out_legend(const Plot& plot) {
  constexpr double kSample = 34.0;
  constexpr double kGap = 16.0;
  constexpr double kLongestTranslation = 1.5;  ///< In the width of the English name; a report is translated when drawn.
  std::vector<LegendEntry> entries;
  double x = kLeft;
  int row = 0;
  for (const PlotSeries& series : plot.series) {
    const double width = kSample + kLongestTranslation * text_width(series.name, kFont) + kGap;
    if (x > kLeft && x + width - kGap > plot.width - kRight) {
      x = kLeft;
      ++row;
    }
    entries.push_back({&series, x, row});
    x += width;
  }
  return entries;
}

std::string draw_legend(const std::vector<LegendEntry>& entries) {
  std::string out;
  for (const LegendEntry& entry : entries) {
    const double y = kRow * (entry.row + 0.6);
    out += fmt::format("<line class=\"curve {}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>",
                       escape(entry.series->style), entry.x, y, entry.x + 28.0, y);
    out +=
        fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", entry.x + 34.0, y + 4.0, escape(entry.series->name));
  }
  return out;
}

/// Names in one row above the plot area, each connected to its position by a short line if it was moved.
std::string draw_names(const Frame& frame, double baseline, const std::vector<double>& at,
                       const std::vector<std::string>& names, const char* style) {
  std::vector<double> widths;
  for (const std::string& name : names) widths.push_back(text_width(name, kFont) + 8.0);
  const std::vector<double> centers = spread_labels(at, widths, {frame.left - 20.0, frame.right + kRight});
  std::string out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    out += fmt::format("<text class=\"{}\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", style,
                       centers[i], baseline, escape(names[i]));
    if (std::abs(centers[i] - at[i]) > 2.0)
      out += fmt::format("<line class=\"lead\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>", centers[i],
                         baseline + 2.5, at[i], frame.top);
  }
  return out;
}

std::string draw_bands(const Plot& plot, const Frame& frame, double baseline) {
  std::string out;
  std::vector<double> at;
  std::vector<std::string> names;
  for (const PlotBand& band : plot.bands) {
    const double from = frame.px(std::clamp(band.from, frame.x.low, frame.x.high));
    const double to = frame.px(std::clamp(band.to, frame.x.low, frame.x.high));
    if (!(to > from)) continue;
    out += fmt::format("<rect class=\"band {}\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>",
                       escape(band.style), from, frame.top, to - from, frame.bottom - frame.top);
    if (band.name.empty()) continue;
    at.push_back(0.5 * (from + to));
    names.push_back(band.name);
  }
  return out + draw_names(frame, baseline, at, names, "bandname");
}

std::string draw_axes(const Plot& plot, const Frame& frame) {
  std::string out;
  for (const double tick : ticks_in(frame.y, frame.y_step)) {
    const double y = frame.py(tick);
    out += fmt::format("<line class=\"{}\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>",
                       tick == 0.0 ? "zero" : "grid", frame.left, y, frame.right, y);
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>", frame.left - 7.0, y + 4.0,
                       tick_text(tick, frame.y_step));
  }
  for (const double tick : ticks_in(frame.x, frame.x_step)) {
    const double x = frame.px(tick);
    out += fmt::format("<line class=\"axis\" x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\"/>", x,
                       frame.bottom, frame.bottom + 4.0);
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>", x, frame.bottom + 17.0,
                       tick_text(tick, frame.x_step));
  }
  out += fmt::format("<rect class=\"frame\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\"/>", frame.left,
                     frame.top, frame.right - frame.left, frame.bottom - frame.top);
  out += fmt::format("<text class=\"title\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>",
                     0.5 * (frame.left + frame.right), frame.bottom + 35.0, escape(plot.x_title));
  out += fmt::format(
      "<text class=\"title\" transform=\"translate(14 {:.1f}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
      0.5 * (frame.top + frame.bottom), escape(plot.y_title));
  return out;
}

/// One continuous piece of a curve, thinned.
void append_piece(std::string& path, const std::vector<Point2>& piece) {
  bool is_first = true;
  for (const Point2& point : thin_out(piece, kColumn)) {
    path += fmt::format("{}{:.1f} {:.1f}", is_first ? "M" : " ", point.x(), point.y());
    is_first = false;
  }
}

std::string draw_series(const PlotSeries& series, const Frame& frame) {
  std::string path;
  std::vector<Point2> piece;
  for (const Point2& point : series.points) {
    const bool is_inside = point.allFinite() && point.x() >= frame.x.low && point.x() <= frame.x.high;
    if (is_inside) {
      piece.emplace_back(frame.px(point.x()), frame.py(point.y()));
    } else {
      append_piece(path, piece);
      piece.clear();
    }
  }
  append_piece(path, piece);
  if (path.empty()) return {};
  return fmt::format("<path class=\"curve {}\" d=\"{}\"/>", escape(series.style), path);
}

std::string marker_shape(std::size_t number, double x, double y) {
  switch (number % 4) {
    case 0:
      return fmt::format("<circle class=\"mark\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"4.5\"/>", x, y);
    case 1:
      return fmt::format("<rect class=\"mark\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"8.4\" height=\"8.4\"/>", x - 4.2,
                         y - 4.2);
    case 2:
      return fmt::format("<path class=\"mark\" d=\"M{:.1f} {:.1f} l5.2 9 h-10.4 z\"/>", x, y - 5.6);
    default:
      return fmt::format("<path class=\"mark\" d=\"M{:.1f} {:.1f} l5.4 5.4 l-5.4 5.4 l-5.4 -5.4 z\"/>", x, y - 5.4);
  }
}

double label_width(const PlotMarker& marker) {
  return text_width(marker.label, kFont + 1.0) + 12.0;
}

/// The markers whose labels fit beside each other; those of the lowest peaks are left out.
std::vector<std::size_t> labelled_markers(const Plot& plot, double room) {
  std::vector<std::size_t> labelled;
  double width = 0.0;
  for (std::size_t i = 0; i < plot.markers.size(); ++i) {
    if (plot.markers[i].label.empty()) continue;
    labelled.push_back(i);
    width += label_width(plot.markers[i]);
  }
  while (width > room && !labelled.empty()) {
    const auto lowest = std::ranges::min_element(labelled, {}, [&](std::size_t i) { return plot.markers[i].at.y(); });
    width -= label_width(plot.markers[*lowest]);
    labelled.erase(lowest);
  }
  return labelled;
}

/// Markers with labels above them, spread to avoid overlap.
std::string draw_markers(const Plot& plot, const Frame& frame) {
  const AxisRange room{frame.left + 2.0, frame.right - 2.0};
  const std::vector<std::size_t> labelled = labelled_markers(plot, room.high - room.low);
  std::vector<double> at;
  std::vector<double> widths;
  for (const std::size_t i : labelled) {
    at.push_back(frame.px(plot.markers[i].at.x()));
    widths.push_back(label_width(plot.markers[i]));
  }
  const std::vector<double> centers = spread_labels(at, widths, room);
  std::string out;
  for (std::size_t i = 0; i < plot.markers.size(); ++i)
    out += marker_shape(i, frame.px(plot.markers[i].at.x()), frame.py(plot.markers[i].at.y()));
  for (std::size_t n = 0; n < labelled.size(); ++n) {
    const double y = frame.py(plot.markers[labelled[n]].at.y());
    const double label_y = y - 20.0;
    out += fmt::format("<line class=\"lead\" x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\"/>", at[n], y - 5.0,
                       centers[n], label_y + 4.0);
    out += fmt::format("<text class=\"marklabel\" x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"middle\">{}</text>",
                       centers[n], label_y, escape(plot.markers[labelled[n]].label));
  }
  return out;
}

std::string draw_lines(const Plot& plot, const Frame& frame, double baseline) {
  std::string out;
  std::vector<double> at;
  std::vector<std::string> names;
  for (const PlotLine& line : plot.lines) {
    if (!(line.x >= frame.x.low && line.x <= frame.x.high)) continue;
    const double x = frame.px(line.x);
    out += fmt::format("<line class=\"event\" x1=\"{0:.1f}\" y1=\"{1:.1f}\" x2=\"{0:.1f}\" y2=\"{2:.1f}\"/>", x,
                       frame.top, frame.bottom);
    if (line.label.empty()) continue;
    at.push_back(x);
    names.push_back(line.label);
  }
  return out + draw_names(frame, baseline, at, names, "eventname");
}

/// A drawing with its size, without the <svg> element around it.
struct Drawing {
  double width = 0.0;
  double height = 0.0;
  std::string elements;
};

Drawing draw(const Plot& plot) {
  const std::vector<LegendEntry> legend = lay_out_legend(plot);
  // A single curve needs no legend: the axis names it.
  const double legend_height = plot.series.size() > 1 ? kRow * (legend.back().row + 1) + 3.0 : 0.0;
  const auto has_name = [](const PlotBand& band) { return !band.name.empty(); };
  const auto has_label = [](const PlotLine& line) { return !line.label.empty(); };
  const double bands_height = std::any_of(plot.bands.begin(), plot.bands.end(), has_name) ? kRow : 0.0;
  const double lines_height = std::any_of(plot.lines.begin(), plot.lines.end(), has_label) ? kRow : 0.0;
  const double total = legend_height + bands_height + lines_height + plot.height;

  Frame frame;
  frame.left = kLeft;
  frame.right = plot.width - kRight;
  frame.top = legend_height + bands_height + lines_height + 6.0;
  frame.bottom = total - kBottom;
  frame.x = x_range_of(plot);
  frame.x_step = nice_step(frame.x, std::max(1, static_cast<int>((frame.right - frame.left) / kTickSpacing)));
  frame.y = y_range_of(plot);
  // Space for the labels above the highest marker.
  if (!plot.markers.empty()) frame.y.high += 0.16 * (frame.y.high - frame.y.low);
  frame.y_step = nice_step(frame.y, std::max(2, static_cast<int>((frame.bottom - frame.top) / kTickHeight)));
  // A curve slightly below zero gets less than a whole step of space there.
  constexpr double kDip = 0.35;
  const double dip = frame.y.low;
  frame.y = nice_range(frame.y, frame.y_step);
  if (dip < 0.0 && dip > -kDip * frame.y_step) frame.y.low = -kDip * frame.y_step;

  std::string out = draw_bands(plot, frame, legend_height + lines_height + bands_height);
  out += draw_axes(plot, frame);
  out += draw_lines(plot, frame, legend_height + lines_height - 2.0);
  for (const PlotSeries& series : plot.series) out += draw_series(series, frame);
  out += draw_markers(plot, frame);
  if (plot.series.size() > 1) out += draw_legend(legend);
  return {plot.width, total, std::move(out)};
}

}  // namespace

std::string to_svg(const Plot& plot) {
  const Drawing drawing = draw(plot);
  return fmt::format("<svg class=\"plot\" viewBox=\"0 0 {:.0f} {:.0f}\" role=\"img\" aria-label=\"{}\">{}</svg>",
                     drawing.width, drawing.height, escape(plot.description), drawing.elements);
}

std::string to_svg_file(const Plot& plot, std::string_view title) {
  constexpr double kTitle = 30.0;  // space above the drawing
  constexpr double kMargin = 8.0;
  const Drawing drawing = draw(plot);
  const double width = drawing.width + 2.0 * kMargin;
  const double height = drawing.height + kTitle + kMargin;
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} "
      "{1:.0f}\">\n"
      "<title>{2}</title>\n<style>{3}</style>\n<rect class=\"paper\" width=\"100%\" height=\"100%\"/>\n"
      "<text class=\"heading\" x=\"{4:.1f}\" y=\"{5:.1f}\">{6}</text>\n<g transform=\"translate({7:.1f} "
      "{8:.1f})\">{9}</g>\n"
      "</svg>\n",
      width, height, escape(plot.description), detail::plot_style(), kLeft + kMargin, 0.66 * kTitle, escape(title),
      kMargin, kTitle, drawing.elements);
}

}  // namespace trocar::report
