#include "dicom/xa/xa_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/files/output_file.h"
#include "core/version.h"
#include "dicom/elements/element_walk.h"
#include "dicom/pacs/detail/anonymisation.h"
#include "dicom/pacs/detail/element_writer.h"

namespace trocar::dicom {
namespace {

constexpr std::string_view kXaClass = "1.2.840.10008.5.1.4.1.1.12.1";
constexpr std::string_view kExplicitLittleEndian = "1.2.840.10008.1.2.1";
constexpr double kMgy_per_dgy = 100.0;
constexpr double kMs_per_s = 1000.0;
constexpr double kTimeRounding_ms = 0.05;  ///< Frames whose distances differ by less are evenly spaced.

using detail::DataElements;

Status check(const XaImage& image, const std::string& where) {
  const auto size =
      static_cast<std::size_t>(std::max(image.columns, 0)) * static_cast<std::size_t>(std::max(image.rows, 0));
  constexpr int kMostPixels = 65535;  // of 16 bits
  if (image.frames.empty() || size == 0 || image.columns > kMostPixels || image.rows > kMostPixels)
    return fail("the X-ray image has no frame or an impossible size", where,
                "give at least one frame of 1 to 65535 pixels");
  for (const auto& frame : image.frames)
    if (frame.size() != size)
      return fail(fmt::format("a frame has {} pixels instead of {}", frame.size(), size), where,
                  "give frames of the same size");
  const bool has_times = image.time_s.size() == image.frames.size();
  if (image.frames.size() > 1 && !has_times)
    return fail(fmt::format("{} times for {} frames", image.time_s.size(), image.frames.size()), where,
                "give the time of each frame");
  for (std::size_t n = 0; n + 1 < image.time_s.size(); ++n)
    if (!(image.time_s[n + 1] > image.time_s[n]))
      return fail("the times of the frames do not rise", where, "sort the frames by time");
  if (static_cast<double>(image.frames.size()) * static_cast<double>(size) > 4e9)
    return fail("the frames have more than 4 GB", where, "write fewer frames");
  const XaIdentity& identity = image.identity;
  for (const std::string& uid : {identity.study_uid, identity.series_uid, identity.instance_uid})
    if (!uid.empty() && !detail::is_uid(uid))
      return fail(fmt::format("\"{}\" is not a UID", uid), where, "give digits and dots, at most 64");
  return {};
}

void add_identity(const XaIdentity& identity, const std::string& instance_uid, DataElements& to) {
  const detail::Pseudonyms random = detail::Pseudonyms::with_random_salt();
  const auto uid = [&](const std::string& given, std::string_view what) {
    return given.empty() ? random.uid(what) : given;
  };
  to.text(tag(0x0008, 0x0005), "CS", "ISO_IR 192");
  to.text(tag(0x0008, 0x0016), "UI", kXaClass);
  to.text(tag(0x0008, 0x0018), "UI", instance_uid);
  for (const std::uint32_t date : {tag(0x0008, 0x0020), tag(0x0010, 0x0030)}) to.text(date, "DA", "");
  to.text(tag(0x0008, 0x0030), "TM", "");
  to.text(tag(0x0008, 0x0050), "SH", "");
  to.text(tag(0x0008, 0x0060), "CS", "XA");
  to.text(tag(0x0008, 0x0070), "LO", "Trocar");
  to.text(tag(0x0008, 0x0090), "PN", "");
  to.text(tag(0x0008, 0x1030), "LO", identity.study_description);
  to.text(tag(0x0008, 0x103e), "LO", identity.series_description);
  to.text(tag(0x0008, 0x1090), "LO", "Trocar simulator");
  to.text(tag(0x0010, 0x0010), "PN", identity.patient_name);
  to.text(tag(0x0010, 0x0020), "LO", identity.patient_id);
  to.text(tag(0x0010, 0x0040), "CS", "");
  to.text(tag(0x0012, 0x0062), "CS", "YES");
  to.text(tag(0x0012, 0x0063), "LO", "simulated image");
  to.text(tag(0x0018, 0x1020), "LO", kVersion);
  to.text(tag(0x0020, 0x000d), "UI", uid(identity.study_uid, "study"));
  to.text(tag(0x0020, 0x000e), "UI", uid(identity.series_uid, "series"));
  to.text(tag(0x0020, 0x0010), "SH", "1");
  to.integer(tag(0x0020, 0x0011), identity.series_number);
  to.integer(tag(0x0020, 0x0013), identity.instance_number);
  to.text(tag(0x0020, 0x0020), "CS", "");
  to.text(tag(0x0020, 0x0060), "CS", "");  // laterality: none
}

void add_exposure(const XaExposure& exposure, DataElements& to) {
  to.decimal(tag(0x0018, 0x0060), exposure.kv);
  to.integer(tag(0x0018, 0x1150), std::lround(std::max(1.0, exposure.pulse_ms)));
  to.integer(tag(0x0018, 0x1151), std::lround(std::max(1.0, exposure.tube_current_ma)));
  to.integer(tag(0x0018, 0x1152), std::lround(exposure.total_mas));
  to.integer(tag(0x0018, 0x1153), std::lround(kMs_per_s * exposure.total_mas));  // µAs
  to.decimal(tag(0x0018, 0x1154), exposure.pulse_ms);
  to.text(tag(0x0018, 0x1155), "CS", exposure.is_low_dose ? "SC" : "GR");
  to.text(tag(0x0018, 0x115a), "CS", "PULSED");
  to.decimal(tag(0x0018, 0x115e), exposure.area_product_mgy_cm2 / kMgy_per_dgy);  // dGy cm²
  to.text(tag(0x0018, 0x1166), "CS", "IN");                                       // grid
}

void add_geometry(const XaImage& image, DataElements& to) {
  const XaGeometry& geometry = image.geometry;
  to.decimal(tag(0x0018, 0x1110), geometry.source_detector_mm);
  to.decimal(tag(0x0018, 0x1111), geometry.source_patient_mm);
  to.decimal(tag(0x0018, 0x1114), geometry.source_detector_mm / geometry.source_patient_mm);
  to.text(tag(0x0018, 0x1164), "DS", fmt::format("{0:.9g}\\{0:.9g}", geometry.pixel_mm));
  to.decimal(tag(0x0018, 0x1510), geometry.primary_angle_deg);
  to.decimal(tag(0x0018, 0x1511), geometry.secondary_angle_deg);
  to.text(tag(0x0018, 0x1700), "CS", "RECTANGULAR");
  // The first and last lit column and row lie beside the shutters' edges (C.8.7.3), counted from 1.
  const auto [left, right, top, bottom] = image.shutters;
  to.integer(tag(0x0018, 0x1702), left);
  to.integer(tag(0x0018, 0x1704), image.columns + 1 - right);
  to.integer(tag(0x0018, 0x1706), top);
  to.integer(tag(0x0018, 0x1708), image.rows + 1 - bottom);
}

void add_frames(const XaImage& image, DataElements& to) {
  const std::size_t frames = image.frames.size();
  if (frames == 1) return;
  to.text(tag(0x0018, 0x1500), "CS", "STATIC");
  to.integer(tag(0x0028, 0x0008), static_cast<long>(frames));
  const double mean_ms = kMs_per_s * (image.time_s.back() - image.time_s.front()) / static_cast<double>(frames - 1);
  std::vector<double> step_ms{0.0};
  for (std::size_t n = 1; n < frames; ++n) step_ms.push_back(kMs_per_s * (image.time_s[n] - image.time_s[n - 1]));
  const bool is_even = std::all_of(step_ms.begin() + 1, step_ms.end(),
                                   [&](double ms) { return std::abs(ms - mean_ms) < kTimeRounding_ms; });
  to.integer(tag(0x0018, 0x0040), std::max(1L, std::lround(kMs_per_s / mean_ms)));  // cine rate
  if (is_even) {
    to.decimal(tag(0x0018, 0x1063), mean_ms);
    to.tag_pointer(tag(0x0028, 0x0009), tag(0x0018, 0x1063));
  } else {
    to.text(tag(0x0018, 0x1065), "DS", fmt::format("{:.6g}", fmt::join(step_ms, "\\")));
    to.tag_pointer(tag(0x0028, 0x0009), tag(0x0018, 0x1065));
  }
}

void add_pixels(const XaImage& image, DataElements& to) {
  to.text(tag(0x0008, 0x0008), "CS", "ORIGINAL\\PRIMARY\\SINGLE PLANE");
  to.number(tag(0x0028, 0x0002), 1);
  to.text(tag(0x0028, 0x0004), "CS", "MONOCHROME2");
  to.number(tag(0x0028, 0x0010), image.rows);
  to.number(tag(0x0028, 0x0011), image.columns);
  to.number(tag(0x0028, 0x0100), 8);
  to.number(tag(0x0028, 0x0101), 8);
  to.number(tag(0x0028, 0x0102), 7);
  to.number(tag(0x0028, 0x0103), 0);
  to.text(tag(0x0028, 0x1040), "CS", "DISP");
  to.decimal(tag(0x0028, 0x1050), 127.5);
  to.decimal(tag(0x0028, 0x1051), 256.0);
  to.text(tag(0x0028, 0x2110), "CS", "00");
  std::string pixels;
  pixels.reserve(image.frames.size() * image.frames.front().size());
  for (const auto& frame : image.frames) pixels.append(reinterpret_cast<const char*>(frame.data()), frame.size());
  to.text(kPixelData, "OB", pixels);
}

}  // namespace

Status write_xa_file(const XaImage& image, const std::filesystem::path& path) {
  TROCAR_TRY_STATUS(check(image, path.string()));
  const std::string instance_uid = image.identity.instance_uid.empty()
                                       ? detail::Pseudonyms::with_random_salt().uid("instance")
                                       : image.identity.instance_uid;
  DataElements elements;
  add_identity(image.identity, instance_uid, elements);
  add_exposure(image.exposure, elements);
  add_geometry(image, elements);
  add_frames(image, elements);
  add_pixels(image, elements);
  return write_atomically(path, [&](const std::filesystem::path& temporary) -> Status {
    detail::OutputFile out(temporary);
    detail::write_meta({std::string(kXaClass), instance_uid, std::string(kExplicitLittleEndian)}, out);
    detail::ElementWriter writer(out);
    elements.write(writer);
    return out.close();
  });
}

}  // namespace trocar::dicom
