#include "report/html_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string>

#include "anatomy/patient.h"
#include "png/png_file.h"
#include "report/detail/force_plots.h"
#include "report/detail/html.h"
#include "report/detail/sections.h"
#include "report/detail/verdict.h"
#include "report/plot_scale.h"
#include "report/session_analysis.h"
#include "slices/slice_picture.h"
#include "storage/session_file.h"

namespace trocar::report::detail {

/// Planned and performed path over three CT slices through the target; a text if there is no patient to show.
std::string path_figure(const storage::Session& session, const anatomy::VirtualPatient* patient);

}  // namespace trocar::report::detail

namespace trocar::report {
using namespace detail;

std::filesystem::path report_file_of(const std::filesystem::path& session) {
  return std::filesystem::path(session).replace_extension(".report.html");
}

std::string html_report(const storage::Session& session, const anatomy::VirtualPatient* patient,
                        const ReportStory& story, const language::Language& language) {
  std::string page =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>";
  page += escape(title_of(session, story)) + ": session report</title><style>";
  page += style_sheet();
  page += "</style></head><body><main>";
  page += page_header(session, story);
  page += verdict_section(session);
  page += advice_section(session);
  page += score_section(session);
  page += steps_section(session, story);
  page += actions_section(story);
  page += core_section(session);
  page += bleeding_section(session);
  page +=
      "<section><h2>Force against depth</h2>" + force_depth_figure(session) + puncture_table(session) + "</section>";
  if (!session.samples.empty()) {
    page += "<section><h2>Forces over time</h2>" + force_time_figure(session) + motion_figure(session) + "</section>";
    page += "<section class=\"together\"><h2>The path</h2>" + path_figure(session, patient) + "</section>";
  }
  page += case_section(session);
  page += "<footer>Made by Trocar " + escape(session.info.program_version) +
          ", a training simulator and not a medical device. Lengths in mm, forces in N.</footer>";
  return language::translate_page(language, page + "</main></body></html>\n");
}

using namespace detail;
namespace {

std::string verdict_text(const storage::Session& session) {
  if (!session.outcome) return "No verdict: the session is incomplete, the program ended during the attempt\n";
  const scoring::Outcome& outcome = *session.outcome;
  const std::vector<std::string> reasons = reasons_of(outcome);
  std::string text =
      fmt::format("{}{}{}\n", verdict_of(outcome).word, reasons.empty() ? "" : ": ", fmt::join(reasons, "; "));
  if (outcome.is_scored())
    text += fmt::format("{:.0f} of 100 points, target {}\n", outcome.score, scoring::target_words(outcome));
  for (std::size_t n = 0; n < outcome.hints.size(); ++n) {
    const scoring::Hint& hint = outcome.hints[n];
    text += fmt::format("{}{}{}\n",
                        is_praise(hint) ? ""
                        : n == 0        ? "improve first: "
                                        : "then: ",
                        hint.text, hint.at_s ? fmt::format(" (at {:.1f} s)", *hint.at_s) : "");
  }
  for (const scoring::ScorePart& part : outcome.parts)
    text += fmt::format("  {:<44} {:>12} {:>6.1f} of {:.1f} points\n", part.title, scoring::part_value_text(part),
                        part.points, part.max_points);
  return text;
}

std::string step_text(const StepTime& step) {
  if (!step.begun_s) return "not counted, a step before it was not done";
  if (!step.done_s) return fmt::format("begun at {:.1f} s, not done", *step.begun_s);
  return fmt::format("begun at {:.1f} s, done at {:.1f} s, took {:.1f} s", *step.begun_s, *step.done_s,
                     *step.done_s - *step.begun_s);
}

}  // namespace

std::string text_report(const storage::Session& session, const ReportStory& story) {
  const storage::SessionInfo& info = session.info;
  std::string text =
      fmt::format("{} on {} by {}, {}{}\n", story.title.empty() ? info.task : story.title, info.patient_name,
                  info.operator_name, info.started_utc, info.level.empty() ? "" : ", level " + info.level);
  text += verdict_text(session);
  if (!story.steps.empty()) text += "steps:\n";
  for (std::size_t n = 0; n < story.steps.size(); ++n)
    text += fmt::format("  {}. {}: {}\n", n + 1, story.steps[n].title, step_text(story.steps[n]));
  if (!story.actions.empty()) text += "actions:\n";
  for (const ActionLine& action : story.actions)
    text += fmt::format("  {:.1f} s, {:.1f} mm deep: {}\n", action.time_s, action.depth_mm, action.text);
  const Interruptions gaps = interruptions_of(session);
  if (const std::string many = gaps.many_text(); !many.empty()) text += "interruptions: " + many + "\n";
  for (const tasks::Interruption& gap : gaps.listed)
    text += fmt::format("interruption at {:.2f} s: {:.2f} s, {}\n", gap.from_s, gap.to_s - gap.from_s, gap.reason);
  if (gaps.short_ones > 0) text += fmt::format("{}\n", gaps.short_text());
  return text;
}

}  // namespace trocar::report

