#pragma once

#include <QImage>
#include <QSize>

#include "scene/guidance.h"
#include "attempt/case/open_case.h"

namespace trocar::trainer {

enum class BriefingPlane { kAxial, kSagittal, kAlongPath };

/// A slice through the target with labels, and as much of the planned path as is to be shown: a ring at its end, where
/// the tip is put; without a path at the target itself, which every attempt tells.
QImage briefing_picture(const OpenCase& open, BriefingPlane plane, const QSize& size, Guidance guidance);

/// A picture of ours as Qt's, copied.
QImage to_qimage(const RgbImage& picture);

}  // namespace trocar::trainer
