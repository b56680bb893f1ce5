#pragma once

#include <QImage>
#include <QSize>

#include "station/open_case.h"

namespace trocar::trainer {

enum class BriefingPlane { kAxial, kAlongPath };

/// A slice through the target with labels, and the planned path over it where it is to be shown.
QImage briefing_picture(const OpenCase& open, BriefingPlane plane, const QSize& size, bool has_path);

/// A picture of ours as Qt's, copied.
QImage to_qimage(const RgbImage& picture);

}  // namespace trocar::trainer