namespace trocar::report::detail {
namespace {

constexpr int kPathPicturePx = 440;
constexpr double kLeastField_mm = 220.0;  ///< Minimum side of the square displayed by a slice,
constexpr double kAroundPath_mm = 60.0;   ///< and minimum margin around the path.
constexpr double kScaleBar_mm = 50.0;
constexpr double kShaftOutside_mm = 30.0;  ///< Length of the needle's shaft drawn outside the skin.

/// Drawing over each slice, in P.
struct PathDrawing {
  std::optional<Segment> planned_P;
  std::vector<std::vector<Vec3>> own_P;  ///< Path of the tip during insertion, one line per insertion.
  std::vector<Vec3> own_entries_P;
  std::optional<Segment> shaft_P;  ///< The needle at firing, or at its deepest position: from outside to the tip.
  Vec3 through_P = Vec3::Zero();
  Vec3 center_P = Vec3::Zero();  ///< Centre of the path.
  double field_mm = kLeastField_mm;
};

PathDrawing collect(const storage::Session& session) {
  PathDrawing drawing;
  const Segment& plan = session.info.plan_P.line_P;
  if (plan.length_mm() > 0.0) drawing.planned_P = plan;
  std::optional<std::size_t> deepest;
  for (const Insertion& insertion : find_insertions(session)) {
    std::vector<Vec3> line;
    for (std::size_t i = insertion.first; i <= insertion.deepest; ++i) line.push_back(session.samples[i].rest_tip_mm);
    drawing.own_entries_P.push_back(line.front());
    drawing.own_P.push_back(std::move(line));
    if (!deepest || session.samples[insertion.deepest].depth_mm > session.samples[*deepest].depth_mm)
      deepest = insertion.deepest;
  }
  if (!session.shots.empty() && session.shots.front() < session.samples.size()) deepest = session.shots.front();
  if (deepest) {
    const telemetry::TickSample& sample = session.samples[*deepest];
    drawing.shaft_P =
        Segment{sample.rest_tip_mm - (sample.depth_mm + kShaftOutside_mm) * sample.rest_axis, sample.rest_tip_mm};
  }
  if (drawing.planned_P)
    drawing.through_P = plan.b;
  else if (drawing.shaft_P)
    drawing.through_P = drawing.shaft_P->b;
  const Segment shown = drawing.planned_P ? *drawing.planned_P : drawing.shaft_P.value_or(Segment{plan.b, plan.b});
  drawing.center_P = shown.at(0.5);
  drawing.field_mm = std::max(kLeastField_mm, shown.length_mm() + 2.0 * kAroundPath_mm);
  return drawing;
}

/// Draws points of P over one picture. Pixel centres are at half SVG units.
class Overlay {
 public:
  explicit Overlay(const slices::SlicePicture& picture) : picture_(picture) {}

  Point2 at(const Vec3& p_P) const { return picture_.to_pixel(p_P) + Point2(0.5, 0.5); }

