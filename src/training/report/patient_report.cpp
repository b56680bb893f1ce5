#include "report/patient_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/result.h"
#include "png/png_file.h"
#include "report/detail/html.h"
#include "slices/slice_picture.h"

namespace trocar::report {
namespace {
using namespace detail;

constexpr double kFindingField_mm = 120.0;
constexpr int kFindingPx = 360;
constexpr int kGapPx = 6;
constexpr double kRingPx = 13.0;
constexpr image::Rgb kRing{255, 80, 40};

/// A ring with a dark border, around the place so that it stays visible.
void draw_ring(const Eigen::Vector2d& middle, image::RgbImage& image) {
  for (int row = 0; row < image.rows; ++row)
    for (int column = 0; column < image.columns; ++column) {
      const double off = std::abs((Eigen::Vector2d(column, row) - middle).norm() - kRingPx);
      if (off < 1.2)
        image.at(column, row) = kRing;
      else if (off < 2.4)
        image.at(column, row) = {0, 0, 0};
    }
}

void paste(const image::RgbImage& from, int column, image::RgbImage& to) {
  for (int y = 0; y < std::min(from.rows, to.rows); ++y)
    for (int x = 0; x < std::min(from.columns, to.columns - column); ++x) to.at(column + x, y) = from.at(x, y);
}

std::string finding_list(const anatomy::VirtualPatient& patient, const std::vector<anatomy::Finding>& findings) {
  std::string html;
  for (const anatomy::Finding& finding : findings) {
    html += fmt::format("<figure><figcaption>{}", escape(finding.text));
    if (const auto& p = finding.place_P)
      html += fmt::format(
          " <span class=\"note\">at {}, {}, {} mm (LPS)</span></figcaption><img alt=\"three slices\" "
          "style=\"max-width:100%\" src=\"data:image/png;base64,{}\">",
          number_text(p->x(), 0), number_text(p->y(), 0), number_text(p->z(), 0),
          base64(png::encode_png(finding_picture(patient, finding))));
    else
      html += "</figcaption>";
    html += "</figure>";
  }
  return html;
}

}  // namespace

image::RgbImage finding_picture(const anatomy::VirtualPatient& patient, const anatomy::Finding& finding) {
  TROCAR_CHECK(finding.place_P.has_value());
  slices::SliceOptions options;
  options.size_px = kFindingPx;
  options.field_mm = kFindingField_mm;
  options.center_P = *finding.place_P;
  image::RgbImage row(3 * kFindingPx + 2 * kGapPx, kFindingPx);
  int column = 0;
  for (const auto orientation :
       {slices::SliceOrientation::kAxial, slices::SliceOrientation::kCoronal, slices::SliceOrientation::kSagittal}) {
    slices::SlicePicture picture = slices::make_slice_picture(patient, orientation, *finding.place_P, options);
    slices::draw_slice_legend(picture);
    draw_ring(picture.to_pixel(*finding.place_P), picture.image);
    paste(picture.image, column, row);
    column += kFindingPx + kGapPx;
  }
  return row;
}

std::string patient_report(const anatomy::VirtualPatient& patient, const PatientCheck& check) {
  std::string tasks;
  for (const std::string& line : check.tasks) tasks += fmt::format("<li>{}</li>", escape(line));
  std::string derived;
  for (const anatomy::Label& label : patient.label_table.labels)
    if (label.is_derived) derived += fmt::format("{}{}", derived.empty() ? "" : ", ", escape(words(label.name)));
  return fmt::format(
      "<!DOCTYPE html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>Check of {0}</title>"
      "<style>{1}</style></head><body><main><h1>Check of {0}</h1><h2>Tasks</h2><ul>{2}</ul>"
      "<h2>Doubtful</h2>{3}<h2>Repaired</h2>{4}<h2>Derived structures</h2><p>{5}</p></main></body></html>",
      escape(patient.name), style_sheet(), tasks,
      check.findings.empty() ? "<p>nothing</p>" : finding_list(patient, check.findings),
      patient.repairs.empty() ? "<p>nothing</p>" : finding_list(patient, patient.repairs),
      derived.empty() ? "none" : derived);
}

}  // namespace trocar::report
