#include "scene/detail/output.h"

#include <vtkNew.h>
#include <vtkRenderWindow.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <array>

#include "core/check.h"

namespace trocar::scene::detail {

int to_vtk(StereoMode mode, Eye eye) {
  switch (mode) {
    case StereoMode::kQuadBuffer:
      return eye == Eye::kLeft ? VTK_STEREO_LEFT : VTK_STEREO_RIGHT;
    case StereoMode::kAnaglyph:
      return VTK_STEREO_ANAGLYPH;
    case StereoMode::kSideBySide:
      return VTK_STEREO_SPLITVIEWPORT_HORIZONTAL;
    case StereoMode::kInterlaced:
      return VTK_STEREO_INTERLACED;
    case StereoMode::kOff:
      break;
  }
  return VTK_STEREO_LEFT;
}

void copy_picture(vtkRenderWindow& window, std::span<std::uint32_t> pixels) {
  const int columns = window.GetSize()[0];
  const int rows = window.GetSize()[1];
  TROCAR_CHECK(pixels.size() == static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  vtkNew<vtkUnsignedCharArray> bytes;
  window.GetRGBACharPixelData(0, 0, columns - 1, rows - 1, 0, bytes);
  const std::uint8_t* rgba = bytes->GetPointer(0);
  for (int row = rows - 1; row >= 0; --row) {  // OpenGL starts at the bottom
    std::uint32_t* pixel = pixels.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(columns);
    for (int column = 0; column < columns; ++column, rgba += 4)
      pixel[column] = 0xff000000U | std::uint32_t{rgba[0]} << 16 | std::uint32_t{rgba[1]} << 8 | rgba[2];
  }
}

void mirror(std::span<std::uint32_t> pixels, int columns, bool left_right, bool up_down) {
  if (left_right) {
    for (std::size_t first = 0; first < pixels.size(); first += static_cast<std::size_t>(columns))
      std::reverse(pixels.begin() + static_cast<std::ptrdiff_t>(first),
                   pixels.begin() + static_cast<std::ptrdiff_t>(first) + columns);
  }
  if (!up_down) return;
  for (auto top = pixels.begin(), bottom = pixels.end() - columns; top < bottom; top += columns, bottom -= columns)
    std::swap_ranges(top, top + columns, bottom);
}

std::string renderer_of(vtkRenderWindow& window) {
  constexpr std::string_view kKey = "OpenGL renderer string:";
  const char* report = window.ReportCapabilities();
  const std::string text = report == nullptr ? "" : report;
  const auto at = text.find(kKey);
  if (at == std::string::npos) return {};
  const auto first = text.find_first_not_of(' ', at + kKey.size());
  return first == std::string::npos ? std::string() : text.substr(first, text.find('\n', first) - first);
}

bool is_software_renderer(std::string_view renderer_name) {
  constexpr std::array<std::string_view, 5> kPrograms = {"llvmpipe", "softpipe", "swrast", "SWR", "Software"};
  return std::any_of(kPrograms.begin(), kPrograms.end(),
                     [&](std::string_view program) { return renderer_name.find(program) != std::string_view::npos; });
}

}  // namespace trocar::scene::detail
