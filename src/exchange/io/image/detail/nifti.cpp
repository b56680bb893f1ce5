#include "io/image/detail/nifti.h"

#include <fmt/format.h>
#include <itk_zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

#include "core/available_memory.h"
#include "io/image/detail/image_header.h"
#include "io/image/detail/inflate_input.h"
#include "io/image/detail/raw_volume.h"

// The header of a NIfTI-1 or NIfTI-2 file (format definition: nifti.nimh.nih.gov).

namespace trocar::io::detail {
namespace {

constexpr std::size_t kHeaderBytes1 = 348, kHeaderBytes2 = 540;
constexpr std::size_t kExtensionFlagBytes = 4;  ///< Between a header and the first byte that may be a voxel.

/// Fields of a NIfTI header in either byte order, by their offsets in version 1 and 2.
class NiftiHeader {
 public:
  NiftiHeader(const unsigned char* bytes, bool swap, bool is_version_2)
      : bytes_(bytes), swap_(swap), is_version_2_(is_version_2) {}

  std::size_t size() const { return is_version_2_ ? kHeaderBytes2 : kHeaderBytes1; }
  std::vector<std::int64_t> sizes() const {
    std::vector<std::int64_t> sizes;
    for (std::size_t axis = 1; axis <= static_cast<std::size_t>(std::clamp<std::int64_t>(dim(0), 0, 7)); ++axis)
      sizes.push_back(dim(axis));
    return sizes;
  }
  int type_code() const { return get<std::int16_t>(is_version_2_ ? 12 : 70); }
  int bits_per_voxel() const { return get<std::int16_t>(is_version_2_ ? 14 : 72); }
  double voxel_offset() const { return is_version_2_ ? static_cast<double>(get<std::int64_t>(168)) : real(0, 108); }
  double slope() const { return real(176, 112); }
  double intercept() const { return real(184, 116); }
  int qform_code() const { return is_version_2_ ? get<std::int32_t>(344) : get<std::int16_t>(252); }
  int sform_code() const { return is_version_2_ ? get<std::int32_t>(348) : get<std::int16_t>(254); }
  int length_unit() const { return (is_version_2_ ? get<std::int32_t>(500) : get<std::uint8_t>(123)) & 7; }
  double qfac() const { return real(104, 76); }
  Vec3 pixdim() const { return {real(112, 80), real(120, 84), real(128, 88)}; }
  Vec3 quaternion() const { return {real(352, 256), real(360, 260), real(368, 264)}; }
  Vec3 quaternion_offset() const { return {real(376, 268), real(384, 272), real(392, 276)}; }
  /// Entry of the 3 x 4 matrix index -> RAS.
  double sform(int row, int column) const {
    const auto n = static_cast<std::size_t>(4 * row + column);
    return real(400 + 8 * n, 280 + 4 * n);
  }
  /// A number of the file, in this machine's byte order.
  template <class T>
  T number_at(const unsigned char* bytes) const {
    std::array<unsigned char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes, sizeof(T));
    if (swap_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }

 private:
  template <class T>
  T get(std::size_t offset) const {
    return number_at<T>(bytes_ + offset);
  }
  double real(std::size_t offset_2, std::size_t offset_1) const {
    return is_version_2_ ? get<double>(offset_2) : static_cast<double>(get<float>(offset_1));
  }
  std::int64_t dim(std::size_t n) const {
    return is_version_2_ ? get<std::int64_t>(16 + 8 * n) : get<std::int16_t>(40 + 2 * n);
  }

  const unsigned char* bytes_;
  bool swap_;
  bool is_version_2_;
};

std::optional<VoxelType> voxel_type_of(int code) {
  switch (code) {
    case 2:
      return VoxelType::kUInt8;
    case 4:
      return VoxelType::kInt16;
    case 8:
      return VoxelType::kInt32;
    case 16:
      return VoxelType::kFloat;
    case 64:
      return VoxelType::kDouble;
    case 256:
      return VoxelType::kInt8;
    case 512:
      return VoxelType::kUInt16;
    case 768:
      return VoxelType::kUInt32;
    case 1024:
      return VoxelType::kInt64;
    case 1280:
      return VoxelType::kUInt64;
    default:
      return std::nullopt;
  }
}

const Vec3 kRasInLps(-1.0, -1.0, 1.0);

Status read_sform(const NiftiHeader& header, const std::string& where, volume::GridGeometry& geometry) {
  Mat3 axes;
  Vec3 origin;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) axes(row, column) = header.sform(row, column);
    origin[row] = header.sform(row, 3);
  }
  return set_place(kRasInLps.asDiagonal() * axes, kRasInLps.asDiagonal() * origin, "sform", where, geometry);
}

