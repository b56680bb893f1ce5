#pragma once

#include <QColor>
#include <QImage>
#include <QSize>
#include <QString>
#include <vector>

#include "anatomy/patient.h"
#include "cases/open_case.h"
#include "scene/scene_options.h"

namespace trocar::trainer {

enum class BriefingPlane { kAxial, kSagittal, kAlongPath };

/// A slice through the target with labels, orientation letters, a scale bar and the planned path, as far as `guidance`
/// shows it. A ring marks the end of
/// the path, the goal of the tip; without a path it marks the target, which every attempt shows.
QImage briefing_picture(const cases::OpenCase& open, BriefingPlane plane, const QSize& size, scene::Guidance guidance);

/// A colour of a slice and the structures that have it.
struct LegendEntry {
  QColor color;
  QString words;           ///< "liver"; the tissue where several structures share the colour: "bone".
  double share = 0.0;      ///< Of the picture's area.
  bool is_target = false;  ///< A target of the task is among them.
  QString largest;         ///< The structure of this colour with the largest area, and its share.
  double largest_share = 0.0;
};
/// The colours of the labels in a slice, the largest area first. Labels below 1/1000 of the area are left out.
std::vector<LegendEntry> briefing_legend(const cases::OpenCase& open, BriefingPlane plane, const QSize& size,
                                         scene::Guidance guidance);

/// Two colours of one tissue ("vessel") get the name of their largest structure: "portal vein and others".
void tell_apart(std::vector<LegendEntry>& entries);

/// Converts to a Qt image; copies the pixels.
QImage to_qimage(const image::RgbImage& picture);

}  // namespace trocar::trainer
