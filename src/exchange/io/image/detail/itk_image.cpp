#include "io/image/detail/itk_image.h"

#include <fcntl.h>
#include <itkMetaDataObject.h>
#include <itkObject.h>
#include <nifti1_io.h>
#include <unistd.h>

#include <cstdio>
#include <mutex>
#include <optional>

#include "core/available_memory.h"
#include "io/image/detail/itk_format.h"

namespace trocar::io::detail {
namespace {

std::optional<VoxelType> find_voxel_type(itk::IOComponentEnum type) {
  using Type = itk::IOComponentEnum;
  switch (type) {
    case Type::UCHAR:
      return VoxelType::kUInt8;
    case Type::CHAR:
      return VoxelType::kInt8;
    case Type::USHORT:
      return VoxelType::kUInt16;
    case Type::SHORT:
      return VoxelType::kInt16;
    case Type::UINT:
      return VoxelType::kUInt32;
    case Type::INT:
      return VoxelType::kInt32;
    case Type::ULONG:
    case Type::ULONGLONG:
      return VoxelType::kUInt64;
    case Type::LONG:
    case Type::LONGLONG:
      return VoxelType::kInt64;
    case Type::FLOAT:
      return VoxelType::kFloat;
    case Type::DOUBLE:
      return VoxelType::kDouble;
    default:
      return std::nullopt;
  }
}

void take_geometry(const itk::ImageIOBase& io, ItkImage& image) {
  for (unsigned axis = 0; axis < 3; ++axis) {
    image.size[axis] = static_cast<std::int64_t>(io.GetDimensions(axis));
    image.spacing_mm[axis] = io.GetSpacing(axis);
    image.origin_P[axis] = io.GetOrigin(axis);
    const std::vector<double> direction = io.GetDirection(axis);
    for (unsigned row = 0; row < 3; ++row) image.axes_P[axis][row] = direction[row];
  }
}

TextFields text_fields(const itk::ImageIOBase& io) {
  TextFields fields;
  const itk::MetaDataDictionary& dictionary = io.GetMetaDataDictionary();
  for (const std::string& key : dictionary.GetKeys())
    if (std::string value; itk::ExposeMetaData<std::string>(dictionary, key, value)) fields.emplace_back(key, value);
  return fields;
}

/// MetaIO and VNL print what they find.
void read_header(itk::ImageIOBase& io) {
  const MutedStandardError muted;
  io.ReadImageInformation();
}

/// May throw exceptions of ITK.
Result<ItkImage> read_image_throwing(itk::ImageIOBase& io, const CheckedImage& checked, ImageFormat format) {
  const std::string where = checked.file.path().string();
  io.SetFileName(checked.library_path.string());
  read_header(io);
  if (io.GetNumberOfDimensions() < 3) return fail("not a 3D image", where, "give a volume, not a picture");
  for (unsigned axis = 3; axis < io.GetNumberOfDimensions(); ++axis)
    if (io.GetDimensions(axis) > 1) return fail("is a 4D image", where, "extract one volume and give that");
  const auto type = find_voxel_type(io.GetComponentType());
  if (!type) return fail("stores its voxels in an unknown type", where, "convert it to 16-bit integers");

  ItkImage image;
  take_geometry(io, image);
  image.type = *type;
  image.components = static_cast<int>(io.GetNumberOfComponents());
  image.fields = text_fields(io);
  take_whole_region(io);
  const auto bytes = static_cast<std::size_t>(io.GetImageSizeInBytes());
  TROCAR_TRY_STATUS(check_memory_for_image(bytes, available_memory_bytes(), where));
  image.bytes = std::make_unique_for_overwrite<std::byte[]>(bytes);
  std::optional<MutedStandardError> muted;
  if (format == ImageFormat::kMeta) muted.emplace();
  io.Read(image.bytes.get());
  return image;
}

}  // namespace

Result<ItkImage> read_with_itk(const CheckedImage& checked, ImageFormat format) {
  const std::string where = checked.file.path().string();
  const ItkCall call;
  try {
    return read_image_throwing(*make_image_io(format), checked, format);
  } catch (const std::bad_alloc&) {
    return fail("not enough memory to read the image", where, "close other programs or crop the image");
  } catch (const std::exception&) {
    // ITK's own messages contain source file names and line numbers.
    return fail("cannot be read as an image", where, "open it in 3D Slicer and save it as .nrrd");
  }
}

Result<TextFields> read_fields_with_itk(const CheckedImage& checked, ImageFormat format) {
  const ItkCall call;
  try {
    const auto io = make_image_io(format);
    io->SetFileName(checked.library_path.string());
    read_header(*io);
    return text_fields(*io);
  } catch (const std::exception&) {
    return fail("the header cannot be read", checked.file.path().string(), "open it in 3D Slicer and save it as .nrrd");
  }
}

namespace {

/// The original standard error, while at least one MutedStandardError exists.
struct Muting {
  std::mutex mutex;
  int count = 0;
  int saved = -1;
};

Muting& muting() {
  static Muting shared;
  return shared;
}

}  // namespace

ItkCall::ItkCall() {
  static std::once_flag once;
  std::call_once(once, [] {
    itk::Object::SetGlobalWarningDisplay(false);
    nifti_set_debug_level(0);
  });
}

MutedStandardError::MutedStandardError() {
  Muting& shared = muting();
  const std::lock_guard lock(shared.mutex);
  if (shared.count++ > 0) return;
  std::fflush(stderr);
  shared.saved = ::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 3);
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (shared.saved >= 0 && nowhere >= 0) ::dup2(nowhere, STDERR_FILENO);
  if (nowhere >= 0) ::close(nowhere);
}

MutedStandardError::~MutedStandardError() {
  Muting& shared = muting();
  const std::lock_guard lock(shared.mutex);
  if (--shared.count > 0 || shared.saved < 0) return;
  std::fflush(stderr);
  ::dup2(shared.saved, STDERR_FILENO);
  ::close(shared.saved);
  shared.saved = -1;
}

}  // namespace trocar::io::detail
