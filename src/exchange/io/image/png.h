#pragma once

#include <filesystem>
#include <string>

#include "core/result.h"
#include "volume/image.h"

namespace trocar {

/// The picture as PNG bytes.
std::string encode_png(const RgbImage& image);
Status write_png(const RgbImage& image, const std::filesystem::path& path);

}  // namespace trocar