/// The quaternion (a, b, c, d) is stored without a; qfac -1 reverses k.
Status read_qform(const NiftiHeader& header, const std::string& where, volume::GridGeometry& geometry) {
  constexpr double kRounding = 1e-3;
  const Vec3 bcd = header.quaternion();
  const double squared = bcd.squaredNorm();
  if (!(squared <= 1.0 + kRounding))
    return fail("the header's qform is not a rotation", where, "export it again with its orientation");
  Eigen::Quaterniond rotation(std::sqrt(std::max(0.0, 1.0 - squared)), bcd[0], bcd[1], bcd[2]);
  const Vec3 pixdim = header.pixdim();
  if (!(pixdim.array() > 0.0).all())
    return fail(fmt::format("the header's pixdim {} x {} x {} is not above zero", pixdim[0], pixdim[1], pixdim[2]),
                where, "export the image with its spacing");
  Mat3 axes = rotation.normalized().toRotationMatrix() * pixdim.asDiagonal();
  if (header.qfac() < 0.0) axes.col(2) *= -1.0;
  return set_place(kRasInLps.asDiagonal() * axes, kRasInLps.asDiagonal() * header.quaternion_offset(), "qform", where,
                   geometry);
}

/// pixdim and the sform state the size of a voxel independently: nothing tells which of two sizes is right.
Status check_spacing(const NiftiHeader& header, const volume::GridGeometry& sform, const std::string& where) {
  constexpr double kLargestShare = 0.01;
  const Vec3 pixdim = header.pixdim(), spacing = sform.spacing_mm;
  if (!pixdim.allFinite())
    return fail("the header's pixdim contains a number that is not finite", where, "export it again");
  if ((pixdim.array() == 0.0).all()) return {};  // not stated
  if (((pixdim.cwiseAbs() - spacing).array().abs() <= kLargestShare * spacing.array()).all()) return {};
  return fail(fmt::format("the header gives two sizes of a voxel: {:.4g} x {:.4g} x {:.4g} mm by pixdim, {:.4g} x "
                          "{:.4g} x {:.4g} mm by the sform",
                          pixdim[0], pixdim[1], pixdim[2], spacing[0], spacing[1], spacing[2]),
              where, "export it again, so that pixdim and sform agree");
}

/// The sform counts, as for TotalSegmentator, nibabel and 3D Slicer; the qform where there is none.
Status read_place(const NiftiHeader& header, const std::string& where, ImageHeader& image) {
  if (header.sform_code() <= 0 && header.qform_code() <= 0)
    return fail("no orientation in the header (qform and sform codes are both 0)", where,
                "export it again with its orientation");
  constexpr int kUnknownUnit = 0, kMm = 2;
  if (header.length_unit() != kUnknownUnit && header.length_unit() != kMm)
    return fail("its spatial unit is not mm", where, "export it again in mm");
  if (header.sform_code() <= 0) return read_qform(header, where, image.geometry);
  TROCAR_TRY_STATUS(read_sform(header, where, image.geometry));
  TROCAR_TRY_STATUS(check_spacing(header, image.geometry, where));
  if (header.qform_code() <= 0) return {};
  volume::GridGeometry by_qform = image.geometry;
  if (!read_qform(header, where, by_qform)) {
    image.warnings.push_back("the qform is invalid; the sform is used");
    return {};
  }
  constexpr double kRounding_mm = 0.1;
  const double distance_mm = largest_distance_mm(image.geometry, by_qform);
  if (distance_mm > kRounding_mm)
    image.warnings.push_back(
        fmt::format("sform and qform differ by {:.3g} mm; the sform is used, as by TotalSegmentator", distance_mm));
  return {};
}

/// A slope of 0 means that there is no scaling, whatever the intercept.
Status read_scaling(const NiftiHeader& header, const std::string& where, ImageHeader& image) {
  const double slope = header.slope(), intercept = header.intercept();
  if (slope == 0.0) return {};
  if (!std::isfinite(slope) || !std::isfinite(intercept))
    return fail("the header's scl_slope or scl_inter is not a finite number", where, "export it again");
  image.slope = slope;
  image.intercept = intercept;
  return {};
}

