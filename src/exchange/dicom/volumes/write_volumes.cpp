#include "dicom/volumes/write_volumes.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "core/files/output_file.h"
#include "core/version.h"
#include "dicom/elements/element_walk.h"
#include "dicom/pacs/detail/anonymisation.h"
#include "dicom/pacs/detail/element_writer.h"

namespace trocar::dicom {
namespace {

using detail::DataElements;

constexpr std::string_view kCtClass = "1.2.840.10008.5.1.4.1.1.2";
constexpr std::string_view kSegClass = "1.2.840.10008.5.1.4.1.1.66.4";
constexpr std::string_view kExplicitLittle = "1.2.840.10008.1.2.1";
constexpr int kMostRowsOrColumns = 65'535;  // of 16 bits

Status check_volume(const volume::GridGeometry& g, const std::string& where) {
  if (g.size[0] < 1 || g.size[1] < 1 || g.size[2] < 1 || g.size[0] > kMostRowsOrColumns ||
      g.size[1] > kMostRowsOrColumns)
    return fail("the volume has a size that DICOM cannot hold", where, "write NIfTI (--nifti)");
  return {};
}

Status check_slices(const VolumeIdentity& identity, const volume::GridGeometry& g, const std::string& where) {
  if (identity.slice_uids.size() == static_cast<std::size_t>(g.size[2])) return {};
  return fail("the identity is not that of this CT", where, "make one for its number of slices");
}

void add_common(const VolumeIdentity& identity, std::string_view sop_class, const std::string& instance_uid,
                DataElements& to) {
  to.text(tag(0x0008, 0x0005), "CS", "ISO_IR 192");
  to.text(tag(0x0008, 0x0016), "UI", sop_class);
  to.text(tag(0x0008, 0x0018), "UI", instance_uid);
  for (const std::uint32_t date : {tag(0x0008, 0x0020), tag(0x0008, 0x0023), tag(0x0010, 0x0030)})
    to.text(date, "DA", "");
  for (const std::uint32_t time : {tag(0x0008, 0x0030), tag(0x0008, 0x0033)}) to.text(time, "TM", "");
  to.text(tag(0x0008, 0x0050), "SH", "");
  to.text(tag(0x0008, 0x0070), "LO", "Trocar");
  to.text(tag(0x0008, 0x0090), "PN", "");
  to.text(tag(0x0008, 0x1090), "LO", "Trocar simulator");
  to.text(tag(0x0010, 0x0010), "PN", identity.patient_name);
  to.text(tag(0x0010, 0x0020), "LO", identity.patient_id);
  to.text(tag(0x0010, 0x0040), "CS", "");
  to.text(tag(0x0012, 0x0062), "CS", "YES");
  to.text(tag(0x0012, 0x0063), "LO", "exported from a simulator");
  to.text(tag(0x0018, 0x1000), "LO", "0");
  to.text(tag(0x0018, 0x1020), "LO", kVersion);
  to.text(tag(0x0020, 0x000d), "UI", identity.study_uid);
  to.text(tag(0x0020, 0x0010), "SH", "1");
  to.text(tag(0x0020, 0x0052), "UI", identity.frame_of_reference);
  to.text(tag(0x0020, 0x1040), "LO", "");
}

/// When the segmentation was written: DICOM requires a date.
void add_content_time(DataElements& to) {
  const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
  const auto day = std::chrono::floor<std::chrono::days>(now);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss time(now - day);
  to.text(tag(0x0008, 0x0023), "DA",
          fmt::format("{:04}{:02}{:02}", static_cast<int>(date.year()), static_cast<unsigned>(date.month()),
                      static_cast<unsigned>(date.day())));
  to.text(tag(0x0008, 0x0033), "TM",
          fmt::format("{:02}{:02}{:02}", time.hours().count(), time.minutes().count(), time.seconds().count()));
}

std::vector<double> numbers_of(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

std::vector<double> orientation_of(const volume::GridGeometry& g) {
  std::vector<double> numbers = numbers_of(g.R_PV.col(0));
  for (const double number : numbers_of(g.R_PV.col(1))) numbers.push_back(number);
  return numbers;
}

Vec3 place_of_slice(const volume::GridGeometry& g, std::int64_t k) {
  return g.to_mm({0.0, 0.0, static_cast<double>(k)});
}

void add_pixel_description(const volume::GridGeometry& g, int bits, bool is_signed, DataElements& to) {
  to.number(tag(0x0028, 0x0002), 1);
  to.text(tag(0x0028, 0x0004), "CS", "MONOCHROME2");
  to.number(tag(0x0028, 0x0010), static_cast<int>(g.size[1]));
  to.number(tag(0x0028, 0x0011), static_cast<int>(g.size[0]));
  to.number(tag(0x0028, 0x0100), bits);
  to.number(tag(0x0028, 0x0101), bits);
  to.number(tag(0x0028, 0x0102), bits - 1);
  to.number(tag(0x0028, 0x0103), is_signed ? 1 : 0);
}

Status write_object(const DataElements& elements, std::string_view sop_class, const std::string& instance_uid,
                    const std::filesystem::path& path) {
  return write_atomically(path, [&](const std::filesystem::path& temporary) -> Status {
    detail::OutputFile out(temporary);
    detail::write_meta({std::string(sop_class), instance_uid, std::string(kExplicitLittle)}, out);
    detail::ElementWriter writer(out);
    elements.write(writer);
    return out.close();
  });
}

std::string new_uid() {
  return detail::Pseudonyms::with_random_salt().uid("instance");
}

std::string slice_pixels(const volume::CtGrid& ct, std::int64_t k) {
  const auto count = static_cast<std::size_t>(ct.geometry.size[0] * ct.geometry.size[1]);
  const std::int16_t* hu = ct.voxels.data() + static_cast<std::size_t>(k) * count;
  std::string bytes(2 * count, '\0');
  for (std::size_t n = 0; n < count; ++n) {
    const auto word = static_cast<std::uint16_t>(hu[n]);
    bytes[2 * n] = static_cast<char>(word & 0xff);
    bytes[2 * n + 1] = static_cast<char>(word >> 8);
  }
  return bytes;
}

DataElements slice_elements(const volume::CtGrid& ct, std::int64_t k, const VolumeIdentity& identity,
                            const std::string& instance_uid) {
  const volume::GridGeometry& g = ct.geometry;
  DataElements to;
  add_common(identity, kCtClass, instance_uid, to);
  to.text(tag(0x0008, 0x0008), "CS", "DERIVED\\SECONDARY\\AXIAL");
  to.text(tag(0x0008, 0x0060), "CS", "CT");
  to.text(tag(0x0008, 0x103e), "LO", "CT");
  to.decimal(tag(0x0018, 0x0050), g.spacing_mm.z());
  to.text(tag(0x0018, 0x0060), "DS", "");
  to.text(tag(0x0018, 0x5100), "CS", "");  // the position in a scanner is not known
  to.text(tag(0x0020, 0x000e), "UI", identity.ct_series_uid);
  to.integer(tag(0x0020, 0x0011), 1);
  to.text(tag(0x0020, 0x0060), "CS", "");  // laterality: none
  to.text(tag(0x0020, 0x0012), "IS", "");
  to.integer(tag(0x0020, 0x0013), static_cast<long>(k + 1));
  to.decimals(tag(0x0020, 0x0032), numbers_of(place_of_slice(g, k)));
  to.decimals(tag(0x0020, 0x0037), orientation_of(g));
  to.decimals(tag(0x0028, 0x0030), {g.spacing_mm.y(), g.spacing_mm.x()});
  to.text(tag(0x0028, 0x1052), "DS", "0");
  to.text(tag(0x0028, 0x1053), "DS", "1");
  to.text(tag(0x0028, 0x1054), "LO", "HU");
  add_pixel_description(g, 16, true, to);
  to.text(kPixelData, "OW", slice_pixels(ct, k));
  return to;
}

DataElements code_item(std::string_view value, std::string_view meaning, std::string_view scheme = "SCT") {
  DataElements item;
  item.text(tag(0x0008, 0x0100), "SH", value);
  item.text(tag(0x0008, 0x0102), "SH", scheme);
  item.text(tag(0x0008, 0x0104), "LO", meaning);
  return item;
}

DataElements segment_item_of(const WrittenSegment& segment, int number) {
  DataElements type = segment.code.empty() ? code_item("85756007", "Tissue") : code_item(segment.code, segment.meaning);
  if (!segment.side.empty())
    type.sequence(tag(0x0062, 0x0011), {code_item(segment.side == "Left" ? "7771000" : "24028007", segment.side)});
  DataElements item;
  item.number(tag(0x0062, 0x0004), number);
  item.text(tag(0x0062, 0x0005), "LO", segment.name);
  item.text(tag(0x0062, 0x0008), "CS", "SEMIAUTOMATIC");
  item.text(tag(0x0062, 0x0009), "LO", "Trocar");
  item.sequence(tag(0x0062, 0x0003), {code_item("123037004", "Anatomical Structure")});
  item.sequence(tag(0x0062, 0x000f), {type});
  return item;
}

/// The frames of all segments, one bit a pixel without gaps.
class BitFrames {
 public:
  explicit BitFrames(const volume::LabelGrid& labels) : labels_(labels) {}

  /// Adds a frame if the slice has a voxel of the value.
  bool add(int value, std::int64_t k) {
    const auto count = static_cast<std::size_t>(labels_.geometry.size[0] * labels_.geometry.size[1]);
    const std::uint8_t* voxels = labels_.voxels.data() + static_cast<std::size_t>(k) * count;
    if (std::find(voxels, voxels + count, static_cast<std::uint8_t>(value)) == voxels + count) return false;
    bytes_.resize((bits_ + count + 7) / 8, '\0');
    for (std::size_t n = 0; n < count; ++n, ++bits_)
      if (voxels[n] == value) bytes_[bits_ / 8] = static_cast<char>(bytes_[bits_ / 8] | 1 << bits_ % 8);
    return true;
  }
  const std::string& bytes() const noexcept { return bytes_; }

 private:
  const volume::LabelGrid& labels_;
  std::string bytes_;
  std::size_t bits_ = 0;
};

/// The slice of the CT that a frame was drawn on.
DataElements derivation_from(const std::string& slice_uid) {
  DataElements source, derivation;
  source.text(tag(0x0008, 0x1150), "UI", kCtClass);
  source.text(tag(0x0008, 0x1155), "UI", slice_uid);
  source.sequence(tag(0x0040, 0xa170), {code_item("121322", "Source image for image processing operation", "DCM")});
  derivation.sequence(tag(0x0008, 0x2112), {source});
  derivation.sequence(tag(0x0008, 0x9215), {code_item("113076", "Segmentation", "DCM")});
  return derivation;
}

DataElements frame_groups(const volume::GridGeometry& g, int segment, std::int64_t k, const std::string& slice_uid) {
  DataElements position, content, identification, groups;
  groups.sequence(tag(0x0008, 0x9124), {derivation_from(slice_uid)});
  position.decimals(tag(0x0020, 0x0032), numbers_of(place_of_slice(g, k)));
  std::string indices;  // segment, slice
  for (const std::int64_t index : {static_cast<std::int64_t>(segment), k + 1})
    for (const int shift : {0, 8, 16, 24}) indices += static_cast<char>(index >> shift & 0xff);
  content.text(tag(0x0020, 0x9157), "UL", indices);
  identification.number(tag(0x0062, 0x000b), segment);
  groups.sequence(tag(0x0020, 0x9111), {content});
  groups.sequence(tag(0x0020, 0x9113), {position});
  groups.sequence(tag(0x0062, 0x000a), {identification});
  return groups;
}

DataElements shared_groups(const volume::GridGeometry& g) {
  DataElements orientation, measures, shared;
  orientation.decimals(tag(0x0020, 0x0037), orientation_of(g));
  measures.decimal(tag(0x0018, 0x0050), g.spacing_mm.z());
  measures.decimal(tag(0x0018, 0x0088), g.spacing_mm.z());
  measures.decimals(tag(0x0028, 0x0030), {g.spacing_mm.y(), g.spacing_mm.x()});
  shared.sequence(tag(0x0020, 0x9116), {orientation});
  shared.sequence(tag(0x0028, 0x9110), {measures});
  return shared;
}

/// Frames are ordered by segment, then by place.
void add_dimensions(const std::string& uid, DataElements& to) {
  DataElements organization, by_segment, by_place;
  organization.text(tag(0x0020, 0x9164), "UI", uid);
  by_segment.text(tag(0x0020, 0x9164), "UI", uid);
  by_segment.tag_pointer(tag(0x0020, 0x9165), tag(0x0062, 0x000b));
  by_segment.tag_pointer(tag(0x0020, 0x9167), tag(0x0062, 0x000a));
  by_place.text(tag(0x0020, 0x9164), "UI", uid);
  by_place.tag_pointer(tag(0x0020, 0x9165), tag(0x0020, 0x0032));
  by_place.tag_pointer(tag(0x0020, 0x9167), tag(0x0020, 0x9113));
  to.sequence(tag(0x0020, 0x9221), {organization});
  to.sequence(tag(0x0020, 0x9222), {by_segment, by_place});
}

}  // namespace

VolumeIdentity make_identity(std::int64_t slices) {
  const detail::Pseudonyms random = detail::Pseudonyms::with_random_salt();
  VolumeIdentity identity;
  identity.study_uid = random.uid("study");
  identity.ct_series_uid = random.uid("CT series");
  identity.segmentation_series_uid = random.uid("segmentation series");
  identity.frame_of_reference = random.uid("frame of reference");
  for (std::int64_t k = 0; k < slices; ++k) identity.slice_uids.push_back(random.uid(fmt::format("slice {}", k)));
  return identity;
}

Status write_ct_series(const volume::CtGrid& ct, const VolumeIdentity& identity, const std::filesystem::path& folder,
                       const Progress& progress) {
  TROCAR_TRY_STATUS(check_volume(ct.geometry, folder.string()));
  TROCAR_TRY_STATUS(check_slices(identity, ct.geometry, folder.string()));
  for (std::int64_t k = 0; k < ct.geometry.size[2]; ++k) {
    report(progress, "slices", static_cast<double>(k) / static_cast<double>(ct.geometry.size[2]));
    const std::string& uid = identity.slice_uids[static_cast<std::size_t>(k)];
    TROCAR_TRY_STATUS(
        write_object(slice_elements(ct, k, identity, uid), kCtClass, uid, folder / fmt::format("ct_{:04}.dcm", k + 1)));
  }
  return {};
}

Status write_segmentation(const volume::LabelGrid& labels, const std::vector<WrittenSegment>& segments,
                          const VolumeIdentity& identity, const std::filesystem::path& path) {
  const volume::GridGeometry& g = labels.geometry;
  TROCAR_TRY_STATUS(check_volume(g, path.string()));
  TROCAR_TRY_STATUS(check_slices(identity, g, path.string()));
  BitFrames frames(labels);
  std::vector<DataElements> items, groups;
  for (const WrittenSegment& segment : segments) {
    const int number = static_cast<int>(items.size()) + 1;
    const std::size_t before = groups.size();
    for (std::int64_t k = 0; k < g.size[2]; ++k)
      if (frames.add(segment.number, k))
        groups.push_back(frame_groups(g, number, k, identity.slice_uids[static_cast<std::size_t>(k)]));
    if (groups.size() > before) items.push_back(segment_item_of(segment, number));
  }
  if (groups.empty()) return fail("no structure has a voxel", path.string(), "export a patient with structures");
  const std::string instance_uid = new_uid();
  DataElements to, series;
  std::vector<DataElements> instances;
  for (const std::string& uid : identity.slice_uids) {
    DataElements instance;
    instance.text(tag(0x0008, 0x1150), "UI", kCtClass);
    instance.text(tag(0x0008, 0x1155), "UI", uid);
    instances.push_back(instance);
  }
  series.sequence(tag(0x0008, 0x114a), instances);
  add_common(identity, kSegClass, instance_uid, to);
  add_content_time(to);
  to.text(tag(0x0008, 0x0008), "CS", "DERIVED\\PRIMARY");
  to.text(tag(0x0008, 0x0060), "CS", "SEG");
  to.text(tag(0x0008, 0x103e), "LO", "Segmentation");
  series.text(kSeriesUid, "UI", identity.ct_series_uid);
  to.sequence(tag(0x0008, 0x1115), {series});
  to.text(kSeriesUid, "UI", identity.segmentation_series_uid);
  to.integer(tag(0x0020, 0x0011), 2);
  to.integer(tag(0x0020, 0x0013), 1);
  add_dimensions(new_uid(), to);
  to.integer(tag(0x0028, 0x0008), static_cast<long>(groups.size()));
  add_pixel_description(g, 1, false, to);
  to.text(tag(0x0028, 0x2110), "CS", "00");
  to.text(tag(0x0062, 0x0001), "CS", "BINARY");
  to.sequence(tag(0x0062, 0x0002), items);
  to.text(tag(0x0070, 0x0080), "CS", "SEGMENTATION");
  to.text(tag(0x0070, 0x0081), "LO", "");
  to.text(tag(0x0070, 0x0084), "PN", "Trocar");
  to.sequence(tag(0x5200, 0x9229), {shared_groups(g)});
  to.sequence(tag(0x5200, 0x9230), groups);
  to.text(kPixelData, "OB", frames.bytes());
  return write_object(to, kSegClass, instance_uid, path);
}

}  // namespace trocar::dicom
