#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "geometry/vec.h"

namespace trocar::testing {

inline std::string little_endian(std::uint32_t number, int bytes) {
  std::string text;
  for (int n = 0; n < bytes; ++n) text += static_cast<char>(number >> 8 * n & 0xff);
  return text;
}

/// An element in explicit little endian (DICOM PS3.5, section 7.1.2).
inline std::string dicom_element(std::uint16_t group, std::uint16_t number, const std::string& vr, std::string value) {
  if (value.size() % 2 != 0) value += vr == "UI" || vr == "OB" ? '\0' : ' ';
  const auto length = static_cast<std::uint32_t>(value.size());
  const std::string head = little_endian(group, 2) + little_endian(number, 2) + vr;
  const bool is_long = vr == "OW" || vr == "OB" || vr == "SQ" || vr == "UN" || vr == "UT";
  return head + (is_long ? std::string(2, '\0') + little_endian(length, 4) : little_endian(length, 2)) + value;
}

inline std::string dicom_short(std::uint16_t group, std::uint16_t number, int value) {
  return dicom_element(group, number, "US", little_endian(static_cast<std::uint32_t>(value), 2));
}

/// Decimal strings "1\2.5", as writers round them.
inline std::string dicom_decimals(std::uint16_t group, std::uint16_t number, const std::vector<double>& values) {
  return dicom_element(group, number, "DS", fmt::format("{:.9g}", fmt::join(values, "\\")));
}
inline std::string dicom_point(std::uint16_t group, std::uint16_t number, const Vec3& point) {
  return dicom_decimals(group, number, {point.x(), point.y(), point.z()});
}

enum class Length { kDefined, kUndefined };

/// A sequence; each item is the text of its elements.
inline std::string dicom_sequence(std::uint16_t group, std::uint16_t number, const std::vector<std::string>& items,
                                  Length length = Length::kDefined) {
  std::string value;
  for (const std::string& item : items) {
    const std::string start = little_endian(0xfffe, 2) + little_endian(0xe000, 2);
    if (length == Length::kDefined)
      value += start + little_endian(static_cast<std::uint32_t>(item.size()), 4) + item;
    else
      value += start + little_endian(0xffffffff, 4) + item + little_endian(0xfffe, 2) + little_endian(0xe00d, 2) +
               little_endian(0, 4);
  }
  if (length == Length::kDefined) return dicom_element(group, number, "SQ", value);
  return little_endian(group, 2) + little_endian(number, 2) + "SQ" + std::string(2, '\0') +
         little_endian(0xffffffff, 4) + value + little_endian(0xfffe, 2) + little_endian(0xe0dd, 2) +
         little_endian(0, 4);
}

/// A whole file: preamble, transfer syntax and the elements.
inline std::string dicom_file(const std::string& elements, const std::string& transfer_syntax = "1.2.840.10008.1.2.1") {
  return std::string(128, '\0').append("DICM") + dicom_element(0x0002, 0x0010, "UI", transfer_syntax) + elements;
}

inline void write_dicom(const std::filesystem::path& path, const std::string& elements) {
  std::filesystem::create_directories(path.parent_path());
  const std::string bytes = dicom_file(elements);
  std::ofstream(path, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
}

/// A series of CT slices. The pixel of column i, row j at p_P has the value of `hu` there.
struct CtSeries {
  std::string series_uid = "1.2.3";
  std::string frame_of_reference = "1.2.9";
  std::string modality = "CT";
  std::string image_type = "ORIGINAL\\PRIMARY\\AXIAL";
  int columns = 8;
  int rows = 6;
  double spacing_mm = 1.0;
  Mat3 R_PV = Mat3::Identity();
  std::string patient_id;
  std::string spacing_text;     ///< Instead of spacing_mm.
  std::string intercept = "0";  ///< RescaleIntercept, which `hu` does not contain; empty: none.
  std::string more;             ///< Elements of the groups 0028 from 0104 on, in front of RescaleIntercept.
  std::string acquisition;      ///< AcquisitionNumber.
  std::string sop_class = "1.2.840.10008.5.1.4.1.1.2";
};

template <class Hu>
void write_slice(const std::filesystem::path& path, const CtSeries& series, const Vec3& origin_P,
                 const std::string& instance_uid, const Hu& hu) {
  std::string pixels;
  for (int j = 0; j < series.rows; ++j)
    for (int i = 0; i < series.columns; ++i) {
      const Vec3 p_P = origin_P + series.spacing_mm * (series.R_PV.col(0) * i + series.R_PV.col(1) * j);
      pixels += little_endian(static_cast<std::uint32_t>(static_cast<int>(std::lround(hu(p_P)))), 2);
    }
  const Mat3& R = series.R_PV;
  write_dicom(
      path,
      dicom_element(0x0008, 0x0008, "CS", series.image_type) + dicom_element(0x0008, 0x0016, "UI", series.sop_class) +
          dicom_element(0x0008, 0x0018, "UI", instance_uid) + dicom_element(0x0008, 0x0060, "CS", series.modality) +
          dicom_element(0x0008, 0x103e, "LO", "series " + series.series_uid) +
          dicom_element(0x0010, 0x0020, "LO", series.patient_id) +
          dicom_element(0x0020, 0x000e, "UI", series.series_uid) +
          dicom_element(0x0020, 0x0012, "IS", series.acquisition) + dicom_point(0x0020, 0x0032, origin_P) +
          dicom_decimals(0x0020, 0x0037, {R(0, 0), R(1, 0), R(2, 0), R(0, 1), R(1, 1), R(2, 1)}) +
          dicom_element(0x0020, 0x0052, "UI", series.frame_of_reference) + dicom_short(0x0028, 0x0002, 1) +
          dicom_element(0x0028, 0x0004, "CS", "MONOCHROME2") + dicom_short(0x0028, 0x0010, series.rows) +
          dicom_short(0x0028, 0x0011, series.columns) +
          (series.spacing_text.empty() ? dicom_decimals(0x0028, 0x0030, {series.spacing_mm, series.spacing_mm})
                                       : dicom_element(0x0028, 0x0030, "DS", series.spacing_text)) +
          dicom_short(0x0028, 0x0100, 16) + dicom_short(0x0028, 0x0101, 16) + dicom_short(0x0028, 0x0102, 15) +
          dicom_short(0x0028, 0x0103, 1) + series.more + dicom_element(0x0028, 0x1052, "DS", series.intercept) +
          dicom_element(0x7fe0, 0x0010, "OW", pixels));
}

/// Slices at these origins, as files "slice0", "slice1" … of the folder.
template <class Hu>
void write_slices(const std::filesystem::path& folder, const CtSeries& series, const std::vector<Vec3>& origins_P,
                  const Hu& hu) {
  for (std::size_t n = 0; n < origins_P.size(); ++n)
    write_slice(folder / fmt::format("slice{}", n), series, origins_P[n],
                fmt::format("{}.{}", series.series_uid, n + 1), hu);
}

}  // namespace trocar::testing
