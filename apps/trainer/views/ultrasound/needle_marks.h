#pragma once

#include <QPainter>
#include <optional>
#include <span>

#include "geometry/shapes.h"
#include "ultrasound/live/scan_picture.h"
#include "views/ultrasound/ultrasound_layout.h"

namespace trocar::trainer {

/// Dots along a line in the image, with a longer one per centimetre.
void draw_guide(QPainter& painter, const PictureMap& map, std::span<const ultrasound::Vec2> line_T);
/// Draws the part of a needle's axis near the plane and ahead of the tip (dotted) and its intersection with the plane
/// (cross).
void draw_needle_axis(QPainter& painter, const PictureMap& map, const ultrasound::ScanPicture& picture,
                      std::span<const Vec3> shaft_P);
/// Draws the part near the plane of a stylet's way when fired (dashed, with a bar at its end) and of the notch's part
/// of it (thick). Frame P.
void draw_throw(QPainter& painter, const PictureMap& map, const ultrasound::ScanPicture& picture,
                const Segment& throw_P, const std::optional<Segment>& notch_P);

/// Needle and throw are drawn within this distance of the plane: about half the beam's thickness.
inline constexpr double kNearPlane_mm = 3.0;

}  // namespace trocar::trainer
