#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cases/force_curve.h"
#include "core/result.h"

namespace trocar::bench {

/// One of the curves that are held against each other: of a force model, or of a patient.
struct NamedCurve {
  std::string name;  ///< "proxy".
  std::vector<cases::CurvePoint> points;
  std::vector<cases::CurveEvent> events;
};

/// One path with its curves: the same motion for each.
struct PathCurves {
  std::string name;   ///< "lumbar": of files and cases.
  std::string title;  ///< Patient, needle, speed: above the plot.
  std::vector<cases::PathPiece> pieces;
  std::vector<NamedCurve> curves;
};

/// The curves side by side, a row of bars every few millimetres of depth: the largest force in that row. An asterisk
/// marks a row in which a layer gave way.
std::string curves_text(const PathCurves& path);

/// NAME.csv: a row a tick, NAME.svg: the curves over the layers. The folder is there.
Status write_curves(const PathCurves& path, const anatomy::TissueTable& tissues, const std::filesystem::path& folder);

}  // namespace trocar::bench
