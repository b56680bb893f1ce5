#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/result.h"
#include "core/text.h"
#include "io/image/detail/payload.h"

namespace trocar::io::detail {

/// Key and value texts of a header.
using TextFields = std::vector<std::pair<std::string, std::string>>;

/// A 3D image from ITK, LPS mm. Plain data: ITK bundles another Eigen that must not be mixed with ours, so code that
/// includes ITK headers does not include Eigen.
struct ItkImage {
  std::array<std::int64_t, 3> size{};
  std::array<double, 3> spacing_mm{};
  std::array<double, 3> origin_P{};
  std::array<std::array<double, 3>, 3> axes_P{};  ///< Directions of i, j, k.
  VoxelType type = VoxelType::kUInt8;
  int components = 1;  ///< Numbers per voxel, running fastest.
  std::unique_ptr<std::byte[]> bytes;
  TextFields fields;  ///< NRRD only.
};

/// Reads through ITK; never throws, prints nothing.
Result<ItkImage> read_with_itk(const CheckedImage& checked, ImageFormat format);

/// Reads only the fields of the header, including those added by ITK ("NRRD_...", "ITK_...").
Result<TextFields> read_fields_with_itk(const CheckedImage& checked, ImageFormat format);

enum class Packing { kCompressed, kPlain };

/// Writes one number per voxel (int16, uint8 or float) through ITK, compressed if requested and supported by the
/// format. The libraries do not always report a full disk: check the file afterwards.
Status write_with_itk(const ItkImage& image, std::span<const std::byte> bytes, const std::filesystem::path& path,
                      ImageFormat format, Packing packing);

/// Around every call of ITK: stops ITK and its NIfTI library from writing to the terminal (a defect of a file is
/// reported once, by our error), and keeps the numbers of its text headers free of the user's locale. Cheap.
/// Thread-safe.
class ItkCall {
 public:
  ItkCall();

 private:
  DecimalPoint decimal_point_;
};

/// Discards standard error of the whole process during the lifetime of this object. The JPEG codecs of GDCM print
/// there, even for valid 12-bit files, as do MetaIO and VNL for damaged headers, and have no option to disable it. Use
/// it only around such calls of milliseconds. Thread-safe.
class MutedStandardError {
 public:
  MutedStandardError();
  ~MutedStandardError();
  MutedStandardError(const MutedStandardError&) = delete;
  MutedStandardError& operator=(const MutedStandardError&) = delete;
};

}  // namespace trocar::io::detail
