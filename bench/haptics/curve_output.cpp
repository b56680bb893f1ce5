#include "bench/haptics/curve_output.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/files/output_file.h"
#include "report/svg_plot.h"

namespace trocar::bench {
namespace {

constexpr int kPlotRows = 45;  ///< Maximum rows of the plot on a terminal.
constexpr int kBar = 20;       ///< Characters of the longest bar.

std::string words(std::string text) {
  std::replace(text.begin(), text.end(), '_', ' ');
  return text;
}

/// Of the longest curve.
double length_mm(const PathCurves& path) {
  double length = 0.0;
  for (const NamedCurve& curve : path.curves)
    if (!curve.points.empty()) length = std::max(length, curve.points.back().way_mm);
  return length;
}

double largest_n(const PathCurves& path) {
  double largest = 0.0;
  for (const NamedCurve& curve : path.curves)
    for (const cases::CurvePoint& point : curve.points) largest = std::max(largest, point.force_n);
  return largest;
}

/// Largest force in an interval of the device's displacement, and whether a layer was punctured there.
struct Bin {
  double force_n = 0.0;
  bool is_puncture = false;
};
Bin bin_of(const NamedCurve& curve, double from_mm, double to_mm) {
  Bin bin;
  bool is_first = true;
  for (const cases::CurvePoint& point : curve.points) {
    if (point.way_mm < from_mm || point.way_mm >= to_mm) continue;
    bin.force_n = is_first ? point.force_n : std::max(bin.force_n, point.force_n);
    is_first = false;
  }
  for (const cases::CurveEvent& event : curve.events)
    if (event.way_mm >= from_mm && event.way_mm < to_mm) bin.is_puncture = true;
  return bin;
}

/// Names of the path pieces that begin in a row; in the first row, all pieces present.
std::string names_in(const PathCurves& path, double from_mm, double to_mm) {
  std::string names;
  for (const cases::PathPiece& piece : path.pieces) {
    if (piece.from_mm < from_mm || piece.from_mm >= to_mm) continue;
    if (!names.empty()) names += ", ";
    names += words(piece.name);
  }
  return names;
}

report::Plot plot_of(const PathCurves& path) {
  constexpr const char* kStyles[] = {"c-total", "c-second", "c-third"};
  report::Plot plot;
  plot.description = "Force along the needle against the depth of the device, " + path.title;
  plot.x_title = "displacement of the device past the resting skin (mm)";
  plot.y_title = "force along the needle (N)";
  plot.width = 940.0;
  plot.height = 400.0;
  plot.x_range = report::AxisRange{0.0, length_mm(path)};
  for (const cases::PathPiece& piece : path.pieces) {
    plot.bands.push_back({piece.from_mm, piece.to_mm, words(piece.name), "t-" + piece.tissue});
    if (piece.from_mm > 0.0) plot.lines.push_back({piece.from_mm, ""});
  }
  for (std::size_t i = 0; i < path.curves.size(); ++i) {
    report::PlotSeries series{path.curves[i].name, kStyles[i % std::size(kStyles)], {}};
    for (const cases::CurvePoint& point : path.curves[i].points)
      series.points.emplace_back(point.way_mm, point.force_n);
    plot.series.push_back(std::move(series));
  }
  // The layers are named once, on the curve with the most punctures.
  const auto marked =
      std::max_element(path.curves.begin(), path.curves.end(),
                       [](const NamedCurve& a, const NamedCurve& b) { return a.events.size() <= b.events.size(); });
  if (marked == path.curves.end()) return plot;
  for (const cases::CurveEvent& event : marked->events)
    plot.markers.push_back(
        {{event.way_mm, event.peak_n}, fmt::format("{} {:.1f} N", words(event.layer), event.peak_n)});
  return plot;
}

/// Curves of one motion: their ticks are identical.
std::string csv_of(const PathCurves& path, const anatomy::TissueTable& tissues) {
  std::string csv = "time_s,device_mm";
  for (const NamedCurve& curve : path.curves)
    csv += fmt::format(",{0}_force_n,{0}_tip_mm,{0}_tissue,{0}_puncture", curve.name);
  csv += "\n";
  const auto longest =
      std::max_element(path.curves.begin(), path.curves.end(),
                       [](const NamedCurve& a, const NamedCurve& b) { return a.points.size() < b.points.size(); });
  const std::size_t count = path.curves.empty() ? 0 : longest->points.size();
  for (std::size_t i = 0; i < count; ++i) {
    csv += fmt::format("{:.3f},{:.4f}", longest->points[i].time_s, longest->points[i].way_mm);
    for (const NamedCurve& curve : path.curves) {
      if (i >= curve.points.size()) {
        csv += ",,,,";
        continue;
      }
      const cases::CurvePoint& point = curve.points[i];
      csv += fmt::format(",{:.5f},{:.4f},{},{}", point.force_n, point.tip_mm, tissues.tissues[point.tissue].name,
                         point.layer == haptics::kNoLayer ? std::string() : tissues.layers[point.layer].name);
    }
    csv += "\n";
  }
  return csv;
}

}  // namespace

std::string curves_text(const PathCurves& path) {
  const double length = length_mm(path);
  if (path.curves.empty() || !(length > 0.0)) return {};
  const double step = report::nice_step({0.0, length}, kPlotRows);
  const double full_n = std::max(largest_n(path), 1e-9);
  std::string text = fmt::format("{}\n  {:>7}", path.title, "mm");
  for (const NamedCurve& curve : path.curves) text += fmt::format("   {:<{}}", curve.name, kBar + 7);
  text += " begins here\n";
  const auto rows = static_cast<int>(std::ceil(length / step - 1e-9));
  for (int row = 0; row < rows; ++row) {
    const double from = step * row;
    text += fmt::format("  {:>7}", report::tick_text(from, step));
    for (const NamedCurve& curve : path.curves) {
      const Bin bin = bin_of(curve, from, from + step);
      const auto filled = static_cast<int>(std::lround(kBar * std::clamp(bin.force_n / full_n, 0.0, 1.0)));
      text += fmt::format("   {:5.2f}{}{:<{}} ", bin.force_n, bin.is_puncture ? '*' : ' ',
                          std::string(static_cast<std::size_t>(filled), '#'), kBar);
    }
    text += fmt::format(" {}\n", names_in(path, from, from + step));
  }
  return text + fmt::format("  largest force (N) in each row; * puncture of a layer; longest bar {:.2f} N\n\n", full_n);
}

Status write_curves(const PathCurves& path, const anatomy::TissueTable& tissues, const std::filesystem::path& folder) {
  TROCAR_TRY_STATUS(write_file_atomically(folder / (path.name + ".csv"), csv_of(path, tissues)));
  return write_file_atomically(folder / (path.name + ".svg"),
                               report::to_svg_file(plot_of(path), "Force along the needle: " + path.title));
}

}  // namespace trocar::bench
