#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "report/plot_scale.h"

namespace trocar::report {

/// A curve. `style` is a CSS class that gives colour and dashes (report/detail/html.h). Points that are not finite
/// break the line.
struct PlotSeries {
  std::string name;
  std::string style;
  std::vector<Point2> points;
};

/// A vertical stripe of the background, named in a row above the plot.
struct PlotBand {
  double from = 0.0;
  double to = 0.0;
  std::string name;
  std::string style;
};

/// A point with a label and a shape of its own (circle, square, triangle, diamond, in the order of the list).
struct PlotMarker {
  Point2 at{0.0, 0.0};
  std::string label;
};

/// A vertical line, named in a row above the plot.
struct PlotLine {
  double x = 0.0;
  std::string label;
};

/// A plot in data units. Legend, names of stripes and lines stand above the plot area, so that they never cover data.
struct Plot {
  std::string description;  ///< Text for screen readers.
  std::string x_title;      ///< Title with unit.
  std::string y_title;
  double width = 760.0;
  double height = 300.0;  ///< Height of the plot area and its axes; legend and names are added above.
  std::optional<AxisRange> x_range;
  std::vector<PlotBand> bands;
  std::vector<PlotSeries> series;
  std::vector<PlotMarker> markers;
  std::vector<PlotLine> lines;
};

/// The plot as an <svg> element. All texts are escaped.
std::string to_svg(const Plot& plot);
/// The same as a separate file, with style and a title above it: for print, and for programs that do not display HTML.
std::string to_svg_file(const Plot& plot, std::string_view title);

}  // namespace trocar::report
