#pragma once

#include <optional>

#include "ultrasound/doppler/doppler_settings.h"

namespace trocar::trainer {

/// Part of a colour box that the user drags.
enum class BoxPart { kWhole, kFirst, kLast, kNear, kFar };

/// Position in the image plane in the units of the box: shares of width (scanlines) and depth.
ultrasound::Vec2 box_place(const ultrasound::ScanGeometry& scan, const ultrasound::Vec2& p_T) noexcept;
/// An edge near the position, the whole box from inside it, or empty.
std::optional<BoxPart> find_box_part(const ultrasound::DopplerBox& box, const ultrasound::Vec2& place) noexcept;
/// The box with that part moved by `by`, limited to the image and to a width and height of at least kLeastBox.
ultrasound::DopplerBox moved_box(const ultrasound::DopplerBox& box, BoxPart part, const ultrasound::Vec2& by) noexcept;
inline constexpr double kLeastBox = 0.08;

}  // namespace trocar::trainer
