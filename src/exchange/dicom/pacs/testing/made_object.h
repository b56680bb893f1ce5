#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "dicom/pacs/detail/element_writer.h"

namespace trocar::dicom::testing {

/// A data set that a test puts together; elements are sorted by tag.
class MadeObject {
 public:
  explicit MadeObject(Encoding encoding = {}) : encoding_(encoding) {}

  MadeObject& add(std::uint32_t tag, std::string_view vr, std::string_view value) {
    elements_[tag] = detail::encoded_element(tag, vr, value, encoding_);
    return *this;
  }
  MadeObject& add_number(std::uint32_t tag, std::uint16_t value) {
    const char low = static_cast<char>(value & 0xff), high = static_cast<char>(value >> 8);
    return add(tag, "US", encoding_.is_big_endian ? std::string{high, low} : std::string{low, high});
  }
  /// A sequence of defined length.
  MadeObject& add_items(std::uint32_t tag, const std::vector<MadeObject>& items, std::string_view vr = "SQ") {
    std::string bytes;
    const Encoding bare{encoding_.is_big_endian, true};
    for (const MadeObject& item : items) bytes += detail::encoded_element(0xfffee000, "", item.bytes(), bare);
    return add(tag, vr, bytes);
  }
  /// Bytes as they are, in the place of an element.
  MadeObject& add_raw(std::uint32_t tag, std::string bytes) {
    elements_[tag] = std::move(bytes);
    return *this;
  }

  std::string bytes() const {
    std::string all;
    for (const auto& [tag, element] : elements_) all += element;
    return all;
  }
  /// With preamble and meta information.
  std::string file(std::string_view transfer_syntax = "1.2.840.10008.1.2.1") const {
    const std::string group = detail::encoded_element(0x00020010, "UI", transfer_syntax, {});
    std::string length(4, '\0');
    length[0] = static_cast<char>(group.size());
    std::string all(128, '\0');
    all += "DICM";
    return all + detail::encoded_element(0x00020000, "UL", length, {}) + group + bytes();
  }

