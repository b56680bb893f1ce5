#pragma once

#include <optional>

#include "ultrasound/doppler/doppler_settings.h"

namespace trocar::trainer {

/// What of a colour box a hand takes hold of.
enum class BoxPart { kWhole, kFirst, kLast, kNear, kFar };

/// Share of width (scanlines) and depth of a place in the image plane, as the box counts.
ultrasound::Vec2 box_place(const ultrasound::ScanGeometry& scan, const ultrasound::Vec2& p_T) noexcept;
/// An edge near the place, the whole from within, or nothing.
std::optional<BoxPart> find_box_part(const ultrasound::DopplerBox& box, const ultrasound::Vec2& place) noexcept;
/// The box with that part moved by so much; it stays within the picture and at least kLeastBox wide and high.
ultrasound::DopplerBox moved_box(const ultrasound::DopplerBox& box, BoxPart part, const ultrasound::Vec2& by) noexcept;
inline constexpr double kLeastBox = 0.08;

}  // namespace trocar::trainer
