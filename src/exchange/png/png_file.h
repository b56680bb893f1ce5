#pragma once

#include <filesystem>
#include <string>

#include "core/result.h"
#include "volume/image.h"

namespace trocar::png {

/// Encodes an image as PNG.
std::string encode_png(const volume::RgbImage& image);
Status write_png(const volume::RgbImage& image, const std::filesystem::path& path);

}  // namespace trocar::png
