#pragma once

#include <string_view>

namespace trocar::io::detail {

/// True if ITK itself adds an entry of this key to the fields of an image.
inline bool is_library_field(std::string_view key) noexcept {
  return key.starts_with("NRRD_") || key.starts_with("ITK_");
}

}  // namespace trocar::io::detail