/// The extension with a label table; empty if there is none. Extensions lie between the header and the voxels, each
/// with its size and kind first. Programs write the table with the kind of Caret (30) or with none (0).
std::string read_label_table(gzFile file, const NiftiHeader& header, std::uint64_t voxels_at) {
  constexpr std::uint64_t kMostBytes = std::uint64_t{16} << 20;
  constexpr std::int32_t kLeastBytes = 16, kLargest = std::int32_t{1} << 20, kUnknown = 0, kCaret = 30;
  constexpr std::uint64_t kSizeAndKind = 8;
  std::array<unsigned char, kExtensionFlagBytes> flag{};
  std::uint64_t at = header.size();
  const auto read = [&](void* into, std::size_t bytes) {
    if (gzseek(file, static_cast<z_off_t>(at), SEEK_SET) < 0) return false;
    at += bytes;
    return gzread(file, into, static_cast<unsigned>(bytes)) == static_cast<int>(bytes);
  };
  if (!read(flag.data(), flag.size()) || flag[0] == 0) return {};
  while (at + kSizeAndKind < std::min(voxels_at, kMostBytes)) {
    std::array<unsigned char, kSizeAndKind> start{};
    if (!read(start.data(), start.size())) return {};
    const auto size = header.number_at<std::int32_t>(start.data()), kind = header.number_at<std::int32_t>(&start[4]);
    if (size < kLeastBytes || size > kLargest || at - kSizeAndKind + static_cast<std::uint64_t>(size) > voxels_at)
      return {};
    std::string text(static_cast<std::size_t>(size) - kSizeAndKind, '\0');
    if (!read(text.data(), text.size())) return {};
    if ((kind == kCaret || kind == kUnknown) && text.find("<LabelTable") != std::string::npos) return text;
  }
  return {};
}

}  // namespace

Result<ImageHeader> read_nifti_header(const InputFile& input) {
  const std::string where = input.path().string();
  std::array<unsigned char, kHeaderBytes2> bytes{};
  // gzread also reads uncompressed files.
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(input.pinned_path().c_str(), "rb"), gzclose);
  const int count = file ? gzread(file.get(), bytes.data(), bytes.size()) : -1;
  std::uint32_t header_size = 0;
  std::memcpy(&header_size, bytes.data(), sizeof header_size);
  const bool is_swapped = header_size != kHeaderBytes1 && header_size != kHeaderBytes2;
  if (is_swapped) header_size = __builtin_bswap32(header_size);
  const bool is_2 = header_size == kHeaderBytes2;
  const auto magic = std::string_view(reinterpret_cast<const char*>(bytes.data()) + (is_2 ? 4 : 344), 3);
  const bool has_header = (header_size == kHeaderBytes1 || is_2) && count >= static_cast<int>(header_size);
  if (has_header && magic == (is_2 ? "ni2" : "ni1"))
    return fail("is the header of a pair: its voxels are in another file (.img)", where,
                "convert the pair to one .nii file, header and voxels in one");
  if ((header_size != kHeaderBytes1 && !is_2) || count < static_cast<int>(header_size) ||
      magic != (is_2 ? "n+2" : "n+1"))
    return fail("not a NIfTI image", where, "give a .nii or .nii.gz file with header and voxels in one");

  const NiftiHeader header(bytes.data(), is_swapped, is_2);
  const auto type = voxel_type_of(header.type_code());
  if (!type)
    return fail(fmt::format("stores its voxels in the type {}, which is not one number a voxel", header.type_code()),
                where, "convert it to 16-bit integers");
  const std::size_t voxel_bytes = bytes_per_voxel(*type);
  if (header.bits_per_voxel() != static_cast<int>(8 * voxel_bytes))
    return fail(
        fmt::format("the header states {} bits a voxel for a type of {}", header.bits_per_voxel(), 8 * voxel_bytes),
        where, kExportAgain);
  const std::vector<std::int64_t> sizes = header.sizes();
  ImageHeader image;
  image.type = *type;
  image.is_swapped = is_swapped;
  TROCAR_TRY(image.payload.bytes, volume_bytes(sizes, voxel_bytes, where));
  image.geometry.size = sides(sizes);
  TROCAR_TRY_STATUS(read_place(header, where, image));
  TROCAR_TRY_STATUS(read_scaling(header, where, image));
  const double offset = header.voxel_offset();
  if (!(offset >= static_cast<double>(header.size() + kExtensionFlagBytes) && offset < 1e9) ||
      offset != std::floor(offset))
    return fail(fmt::format("the voxels cannot begin at byte {} (vox_offset)", offset), where, kExportAgain);
  image.label_table = read_label_table(file.get(), header, static_cast<std::uint64_t>(offset));
  // In a compressed file the header is part of the stream.
  image.payload.is_compressed = gzdirect(file.get()) == 0;
  if (image.payload.is_compressed) {
    image.payload.bytes += static_cast<std::uint64_t>(offset);
  } else {
    image.payload.offset = static_cast<std::uint64_t>(offset);
  }
  return image;
}

