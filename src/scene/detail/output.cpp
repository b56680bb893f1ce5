#include "scene/detail/output.h"

#include <vtkRenderWindow.h>

#include <algorithm>
#include <array>

namespace trocar::detail {

int to_vtk(StereoMode mode) {
  switch (mode) {
    case StereoMode::kQuadBuffer:
      return VTK_STEREO_CRYSTAL_EYES;
    case StereoMode::kAnaglyph:
      return VTK_STEREO_ANAGLYPH;
    case StereoMode::kSideBySide:
      return VTK_STEREO_SPLITVIEWPORT_HORIZONTAL;
    case StereoMode::kInterlaced:
      return VTK_STEREO_INTERLACED;
    case StereoMode::kOff:
      break;
  }
  return VTK_STEREO_CRYSTAL_EYES;
}

RgbImage mirrored(const RgbImage& image, bool left_right, bool up_down) {
  if (!left_right && !up_down) return image;
  RgbImage result(image.columns, image.rows);
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.columns; ++column) {
      result.at(left_right ? image.columns - 1 - column : column, up_down ? image.rows - 1 - row : row) =
          image.at(column, row);
    }
  }
  return result;
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

bool is_by_processor(std::string_view renderer_name) {
  constexpr std::array<std::string_view, 5> kPrograms = {"llvmpipe", "softpipe", "swrast", "SWR", "Software"};
  return std::any_of(kPrograms.begin(), kPrograms.end(),
                     [&](std::string_view program) { return renderer_name.find(program) != std::string_view::npos; });
}

}  // namespace trocar::detail
