#pragma once

#include <itkImageIOBase.h>

#include "io/image/detail/payload.h"

namespace trocar::io::detail {

/// ITK's reader and writer of a file format. This function and those below may throw ITK exceptions.
itk::ImageIOBase::Pointer make_image_io(ImageFormat format);

/// Selects the whole image as the region to read or write.
void take_whole_region(itk::ImageIOBase& io);

}  // namespace trocar::io::detail