  void line(const std::vector<Vec3>& points_P, const char* style, double width) {
    std::vector<Point2> points;
    for (const Vec3& p_P : points_P) {
      const Point2 point = at(p_P);
      if (point.allFinite() && (points.empty() || (point - points.back()).norm() > 0.7)) points.push_back(point);
    }
    if (points.empty()) return;
    std::string path;
    for (const Point2& point : points)
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', point.x(), point.y());
    svg_ += fmt::format("<path class=\"{}\" stroke-width=\"{}\" d=\"{}\"/>", style, width, path);
  }
  void disc(const Vec3& p_P, const char* style, double radius) {
    const Point2 point = at(p_P);
    if (!point.allFinite()) return;
    svg_ += fmt::format("<circle class=\"{}\" stroke-width=\"1.5\" cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\"/>", style,
                        point.x(), point.y(), radius);
  }
  void cross_hair(const Vec3& p_P, const char* style, double width) {
    const Point2 point = at(p_P);
    if (!point.allFinite()) return;
    svg_ += fmt::format(
        "<path class=\"{}\" stroke-width=\"{}\" d=\"M{:.1f} {:.1f}m-11 0h6m10 0h6m-11 -11v6m0 10v6m5 -11a5 5 0 1 1 -10 "
        "0 5 5 0 "
        "1 1 10 0\"/>",
        style, width, point.x(), point.y());
  }
  void text(double x, double y, const char* text) {
    svg_ += fmt::format("<text class=\"letter\" font-size=\"19\" x=\"{:.1f}\" y=\"{:.1f}\">{}</text>", x, y, text);
  }
  void scale_bar() {
    const double length = kScaleBar_mm / picture_.plane.step_u_P.norm();
    const double y = picture_.image.rows - 10.0;
    for (const auto& [style, width] : {std::pair{"scale-halo", 6}, std::pair{"scale", 3}})
      svg_ += fmt::format("<path class=\"{}\" stroke-width=\"{}\" d=\"M12 {:.1f}h{:.1f}\"/>", style, width, y, length);
    svg_ += fmt::format("<text class=\"letter\" font-size=\"16\" x=\"{:.1f}\" y=\"{:.1f}\">{:.0f} mm</text>",
                        12.0 + 0.5 * length, y - 8.0, kScaleBar_mm);
  }
  const std::string& svg() const { return svg_; }

