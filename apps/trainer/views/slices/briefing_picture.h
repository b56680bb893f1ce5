#pragma once

#include <QImage>
#include <QSize>

#include "cases/open_case.h"
#include "scene/guidance.h"

namespace trocar::trainer {

enum class BriefingPlane { kAxial, kSagittal, kAlongPath };

/// A slice through the target with labels and the planned path, as far as `guidance` shows it. A ring marks the end of
/// the path, the goal of the tip; without a path it marks the target, which every attempt shows.
QImage briefing_picture(const cases::OpenCase& open, BriefingPlane plane, const QSize& size, scene::Guidance guidance);

/// Converts to a Qt image; copies the pixels.
QImage to_qimage(const volume::RgbImage& picture);

}  // namespace trocar::trainer
