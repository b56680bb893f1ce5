#include "slices/window_level.h"

#include <cmath>

#include "core/check.h"

namespace trocar::slices {

std::string_view window_name(const Window& window) noexcept {
  constexpr double kSame_hu = 0.5;
  for (const WindowPreset& preset : kWindowPresets)
    if (std::abs(preset.window.center_hu - window.center_hu) < kSame_hu &&
        std::abs(preset.window.width_hu - window.width_hu) < kSame_hu)
      return preset.name;
  return {};
}

void apply_window(std::span<const float> hu, const Window& window, std::span<std::uint8_t> gray) {
  TROCAR_CHECK(hu.size() == gray.size() && window.width_hu > 0.0);
  const auto steps_per_hu = static_cast<float>(255.0 / window.width_hu);
  const auto center_hu = static_cast<float>(window.center_hu);
  constexpr float kMiddle = 127.5F + 0.5F;  // 0.5 for rounding
  for (std::size_t n = 0; n < hu.size(); ++n) {
    const float step = (hu[n] - center_hu) * steps_per_hu + kMiddle;
    const float positive = step > 0.0F ? step : 0.0F;  // also NaN
    gray[n] = static_cast<std::uint8_t>(static_cast<int>(positive < 255.0F ? positive : 255.0F));
  }
}

}  // namespace trocar::slices