 private:
  const slices::SlicePicture& picture_;
  std::string svg_;
};

struct SliceText {
  slices::SliceOrientation orientation;
  const char* title;
  const char* letters[4];  ///< Left, right, top, bottom of the picture.
};
constexpr SliceText kSlices[] = {{slices::SliceOrientation::kAxial, "Axial", {"R", "L", "A", "P"}},
                                 {slices::SliceOrientation::kCoronal, "Coronal", {"R", "L", "H", "F"}},
                                 {slices::SliceOrientation::kSagittal, "Sagittal", {"A", "P", "H", "F"}}};

std::string draw_overlay(const slices::SlicePicture& picture, const SliceText& text, const PathDrawing& drawing) {
  Overlay overlay(picture);
  for (const auto& [style, width] : {std::pair{"halo", 7.0}, std::pair{"own", 3.5}})
    for (const auto& line : drawing.own_P) overlay.line(line, style, width);
  if (drawing.shaft_P) overlay.line({drawing.shaft_P->a, drawing.shaft_P->b}, "shaft", 1.6);
  if (drawing.planned_P) {
    overlay.line({drawing.planned_P->a, drawing.planned_P->b}, "planned", 2.4);
    overlay.disc(drawing.planned_P->a, "entry", 5.5);
    overlay.cross_hair(drawing.planned_P->b, "target-halo", 5.0);
    overlay.cross_hair(drawing.planned_P->b, "target", 2.4);
  }
  for (const Vec3& entry_P : drawing.own_entries_P) overlay.disc(entry_P, "own-entry", 4.0);
  if (drawing.shaft_P) overlay.disc(drawing.shaft_P->b, "tip", 4.0);
  const double columns = picture.image.columns;
  const double rows = picture.image.rows;
  overlay.text(14.0, 0.5 * rows + 6.0, text.letters[0]);
  overlay.text(columns - 14.0, 0.5 * rows + 6.0, text.letters[1]);
  overlay.text(0.5 * columns, 21.0, text.letters[2]);
  overlay.text(0.5 * columns, rows - 9.0, text.letters[3]);
  overlay.scale_bar();
  return overlay.svg();
}

/// One slice as a figure; figures share the row's width in proportion to their size in mm, so that all have the same
/// scale.
std::string slice_figure(const anatomy::VirtualPatient& patient, const SliceText& text, const PathDrawing& drawing) {
  slices::SliceOptions options;
  options.size_px = kPathPicturePx;
  options.label_opacity = 0.12;
  options.field_mm = drawing.field_mm;
  options.center_P = drawing.center_P;
  const slices::SlicePicture picture =
      slices::make_slice_picture(patient, text.orientation, drawing.through_P, options);
  const double width_mm = picture.image.columns * picture.plane.step_u_P.norm();
  return fmt::format(
      "<figure style=\"flex:{0:.0f} 1 0\"><svg viewBox=\"0 0 {1} {2}\" role=\"img\" aria-label=\"{3} CT slice with the "
      "needle path\"><image width=\"{1}\" height=\"{2}\" href=\"data:image/png;base64,{4}\"/>{5}</svg>"
      "<figcaption>{3}</figcaption></figure>",
      width_mm, picture.image.columns, picture.image.rows, text.title, base64(png::encode_png(picture.image)),
      draw_overlay(picture, text, drawing));
}

std::string path_key() {
  const auto entry = [](const char* drawing, const char* name) {
    return fmt::format(
        "<li><svg viewBox=\"0 0 30 13\"><rect width=\"30\" height=\"13\" fill=\"#3b3b3b\"/>{}</svg>{}</li>", drawing,
        name);
  };
  return "<ul class=\"key\">" +
         entry("<path class=\"planned\" stroke-width=\"2.4\" d=\"M2 6.5h26\"/>", "planned path") +
         entry("<circle class=\"entry\" cx=\"15\" cy=\"6.5\" r=\"4\"/>", "planned entry") +
         entry(
             "<path class=\"target\" stroke-width=\"1.6\" d=\"M8 6.5h4m6 0h4m-7 -6v3m0 6v3m3 -6a3 3 0 1 1 -6 0 3 3 0 1 "
             "1 6 0\"/>",
             "target") +
         entry("<path class=\"own\" stroke-width=\"3.5\" d=\"M2 6.5h26\"/>", "path of the tip") +
         entry("<circle class=\"own-entry\" cx=\"15\" cy=\"6.5\" r=\"3.5\"/>", "actual entry and tip") + "</ul>";
}

}  // namespace

std::string path_figure(const storage::Session& session, const anatomy::VirtualPatient* patient) {
  if (patient == nullptr || patient->ct.empty())
    return fmt::format("<p>Patient folder “{}” not found: the path cannot be shown in its CT.</p>",
                       escape(session.info.patient_name));
  std::string out;
  if (patient->content_hash != session.info.patient_hash)
    out +=
        "<p class=\"warning\">The patient has changed since the session: the slices may differ from the anatomy of the "
        "attempt.</p>";
  const PathDrawing drawing = collect(session);
  out += "<div class=\"slices\">";
  for (const SliceText& text : kSlices) out += slice_figure(*patient, text, drawing);
  const slices::Window window = slices::SliceOptions{}.window;
  return out + "</div>" + path_key() +
         fmt::format(
             "<p class=\"note\">Slices through the {} at ({}, {}, {}) mm (LPS), paths projected onto them. "
             "Window {:.0f}/{:.0f} HU (width/centre).</p>",
             drawing.planned_P ? "planned target" : "deepest point", number_text(drawing.through_P.x(), 1),
             number_text(drawing.through_P.y(), 1), number_text(drawing.through_P.z(), 1), window.width_hu,
             window.center_hu);
}

}  // namespace trocar::report::detail
