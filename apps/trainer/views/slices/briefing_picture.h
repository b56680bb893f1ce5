#pragma once

#include <QImage>
#include <QSize>

#include "cases/open_case.h"
#include "scene/guidance.h"

namespace trocar::trainer {

enum class BriefingPlane { kAxial, kSagittal, kAlongPath };

/// A slice through the target with labels, and as much of the planned path as is to be shown: a ring at its end, where
/// the tip is put; without a path at the target itself, which every attempt tells.
QImage briefing_picture(const cases::OpenCase& open, BriefingPlane plane, const QSize& size, scene::Guidance guidance);

/// A picture of ours as Qt's, copied.
QImage to_qimage(const volume::RgbImage& picture);

}  // namespace trocar::trainer