namespace {

template <std::size_t Size>
void swap_numbers(std::span<std::byte> bytes) {
  for (std::size_t at = 0; at + Size <= bytes.size(); at += Size) std::reverse(&bytes[at], &bytes[at] + Size);
}

void swap_bytes(std::span<std::byte> bytes, std::size_t number_bytes) {
  if (number_bytes == 2) swap_numbers<2>(bytes);
  if (number_bytes == 4) swap_numbers<4>(bytes);
  if (number_bytes == 8) swap_numbers<8>(bytes);
}

/// False: the stream ends before, or is damaged.
bool read_bytes(gzFile file, std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const std::size_t most = std::min<std::size_t>(bytes.size(), std::size_t{1} << 30);
    const int got = gzread(file, bytes.data(), static_cast<unsigned>(most));
    if (got <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
  return true;
}

/// The bytes behind the voxels, up to as many as the voxels have; none: the stream is damaged. zlib compares the check
/// sum when it reaches the end of the stream; a stream without an end is no error of gzread().
std::optional<std::uint64_t> bytes_behind(gzFile file, std::uint64_t voxel_bytes) {
  std::vector<std::byte> more(kChunkBytes);
  std::uint64_t behind = 0;
  while (behind <= voxel_bytes) {
    int status = Z_OK;
    const int got = gzread(file, more.data(), static_cast<unsigned>(more.size()));
    gzerror(file, &status);
    if (got < 0 || (status != Z_OK && status != Z_STREAM_END)) return std::nullopt;
    if (got == 0) break;
    behind += static_cast<std::uint64_t>(got);
  }
  return behind;
}

}  // namespace

Result<std::unique_ptr<std::byte[]>> read_nifti_voxels(const InputFile& input, const ImageHeader& header) {
  const std::string where = input.path().string();
  const Payload& payload = header.payload;
  const std::size_t number_bytes = bytes_per_voxel(header.type);
  const std::size_t count = header.geometry.voxel_count() * number_bytes;
  const std::uint64_t first = payload.is_compressed ? payload.bytes - count : payload.offset;
  const std::uint64_t available = input.size() > first ? input.size() - first : 0;
  if (!payload.is_compressed && available < count)
    return fail(fmt::format("the image ends before its last voxel ({} of {} bytes)", available, count), where,
                kExportAgain);
  const auto damaged = fail("the compressed voxels are damaged or end too early", where, kExportAgain);
  if (payload.is_compressed && !could_unpack_to(payload.bytes, input.size())) return damaged;
  TROCAR_TRY_STATUS(check_memory_for_image(count, available_memory_bytes(), where));
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(input.pinned_path().c_str(), "rb"), gzclose);
  if (!file) return fail("cannot be opened", where, kExportAgain);
  gzbuffer(file.get(), kChunkBytes);
  auto bytes = std::make_unique_for_overwrite<std::byte[]>(count);
  const std::span all(bytes.get(), count);
  if (gzseek(file.get(), static_cast<z_off_t>(first), SEEK_SET) < 0 || !read_bytes(file.get(), all)) return damaged;
  const auto behind = bytes_behind(file.get(), count);
  if (!behind) return damaged;
  if (is_far_more(count + *behind, count))
    return fail(fmt::format(kHoldsMore, count, count + *behind), where, kExportAgain);
  if (header.is_swapped) swap_bytes(all, number_bytes);
  return bytes;
}

}  // namespace trocar::io::detail
