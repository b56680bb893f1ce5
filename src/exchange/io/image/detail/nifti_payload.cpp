#include <fmt/format.h>
#include <itk_zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <memory>
#include <span>

#include "io/image/detail/header_payload.h"
#include "io/image/detail/raw_volume.h"

namespace trocar::io::detail {
namespace {

/// Fixed-offset fields of a NIfTI header in either byte order.
class NiftiHeader {
 public:
  NiftiHeader(const unsigned char* bytes, bool swap, bool is_version_2)
      : bytes_(bytes), swap_(swap), is_version_2_(is_version_2) {}

  std::vector<std::int64_t> sizes() const {
    const std::int64_t count = dim(0);
    std::vector<std::int64_t> sizes;
    for (std::int64_t axis = 1; axis <= std::min<std::int64_t>(count, 7); ++axis)
      sizes.push_back(dim(static_cast<std::size_t>(axis)));
    return sizes;
  }
  int bits_per_voxel() const { return get<std::int16_t>(is_version_2_ ? 14 : 72); }
  bool is_float() const {
    const auto code = get<std::int16_t>(is_version_2_ ? 12 : 70);
    return code == 16 || code == 64;  // NIFTI_TYPE_FLOAT32, NIFTI_TYPE_FLOAT64
  }
  bool is_swapped() const { return swap_; }
  double voxel_offset() const {
    return is_version_2_ ? static_cast<double>(get<std::int64_t>(168)) : static_cast<double>(get<float>(108));
  }
  bool has_qform() const { return (is_version_2_ ? get<std::int32_t>(344) : get<std::int16_t>(252)) > 0; }
  bool is_in_mm() const {
    const int length_unit = (is_version_2_ ? get<std::int32_t>(500) : get<std::uint8_t>(123)) & 7;
    return length_unit == 0 || length_unit == 2;  // NIFTI_UNITS_UNKNOWN, NIFTI_UNITS_MM
  }
  bool has_sform() const { return (is_version_2_ ? get<std::int32_t>(348) : get<std::int16_t>(254)) > 0; }
  Mat3 sform_axes() const {
    Mat3 axes;
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) {
        const auto n = static_cast<std::size_t>(4 * row + column);
        axes(row, column) = is_version_2_ ? get<double>(400 + 8 * n) : static_cast<double>(get<float>(280 + 4 * n));
      }
    return axes;
  }

 private:
  template <class T>
  T get(std::size_t offset) const {
    std::array<unsigned char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_ + offset, sizeof(T));
    if (swap_) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }
  std::int64_t dim(std::size_t n) const {
    return is_version_2_ ? get<std::int64_t>(16 + 8 * n) : get<std::int16_t>(40 + 2 * n);
  }

  const unsigned char* bytes_;
  bool swap_;
  bool is_version_2_;
};

/// The position of the voxels must be unambiguous: without qform and sform, ITK and other programs disagree about left
/// and right; ITK applies units other than mm to the spacing only, and replaces a sheared sform by the qform.
Status check_place(const NiftiHeader& header, const std::string& where) {
  if (!header.has_sform() && !header.has_qform())
    return fail("no orientation in the header (qform and sform codes are both 0)", where,
                "export it again with its orientation");
  if (!header.is_in_mm()) return fail("its spatial unit is not mm", where, "export it again in mm");
  if (!header.has_sform()) return {};
  const Mat3 axes = header.sform_axes();
  const Vec3 lengths = axes.colwise().norm().transpose();
  if (!axes.allFinite() || (lengths.array() <= 0.0).any())
    return fail("the header's sform gives no valid position", where, kExportAgain);
  volume::GridGeometry probe;
  probe.R_PV = axes * lengths.cwiseInverse().asDiagonal();
  if (auto status = tidy_geometry(probe); !status) return fail(status.error().what, where, status.error().advice);
  return {};
}

template <class Number>
bool has_only_finite(std::span<unsigned char> bytes, bool is_swapped) {
  for (std::size_t at = 0; at + sizeof(Number) <= bytes.size(); at += sizeof(Number)) {
    if (is_swapped) std::reverse(bytes.data() + at, bytes.data() + at + sizeof(Number));
    Number number;
    std::memcpy(&number, bytes.data() + at, sizeof number);
    if (!std::isfinite(number)) return false;
  }
  return true;
}

/// The NIfTI library silently reads NaN and infinity as 0: they are detected here.
Status check_finite(gzFile file, const NiftiHeader& header, std::uint64_t offset, std::uint64_t count,
                    const std::string& where) {
  if (!header.is_float() || gzseek(file, static_cast<z_off_t>(offset), SEEK_SET) < 0) return {};
  std::vector<unsigned char> chunk(kChunkBytes);
  while (count > 0) {
    const int got = gzread(file, chunk.data(), static_cast<unsigned>(std::min<std::uint64_t>(count, chunk.size())));
    if (got <= 0) return {};  // check_payload() reports a short file.
    count -= static_cast<std::uint64_t>(got);
    const std::span bytes(chunk.data(), static_cast<std::size_t>(got));
    if (!(header.bits_per_voxel() == 32 ? has_only_finite<float>(bytes, header.is_swapped())
                                        : has_only_finite<double>(bytes, header.is_swapped())))
      return fail("the image contains a voxel that is not a number", where, "export it again without NaN");
  }
  return {};
}

}  // namespace

Result<Payload> nifti_payload(const InputFile& input) {
  const std::string where = input.path().string();
  std::array<unsigned char, 540> bytes{};
  // gzread also reads uncompressed files.
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(input.pinned_path().c_str(), "rb"), gzclose);
  const int count = file ? gzread(file.get(), bytes.data(), bytes.size()) : -1;
  std::int32_t header_size = 0;
  std::memcpy(&header_size, bytes.data(), sizeof header_size);
  const auto swapped = static_cast<std::int32_t>(__builtin_bswap32(static_cast<std::uint32_t>(header_size)));
  const bool is_1 = header_size == 348 || swapped == 348;
  const bool is_2 = header_size == 540 || swapped == 540;
  const auto magic = std::string_view(reinterpret_cast<const char*>(bytes.data()) + (is_2 ? 4 : 344), 3);
  if (count < 348 || (is_2 && count < 540) || !(is_1 || is_2) || (magic != "n+1" && magic != "n+2"))
    return fail("not a NIfTI image", where, "give a .nii or .nii.gz file with header and voxels in one");

  const NiftiHeader header(bytes.data(), header_size != 348 && header_size != 540, is_2);
  const int bits = header.bits_per_voxel();
  if (bits < 8 || bits > 128 || bits % 8 != 0)
    return fail(fmt::format("stores voxels of {} bits", bits), where, "convert it to 16-bit integers");
  TROCAR_TRY(const std::uint64_t voxels, volume_bytes(header.sizes(), static_cast<std::uint64_t>(bits / 8), where));
  TROCAR_TRY_STATUS(check_place(header, where));
  const double offset = header.voxel_offset();
  if (!(offset >= 0.0 && offset < 1e9)) return fail("the NIfTI header is damaged", where, kExportAgain);

  // In a compressed file the header is part of the stream.
  const bool is_compressed = gzdirect(file.get()) == 0;
  const auto skipped = static_cast<std::uint64_t>(std::max(offset, static_cast<double>(is_2 ? 540 : 348)));
  TROCAR_TRY_STATUS(check_finite(file.get(), header, skipped, voxels, where));
  if (is_compressed) return Payload{.bytes = voxels + skipped, .is_compressed = true};
  return Payload{.offset = skipped, .bytes = voxels};
}

}  // namespace trocar::io::detail