 private:
  Encoding encoding_;
  std::map<std::uint32_t, std::string> elements_;
};

// The study of the tests: a CT of 6 slices with 64 x 64 pixels of 0.5 mm, a segmentation and a structure set of it.
inline constexpr const char* kStudyUid = "1.3.6.1.4.1.99999.1.2023051701";
inline constexpr const char* kCtSeriesUid = "1.3.6.1.4.1.99999.1.2023051701.2";
inline constexpr const char* kSegSeriesUid = "1.3.6.1.4.1.99999.1.2023051701.3";
inline constexpr const char* kRtSeriesUid = "1.3.6.1.4.1.99999.1.2023051701.4";
inline constexpr const char* kFrameUid = "1.3.6.1.4.1.99999.1.2023051701.9";
inline constexpr const char* kCtClass = "1.2.840.10008.5.1.4.1.1.2";
inline constexpr const char* kSegClass = "1.2.840.10008.5.1.4.1.1.66.4";
inline constexpr const char* kRtClass = "1.2.840.10008.5.1.4.1.1.481.3";
inline constexpr int kSlices = 6;
inline constexpr int kColumns = 64;
inline constexpr double kStep_mm = 2.5;

inline std::string ct_instance(int slice) {
  return fmt::format("{}.{}", kCtSeriesUid, slice + 1);
}

/// Texts that identify the patient, the case or the place; none may remain in an anonymised object.
inline std::vector<std::string> identifying_texts() {
  return {"Mustermann", "MUSTERMANN", "Erika",     "PAT-778123", "778123", "19640812", "20230517",   "ACC998877",
          "Nirgendwo",  "Hausarzt",   "Radiologe", "SECRET",     "99999",  "Seestr",   "CT-RAUM-17", "101530"};
}

inline void add_identity(MadeObject& object) {
  object.add(0x00080020, "DA", "20230517").add(0x00080021, "DA", "20230517").add(0x00080022, "DA", "20230517");
  object.add(0x0008002a, "DT", "20230517101530.5").add(0x00080030, "TM", "101530").add(0x00080050, "SH", "ACC998877");
  object.add(0x00080080, "LO", "Klinikum Nirgendwo").add(0x00080081, "ST", "Seestr. 1, Nirgendwo");
  object.add(0x00080090, "PN", "Hausarzt^Otto").add(0x00081010, "SH", "CT-RAUM-17");
  object.add(0x00081030, "LO", "Abdomen of Erika").add(0x00081050, "PN", "Radiologe^Rita");
  object.add(0x00090010, "LO", "SECRET VENDOR").add(0x00091001, "LO", "Mustermann in a private element");
  object.add(0x00100010, "PN", "Mustermann^Erika").add(0x00100020, "LO", "PAT-778123");
  object.add(0x00100030, "DA", "19640812").add(0x00100040, "CS", "F").add(0x00101000, "LO", "778123");
  object.add(0x00101040, "LO", "Seestr. 2").add(0x00104000, "LT", "Mustermann is afraid of needles");
  object.add(0x00180030, "LO", "SECRET drug").add(0x00181000, "LO", "SECRET serial number");
  object.add(0x00204000, "LT", "comment on Erika").add(0x0020000d, "UI", kStudyUid);
  MadeObject request;
  request.add(0x00321032, "PN", "Hausarzt^Otto")
      .add(0x00400007, "LO", "Mustermann liver")
      .add(0x00401001, "SH", "SECRET");
  object.add_items(0x00400275, {request});
}

inline MadeObject made_ct(int slice) {
  MadeObject object;
  add_identity(object);
  object.add(0x00080008, "CS", "ORIGINAL\\PRIMARY\\AXIAL").add(0x00080016, "UI", kCtClass);
  object.add(0x00080018, "UI", ct_instance(slice)).add(0x00080060, "CS", "CT");
  object.add(0x0008103e, "LO", "Abdomen MUSTERMANN 3.0").add(0x00180050, "DS", "2.5").add(0x00180060, "DS", "120");
  object.add(0x0020000e, "UI", kCtSeriesUid).add(0x00200011, "IS", "2");
  object.add(0x00200013, "IS", std::to_string(kSlices - slice));  // against the order of the UIDs
  object.add(0x00200032, "DS", fmt::format("-4\\-8\\{}", 100.0 + kStep_mm * slice));
  object.add(0x00200037, "DS", "1\\0\\0\\0\\1\\0").add(0x00200052, "UI", kFrameUid);
  object.add_number(0x00280002, 1).add(0x00280004, "CS", "MONOCHROME2").add_number(0x00280010, kColumns);
  object.add_number(0x00280011, kColumns).add(0x00280030, "DS", "0.5\\0.5").add_number(0x00280100, 16);
  object.add_number(0x00280101, 16).add_number(0x00280102, 15).add_number(0x00280103, 1);
  object.add(0x00281052, "DS", "-1000").add(0x00281053, "DS", "1");
  object.add(0x60003000, "OW", "SECRET overlay with a name ");
  std::string pixels;
  for (int n = 0; n < kColumns * kColumns; ++n) {
    const int stored = 1000 + 10 * slice + n % 50;
    pixels += static_cast<char>(stored & 0xff);
    pixels += static_cast<char>(stored >> 8);
  }
  return object.add(0x7fe00010, "OW", pixels);
}

/// CT number of a pixel of made_ct (HU).
inline int made_hu(int slice, int pixel) {
  return 10 * slice + pixel % 50;
}

inline MadeObject reference(const std::string& sop_class, const std::string& instance) {
  MadeObject item;
  item.add(0x00081150, "UI", sop_class).add(0x00081155, "UI", instance);
  return item;
}

inline MadeObject made_segmentation() {
  MadeObject object, segment, series;
  add_identity(object);
  object.add(0x00080016, "UI", kSegClass).add(0x00080018, "UI", std::string(kSegSeriesUid) + ".1");
  object.add(0x00080023, "DA", "20230517").add(0x00080033, "TM", "101530").add(0x00080060, "CS", "SEG");
  std::vector<MadeObject> images;
  for (int slice = 0; slice < kSlices; ++slice) images.push_back(reference(kCtClass, ct_instance(slice)));
  series.add_items(0x0008114a, images).add(0x0020000e, "UI", kCtSeriesUid);
  object.add_items(0x00081115, {series}).add(0x0020000e, "UI", kSegSeriesUid).add(0x00200011, "IS", "3");
  object.add(0x00200052, "UI", kFrameUid).add(0x00700080, "CS", "LIVER").add(0x00700084, "PN", "Radiologe^Rita");
  segment.add_number(0x00620004, 1).add(0x00620005, "LO", "liver").add(0x00620006, "ST", "liver of Erika");
  object.add_items(0x00620002, {segment}).add_number(0x00280010, kColumns).add_number(0x00280011, kColumns);
  object.add_number(0x00280002, 1).add(0x00280008, "IS", "1").add_number(0x00280100, 1);
  return object.add(0x7fe00010, "OB", std::string(kColumns * kColumns / 8, '\x55'));
}

inline MadeObject made_structures() {
  MadeObject object, roi, contour, roi_contour, study, series, frame;
  add_identity(object);
  object.add(0x00080016, "UI", kRtClass).add(0x00080018, "UI", std::string(kRtSeriesUid) + ".1");
  object.add(0x00080060, "CS", "RTSTRUCT").add(0x0020000e, "UI", kRtSeriesUid).add(0x00200011, "IS", "4");
  object.add(0x30060002, "SH", "Mustermann").add(0x30060008, "DA", "20230517");
  series.add(0x0020000e, "UI", kCtSeriesUid).add_items(0x30060016, {reference(kCtClass, ct_instance(1))});
  study.add(0x00081150, "UI", "1.2.840.10008.3.1.2.3.1")
      .add(0x00081155, "UI", kStudyUid)
      .add_items(0x30060014, {series});
  frame.add(0x00200052, "UI", kFrameUid).add_items(0x30060012, {study});
  roi.add(0x30060022, "IS", "1").add(0x30060024, "UI", kFrameUid).add(0x30060026, "LO", "liver Mustermann");
  contour.add_items(0x30060016, {reference(kCtClass, ct_instance(1))}).add(0x30060042, "CS", "CLOSED_PLANAR");
  contour.add(0x30060046, "IS", "3").add(0x30060050, "DS", "0\\0\\102.5\\1\\0\\102.5\\0\\1\\102.5");
  roi_contour.add_items(0x30060040, {contour}).add(0x30060084, "IS", "1");
  return object.add_items(0x30060010, {frame}).add_items(0x30060020, {roi}).add_items(0x30060039, {roi_contour});
}

}  // namespace trocar::dicom::testing
