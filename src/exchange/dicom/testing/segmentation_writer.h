#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "dicom/testing/dicom_writer.h"

namespace trocar::testing {

/// A code: value, scheme, meaning.
inline std::string dicom_code(std::uint16_t group, std::uint16_t number, const std::string& value,
                              const std::string& scheme, const std::string& meaning) {
  return dicom_sequence(group, number,
                        {dicom_element(0x0008, 0x0100, "SH", value) + dicom_element(0x0008, 0x0102, "SH", scheme) +
                         dicom_element(0x0008, 0x0104, "LO", meaning)});
}

/// One frame of a SEG: its segment, its place, and the value of pixel (i, j).
struct TestFrame {
  int segment = 1;
  Vec3 origin_P = Vec3::Zero();
  std::function<int(int, int)> value;
  std::vector<double> spacing_mm{};  ///< PixelSpacing of its own, if not empty,
  double slice_step_mm = 0.0;        ///< with its own SpacingBetweenSlices.
  std::vector<double> directions{};  ///< ImageOrientationPatient of its own, if not empty.
};

/// A SEG; what is empty is left out of the file.
struct TestSeg {
  std::string type = "BINARY";
  std::string sop_class = "1.2.840.10008.5.1.4.1.1.66.4";
  int columns = 8;
  int rows = 6;
  int bits = 1;
  int maximum_fractional = 0;
  int padding = -1;  ///< PixelPaddingValue.
  double spacing_mm = 1.0;
  double slice_step_mm = 0.0;
  double thickness_mm = 0.0;
  Mat3 R_PV = Mat3::Identity();
  std::string series_uid = "1.2.3";
  std::string frame_of_reference = "1.2.9";
  std::vector<std::string> segments;  ///< The elements of each segment: segment_item().
  std::vector<TestFrame> frames;
  Length length = Length::kDefined;
};

inline std::string segment_item(int number, const std::string& label, const std::string& codes = {}) {
  return dicom_short(0x0062, 0x0004, number) + dicom_element(0x0062, 0x0005, "LO", label) + codes;
}

inline std::string seg_pixels(const TestSeg& seg) {
  std::string bytes;
  std::size_t bit = 0;
  for (const TestFrame& frame : seg.frames)
    for (int j = 0; j < seg.rows; ++j)
      for (int i = 0; i < seg.columns; ++i) {
        const int value = frame.value(i, j);
        if (seg.bits > 1) {
          bytes += little_endian(static_cast<std::uint32_t>(value), seg.bits / 8);
          continue;
        }
        if (bit % 8 == 0) bytes += '\0';
        if (value != 0) bytes.back() = static_cast<char>(bytes.back() | 1 << bit % 8);
        ++bit;
      }
  return bytes;
}

inline std::string seg_elements(const TestSeg& seg, bool with_pixels = true) {
  const Mat3& R = seg.R_PV;
  std::string measures;
  if (seg.thickness_mm > 0.0) measures += dicom_decimals(0x0018, 0x0050, {seg.thickness_mm});
  if (seg.slice_step_mm > 0.0) measures += dicom_decimals(0x0018, 0x0088, {seg.slice_step_mm});
  measures += dicom_decimals(0x0028, 0x0030, {seg.spacing_mm, seg.spacing_mm});
  const std::string orientation =
      dicom_decimals(0x0020, 0x0037, {R(0, 0), R(1, 0), R(2, 0), R(0, 1), R(1, 1), R(2, 1)});
  std::vector<std::string> frames;
  for (const TestFrame& frame : seg.frames) {
    std::string groups = dicom_sequence(0x0020, 0x9113, {dicom_point(0x0020, 0x0032, frame.origin_P)}, seg.length);
    if (seg.type != "LABELMAP")
      groups += dicom_sequence(0x0062, 0x000a, {dicom_short(0x0062, 0x000b, frame.segment)}, seg.length);
    if (!frame.spacing_mm.empty())
      groups += dicom_sequence(
          0x0028, 0x9110,
          {(frame.slice_step_mm > 0.0 ? dicom_decimals(0x0018, 0x0088, {frame.slice_step_mm}) : std::string()) +
           dicom_decimals(0x0028, 0x0030, frame.spacing_mm)},
          seg.length);
    if (!frame.directions.empty())
      groups += dicom_sequence(0x0020, 0x9116, {dicom_decimals(0x0020, 0x0037, frame.directions)}, seg.length);
    frames.push_back(std::move(groups));
  }
  std::string elements =
      dicom_element(0x0008, 0x0016, "UI", seg.sop_class) + dicom_element(0x0008, 0x0060, "CS", "SEG");
  if (!seg.series_uid.empty())
    elements += dicom_sequence(0x0008, 0x1115, {dicom_element(0x0020, 0x000e, "UI", seg.series_uid)}, seg.length);
  elements += dicom_element(0x0020, 0x000e, "UI", "1.2.77");
  if (!seg.frame_of_reference.empty()) elements += dicom_element(0x0020, 0x0052, "UI", seg.frame_of_reference);
  elements += dicom_element(0x0028, 0x0008, "IS", std::to_string(seg.frames.size())) +
              dicom_short(0x0028, 0x0010, seg.rows) + dicom_short(0x0028, 0x0011, seg.columns) +
              dicom_short(0x0028, 0x0100, seg.bits) +
              (seg.padding >= 0 ? dicom_short(0x0028, 0x0120, seg.padding) : std::string()) +
              dicom_element(0x0062, 0x0001, "CS", seg.type) + dicom_sequence(0x0062, 0x0002, seg.segments, seg.length);
  if (seg.maximum_fractional > 0) elements += dicom_short(0x0062, 0x000e, seg.maximum_fractional);
  elements += dicom_sequence(0x5200, 0x9229,
                             {dicom_sequence(0x0020, 0x9116, {orientation}, seg.length) +
                              dicom_sequence(0x0028, 0x9110, {measures}, seg.length)},
                             seg.length) +
              dicom_sequence(0x5200, 0x9230, frames, seg.length);
  return with_pixels ? elements + dicom_element(0x7fe0, 0x0010, "OB", seg_pixels(seg)) : elements;
}

/// One structure of an RT structure set: its contours with their type.
struct TestStructure {
  std::string name;
  std::vector<std::pair<std::string, std::vector<Vec3>>> contours;
  std::optional<std::string> number{};           ///< ROINumber, if not its place in the list, from 1.
  std::optional<std::string> contours_number{};  ///< ReferencedROINumber, if not the same.
  std::string frame_of_reference{};              ///< Left out if empty.
};

inline std::string structure_set_elements(const std::vector<TestStructure>& structures,
                                          const std::string& series_uid = "1.2.3",
                                          const std::string& frame_of_reference = "1.2.9",
                                          Length length = Length::kDefined) {
  std::vector<std::string> names;
  std::vector<std::string> lists;
  for (std::size_t n = 0; n < structures.size(); ++n) {
    const std::string number = structures[n].number.value_or(std::to_string(n + 1));
    const std::string& frame = structures[n].frame_of_reference;
    names.push_back(dicom_element(0x3006, 0x0022, "IS", number) +
                    (frame.empty() ? std::string() : dicom_element(0x3006, 0x0024, "UI", frame)) +
                    dicom_element(0x3006, 0x0026, "LO", structures[n].name));
    std::vector<std::string> contours;
    for (const auto& [type, points] : structures[n].contours) {
      std::vector<double> numbers;
      for (const Vec3& point : points) numbers.insert(numbers.end(), {point.x(), point.y(), point.z()});
      contours.push_back(dicom_element(0x3006, 0x0042, "CS", type) + dicom_decimals(0x3006, 0x0050, numbers));
    }
    lists.push_back(dicom_sequence(0x3006, 0x0040, contours, length) +
                    dicom_element(0x3006, 0x0084, "IS", structures[n].contours_number.value_or(number)));
  }
  const std::string series =
      series_uid.empty() ? std::string()
                         : dicom_sequence(0x3006, 0x0014, {dicom_element(0x0020, 0x000e, "UI", series_uid)}, length);
  return dicom_element(0x0008, 0x0005, "CS", "ISO_IR 100") +
         dicom_element(0x0008, 0x0016, "UI", "1.2.840.10008.5.1.4.1.1.481.3") +
         dicom_element(0x0008, 0x0060, "CS", "RTSTRUCT") +
         dicom_sequence(0x3006, 0x0010,
                        {dicom_element(0x0020, 0x0052, "UI", frame_of_reference) +
                         dicom_sequence(0x3006, 0x0012, {series}, length)},
                        length) +
         dicom_sequence(0x3006, 0x0020, names, length) + dicom_sequence(0x3006, 0x0039, lists, length);
}

}  // namespace trocar::testing
