#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace trocar::volume {

using Rgb = std::array<std::uint8_t, 3>;

/// An image, row by row from the top left.
struct RgbImage {
  int columns = 0;
  int rows = 0;
  std::vector<Rgb> pixels;

  RgbImage() = default;
  RgbImage(int c, int r, Rgb fill = {0, 0, 0})
      : columns(c), rows(r), pixels(static_cast<std::size_t>(c) * static_cast<std::size_t>(r), fill) {}
  Rgb& at(int column, int row) noexcept {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
  const Rgb& at(int column, int row) const noexcept {
    return pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
};

}  // namespace trocar::volume
