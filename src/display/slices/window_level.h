#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace trocar::slices {

/// Gray values of CT: black at centre - width/2, white at centre + width/2. Width > 0.
struct Window {
  double center_hu = 40.0;
  double width_hu = 400.0;

  bool operator==(const Window&) const = default;
};

struct WindowPreset {
  std::string_view name;
  Window window;
};
/// The windows of keys and menus, in this order. Sources: abdomen, lung, bone and spine as in Radiopaedia, "Windowing
/// (CT)" (abdomen 350..400 / 20..60, lung 1500 / -600, bone 1800 / 400, soft tissue of the spine 250 / 50, width /
/// centre). Liver assumed: narrow (Radiopaedia: 150 HU wide), centred such that both the plain (about 60 HU) and the
/// contrasted liver (about 100 HU) are gray.
inline constexpr std::array<WindowPreset, 5> kWindowPresets{{{"Abdomen", {40.0, 400.0}},
                                                             {"Liver", {60.0, 160.0}},
                                                             {"Lung", {-600.0, 1500.0}},
                                                             {"Bone", {400.0, 1800.0}},
                                                             {"Spine", {50.0, 250.0}}}};
/// Name of the preset that equals a window (within half a HU); empty for any other window.
std::string_view window_name(const Window& window) noexcept;

/// Gray of HU, rounded to the nearest step; 0 for NaN. `gray` has the length of `hu` (checked).
void apply_window(std::span<const float> hu, const Window& window, std::span<std::uint8_t> gray);

}  // namespace trocar::slices
