#include "io/detail/dicom_slice.h"

#include <gdcmPixmapReader.h>
#include <gdcmReader.h>

#include <charconv>
#include <cmath>
#include <cstring>
#include <vector>

#include "io/detail/quiet.h"

namespace trocar::detail {
namespace fs = std::filesystem;
namespace {

constexpr const char* kExportAgain = "export the series again, uncompressed";

/// The text of a short element, without the padding; empty where it is missing.
std::string text_of(const gdcm::DataSet& data, gdcm::Tag tag) {
  if (!data.FindDataElement(tag)) return {};
  const gdcm::ByteValue* bytes = data.GetDataElement(tag).GetByteValue();
  if (bytes == nullptr || bytes->GetLength() > 4096) return {};
  std::string text(bytes->GetPointer(), bytes->GetLength());
  const auto last = text.find_last_not_of(std::string_view(" \0", 2));
  text.resize(last == std::string::npos ? 0 : last + 1);
  return text;
}

/// Numbers of a decimal string "a\b\c", as many as asked for or nothing.
template <std::size_t N>
std::optional<std::array<double, N>> decimals_of(const gdcm::DataSet& data, gdcm::Tag tag) {
  const std::string text = text_of(data, tag);
  std::array<double, N> numbers{};
  std::size_t begin = 0;
  for (double& number : numbers) {
    if (begin > text.size()) return std::nullopt;
    const std::size_t end = std::min(text.find('\\', begin), text.size());
    const std::size_t first = text.find_first_not_of(" +", begin);
    if (first >= end) return std::nullopt;
    const auto parsed = std::from_chars(text.data() + first, text.data() + end, number);
    if (parsed.ec != std::errc{} || !std::isfinite(number)) return std::nullopt;
    begin = end + 1;
  }
  return numbers;
}

/// An unsigned short (US) in the data set's byte order, which gdcm has already turned to ours.
int short_of(const gdcm::DataSet& data, gdcm::Tag tag, int fallback) {
  if (!data.FindDataElement(tag)) return fallback;
  const gdcm::ByteValue* bytes = data.GetDataElement(tag).GetByteValue();
  if (bytes == nullptr || bytes->GetLength() < 2) return fallback;
  std::uint16_t value = 0;
  std::memcpy(&value, bytes->GetPointer(), sizeof value);
  return value;
}

DicomSlice slice_of(const gdcm::DataSet& data) {
  DicomSlice slice;
  slice.series_uid = text_of(data, {0x0020, 0x000e});
  slice.series_description = text_of(data, {0x0008, 0x103e});
  slice.rows = short_of(data, {0x0028, 0x0010}, 0);
  slice.columns = short_of(data, {0x0028, 0x0011}, 0);
  slice.samples_per_pixel = short_of(data, {0x0028, 0x0002}, 1);
  if (const auto frames = decimals_of<1>(data, {0x0028, 0x0008})) slice.frames = static_cast<int>((*frames)[0]);
  if (const auto p = decimals_of<3>(data, {0x0020, 0x0032})) slice.position_P = Vec3((*p)[0], (*p)[1], (*p)[2]);
  if (const auto d = decimals_of<6>(data, {0x0020, 0x0037}))
    slice.directions_P = {Vec3((*d)[0], (*d)[1], (*d)[2]), Vec3((*d)[3], (*d)[4], (*d)[5])};
  // DICOM names the distance between rows first.
  if (const auto s = decimals_of<2>(data, {0x0028, 0x0030})) slice.spacing_mm = {(*s)[1], (*s)[0]};
  if (const auto slope = decimals_of<1>(data, {0x0028, 0x1053})) slice.slope = (*slope)[0];
  if (const auto intercept = decimals_of<1>(data, {0x0028, 0x1052})) slice.intercept = (*intercept)[0];
  return slice;
}

std::optional<VoxelType> find_voxel_type(const gdcm::PixelFormat& format) {
  switch (format.GetScalarType()) {
    case gdcm::PixelFormat::UINT8:
      return VoxelType::kUInt8;
    case gdcm::PixelFormat::INT8:
      return VoxelType::kInt8;
    case gdcm::PixelFormat::UINT12:
    case gdcm::PixelFormat::UINT16:
      return VoxelType::kUInt16;
    case gdcm::PixelFormat::INT12:
    case gdcm::PixelFormat::INT16:
      return VoxelType::kInt16;
    case gdcm::PixelFormat::UINT32:
      return VoxelType::kUInt32;
    case gdcm::PixelFormat::INT32:
      return VoxelType::kInt32;
    default:
      return std::nullopt;
  }
}

/// May throw what GDCM throws.
Status decode_throwing(const DicomSlice& slice, const std::function<Status(const RawVoxels&)>& use) {
  const std::string where = slice.file.string();
  gdcm::PixmapReader reader;
  reader.SetFileName(where.c_str());
  if (!reader.Read()) return fail("the DICOM image is damaged or ends too early", where, kExportAgain);
  const gdcm::Pixmap& image = reader.GetPixmap();
  const auto type = find_voxel_type(image.GetPixelFormat());
  const auto pixels = static_cast<std::size_t>(slice.columns) * static_cast<std::size_t>(slice.rows);
  if (!type || image.GetPixelFormat().GetSamplesPerPixel() != 1)
    return fail("stores its pixels in an unknown type", where, "give a CT series or a mask series");
  const std::size_t bytes = pixels * bytes_per_voxel(*type);
  const gdcm::ByteValue* raw = image.GetDataElement().GetByteValue();
  if (image.GetBufferLength() != bytes || (raw != nullptr && raw->GetLength() < bytes))
    return fail("the DICOM image ends before its last pixel", where, kExportAgain);
  std::vector<std::byte> buffer(bytes);
  if (!image.GetBuffer(reinterpret_cast<char*>(buffer.data())))
    return fail("the DICOM image cannot be unpacked", where, kExportAgain);
  if (auto status = use({*type, buffer, slice.slope, slice.intercept}); !status)
    return fail(status.error().what, where, status.error().advice);
  return {};
}

}  // namespace

std::optional<DicomSlice> find_dicom_slice(const fs::path& path) {
  silence_libraries();
  try {
    gdcm::Reader reader;
    reader.SetFileName(path.c_str());
    if (!reader.CanRead() || !reader.ReadUpToTag(gdcm::Tag(0x7fe0, 0x0010))) return std::nullopt;
    DicomSlice slice = slice_of(reader.GetFile().GetDataSet());
    slice.file = path;
    return slice.rows > 0 && slice.columns > 0 ? std::optional(slice) : std::nullopt;
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

Status decode_slice(const DicomSlice& slice, const std::function<Status(const RawVoxels&)>& use) {
  try {
    return decode_throwing(slice, use);
  } catch (const std::exception&) {
    return fail("the DICOM image is damaged", slice.file.string(), kExportAgain);
  }
}

}  // namespace trocar::detail
