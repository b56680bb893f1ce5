#include "png/png_file.h"

#include <png.h>

#include "core/files/output_file.h"
#include "core/result.h"

namespace trocar::png {

std::string encode_png(const image::RgbImage& image) {
  TROCAR_CHECK(image.columns > 0 && image.rows > 0);
  TROCAR_CHECK(image.pixels.size() == static_cast<std::size_t>(image.columns) * static_cast<std::size_t>(image.rows));
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.columns);
  png.height = static_cast<png_uint_32>(image.rows);
  png.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::string bytes(size, '\0');
  const int done = png_image_write_to_memory(&png, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr);
  TROCAR_CHECK(done != 0);  // Only a wrong size or lack of memory could fail.
  bytes.resize(size);
  return bytes;
}

Status write_png(const image::RgbImage& image, const std::filesystem::path& path) {
  return write_file_atomically(path, encode_png(image));
}

}  // namespace trocar::png
