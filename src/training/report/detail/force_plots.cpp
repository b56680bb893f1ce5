#include "report/detail/force_plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "anatomy/structure_words.h"
#include "report/detail/html.h"
#include "report/session_analysis.h"
#include "report/svg_plot.h"

namespace trocar::report::detail {
namespace {

constexpr std::size_t kMostInsertions = 3;  ///< Drawn insertions; more would not be distinguishable.
constexpr double kPlotPixels = 1400.0;      ///< Narrower stripes are joined to the previous one.

std::string figure(const std::string& body, std::string_view caption) {
  return "<figure>" + body + "<figcaption>" + std::string(caption) + "</figcaption></figure>";
}

/// Stripes of the deepest insertion's tissues; each tissue is named at its first stripe and at wide ones.
std::vector<PlotBand> tissue_bands(const storage::Session& session, const Insertion& insertion, double depth_mm) {
  constexpr double kWide = 0.12;  // of the axis
  std::vector<PlotBand> bands;
  std::set<std::uint8_t> named;
  std::optional<std::uint8_t> last;
  for (const TissueRun& run : tissues_along(session, insertion)) {
    if (last && (run.tissue == *last || run.to_mm - run.from_mm < depth_mm / kPlotPixels)) {
      bands.back().to = run.to_mm;
      continue;
    }
    const std::string tissue = tissue_name(session.info, run.tissue);
    const bool is_named = named.insert(run.tissue).second || run.to_mm - run.from_mm > kWide * depth_mm;
    bands.push_back({run.from_mm, run.to_mm, is_named ? words(tissue) : std::string(), tissue_style(tissue)});
    last = run.tissue;
  }
  return bands;
}

std::vector<PlotBand> phase_bands(const storage::Session& session) {
  std::vector<PlotBand> bands;
  if (session.samples.empty()) return bands;
  const double narrow_s = (session.samples.back().time_s - session.samples.front().time_s) / kPlotPixels;
  for (const PhaseRun& run : phase_runs(session)) {
    const std::string style = std::string("p-") + to_string(run.phase);
    if (!bands.empty() && (bands.back().style == style || run.to_s - run.from_s < narrow_s))
      bands.back().to = run.to_s;
    else
      bands.push_back({run.from_s, run.to_s, "", style});
  }
  return bands;
}

std::vector<PlotLine> event_lines(const storage::Session& session, bool are_named) {
  std::vector<PlotLine> lines;
  for (const Puncture& puncture : find_punctures(session))
    lines.push_back({puncture.time_s, are_named ? words(anatomy::layer_words(puncture.layer)) : std::string()});
  for (const std::size_t shot : session.shots)
    if (shot < session.samples.size()) lines.push_back({session.samples[shot].time_s, are_named ? "fired" : ""});
  std::sort(lines.begin(), lines.end(), [](const PlotLine& a, const PlotLine& b) { return a.x < b.x; });
  return lines;
}

/// Peaks by depth. Those of one layer that lie together, of several insertions, have one label, at the highest.
std::vector<PlotMarker> puncture_markers(const storage::Session& session) {
  constexpr double kTogether_mm = 4.0;
  std::vector<Puncture> punctures = find_punctures(session);
  std::erase_if(punctures, [](const Puncture& one) { return !Point2(one.depth_mm, one.resistance_n).allFinite(); });
  std::ranges::sort(punctures, {}, &Puncture::depth_mm);
  std::vector<PlotMarker> markers;
  for (const Puncture& puncture : punctures) {
    double low_n = puncture.resistance_n;
    bool is_highest = true;
    for (const Puncture& other : punctures) {
      if (other.layer != puncture.layer || std::abs(other.depth_mm - puncture.depth_mm) > kTogether_mm) continue;
      low_n = std::min(low_n, other.resistance_n);
      const bool is_higher = other.resistance_n > puncture.resistance_n ||
                             (other.resistance_n == puncture.resistance_n && other.time_s < puncture.time_s);
      is_highest = is_highest && !is_higher;
    }
    const std::string low = number_text(low_n, 2), high = number_text(puncture.resistance_n, 2);
    const std::string force = low == high ? high : low + "\u2013" + high;
    markers.push_back({{puncture.depth_mm, puncture.resistance_n},
                       is_highest ? fmt::format("{} {} N", words(anatomy::layer_words(puncture.layer)), force) : ""});
  }
  return markers;
}

template <class Value>
PlotSeries over_time(const storage::Session& session, const char* name, const char* style, const Value& value) {
  PlotSeries series{name, style, {}};
  series.points.reserve(session.samples.size());
  for (const telemetry::TickSample& sample : session.samples) series.points.emplace_back(sample.time_s, value(sample));
  return series;
}

Plot time_plot(const storage::Session& session, bool are_events_named) {
  Plot plot;
  plot.x_title = "time (s)";
  plot.bands = phase_bands(session);
  plot.lines = event_lines(session, are_events_named);
  return plot;
}

std::string phase_key() {
  std::string out = "<ul class=\"key\"><li>Phases:</li>";
  for (const char* phase : {"outside", "loading", "inserted", "retracting"})
    out += fmt::format(
        "<li><svg viewBox=\"0 0 30 13\"><rect class=\"p-{0}\" x=\"0.5\" y=\"0.5\" width=\"29\" height=\"12\" "
        "stroke=\"#9fb0bb\"/></svg>{0}</li>",
        phase);
  return out + "</ul>";
}

}  // namespace

std::string tissue_style(const std::string& tissue) {
  std::string style = "t-";
  for (const char c : tissue) {
    const bool is_plain = (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
    style += is_plain ? c : '-';
  }
  return style;
}

std::string force_depth_figure(const storage::Session& session) {
  std::vector<Insertion> insertions = find_insertions(session);
  if (insertions.empty()) return "<p>The needle did not enter the body: there is no insertion to plot.</p>";
  const auto deeper = [&](const Insertion& a, const Insertion& b) {
    return session.samples[a.deepest].depth_mm < session.samples[b.deepest].depth_mm;
  };
  const Insertion deepest = *std::max_element(insertions.begin(), insertions.end(), deeper);
  const double depth_mm = session.samples[deepest.deepest].depth_mm;

  Plot plot;
  plot.description = "Resistance of the needle against its depth, with the punctures marked";
  plot.x_title = "needle depth below the skin (mm)";
  plot.y_title = "resistance (N)";
  plot.height = 370.0;
  plot.x_range = AxisRange{0.0, depth_mm * 1.02};
  plot.bands = tissue_bands(session, deepest, depth_mm);
  constexpr const char* kStyles[kMostInsertions] = {"c-total", "c-second", "c-third"};
  constexpr const char* kNames[kMostInsertions] = {"first insertion", "second insertion", "third insertion"};
  for (std::size_t n = 0; n < std::min(insertions.size(), kMostInsertions); ++n) {
    PlotSeries series{kNames[n], kStyles[n], {}};
    for (std::size_t i = insertions[n].first; i <= insertions[n].deepest; ++i)
      series.points.emplace_back(session.samples[i].depth_mm, telemetry::axial_resistance_n(session.samples[i]));
    plot.series.push_back(std::move(series));
  }
  plot.markers = puncture_markers(session);
  return figure(to_svg(plot),
                "Forces on tip and shaft along the needle during insertion; positive pushes the needle out. Each "
                "marked peak is a puncture. Stripes: tissue at the tip.");
}

std::string puncture_table(const storage::Session& session) {
  const std::vector<Puncture> punctures = find_punctures(session);
  if (punctures.empty()) return "<p>No layer was punctured.</p>";
  std::string out =
      "<table class=\"list\"><thead><tr><th>Layer</th><th>Time (s)</th><th>Depth (mm)</th><th>Layer's force (N)</th>"
      "<th>Resistance (N)</th><th>Drop (N)</th></tr></thead><tbody>";
  for (const Puncture& puncture : punctures)
    out += fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>",
                       escape(words(anatomy::layer_words(puncture.layer))), number_text(puncture.time_s, 2),
                       number_text(puncture.depth_mm, 1), number_text(puncture.layer_force_n, 2),
                       number_text(puncture.resistance_n, 2), number_text(puncture.drop_n, 2));
  return out + "</tbody></table>";
}

std::string force_time_figure(const storage::Session& session) {
  Plot axial = time_plot(session, true);
  axial.description = "Resistance along the needle over time, by component";
  axial.y_title = "along the needle (N)";
  axial.height = 250.0;
  axial.series = {
      over_time(session, "pre-puncture", "c-pre", [](const telemetry::TickSample& s) { return -s.f_prepuncture_n; }),
      over_time(session, "friction", "c-friction", [](const telemetry::TickSample& s) { return -s.f_friction_n; }),
      over_time(session, "cutting", "c-cutting", [](const telemetry::TickSample& s) { return -s.f_cutting_n; }),
      over_time(session, "stick", "c-stick", [](const telemetry::TickSample& s) { return -s.f_stick_n; })};
  if (session.info.force_model != "insertion") {
    axial.series.push_back(over_time(session, "tip proxy", "c-tip",
                                     [](const telemetry::TickSample& s) { return -s.f_tip_proxy_n.dot(s.axis); }));
    axial.series.push_back(
        over_time(session, "body proxies", "c-body", [](const telemetry::TickSample& s) { return -s.f_body_axial_n; }));
  }

  Plot norms = time_plot(session, false);
  norms.description = "Magnitudes of the forces over time";
  norms.y_title = "magnitude (N)";
  norms.height = 220.0;
  norms.series = {
      over_time(session, "model total", "c-total", [](const telemetry::TickSample& s) { return s.f_total_n.norm(); }),
      over_time(session, "across the path", "c-constraint",
                [](const telemetry::TickSample& s) { return s.f_constraint_n.norm(); }),
      over_time(session, "sent to the device", "c-device",
                [](const telemetry::TickSample& s) { return s.device_f_n.norm(); })};
  return "<figure>" + to_svg(axial) + "</figure>" +
         figure(to_svg(norms) + phase_key(),
                "Above: positive pushes the needle out. Dotted lines: punctures and the shot of the biopsy gun. Stick: "
                "static friction while the needle is at rest (not part of paper A's model).");
}

std::string motion_figure(const storage::Session& session) {
  Plot depth = time_plot(session, false);
  depth.description = "Needle depth over time";
  depth.y_title = "depth (mm)";
  depth.width = 460.0;
  depth.height = 190.0;
  depth.series = {over_time(session, "depth", "c-depth", [](const telemetry::TickSample& s) { return s.depth_mm; })};
  Plot velocity = depth;
  velocity.description = "Axial needle velocity over time";
  velocity.y_title = "velocity inward (mm/s)";
  velocity.series = {over_time(session, "velocity", "c-velocity",
                               [](const telemetry::TickSample& s) { return s.axial_velocity_mm_s; })};
  return "<div class=\"pair\"><figure>" + to_svg(depth) + "</figure><figure>" + to_svg(velocity) + "</figure></div>";
}

}  // namespace trocar::report::detail
