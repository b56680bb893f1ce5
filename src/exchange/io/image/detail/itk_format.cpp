#include "io/image/detail/itk_format.h"

#include <itkMetaImageIO.h>
#include <itkNiftiImageIO.h>
#include <itkNrrdImageIO.h>

namespace trocar::io::detail {

itk::ImageIOBase::Pointer make_image_io(ImageFormat format) {
  switch (format) {
    case ImageFormat::kNifti:
      return itk::NiftiImageIO::New().GetPointer();
    case ImageFormat::kNrrd:
      return itk::NrrdImageIO::New().GetPointer();
    case ImageFormat::kMeta:
      break;
  }
  return itk::MetaImageIO::New().GetPointer();
}

void take_whole_region(itk::ImageIOBase& io) {
  itk::ImageIORegion region(io.GetNumberOfDimensions());
  for (unsigned axis = 0; axis < io.GetNumberOfDimensions(); ++axis) {
    region.SetIndex(axis, 0);
    region.SetSize(axis, io.GetDimensions(axis));
  }
  io.SetIORegion(region);
}

}  // namespace trocar::io::detail
