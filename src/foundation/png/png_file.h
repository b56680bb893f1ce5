#pragma once

#include <filesystem>
#include <string>

#include "core/result.h"
#include "image/image.h"

namespace trocar::png {

/// Encodes an image as PNG.
std::string encode_png(const image::RgbImage& image);
Status write_png(const image::RgbImage& image, const std::filesystem::path& path);

}  // namespace trocar::png
