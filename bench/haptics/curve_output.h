#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cases/force_curve.h"
#include "core/result.h"

namespace trocar::bench {

/// One of the compared curves: the curve of a force model or of a patient.
struct NamedCurve {
  std::string name;  ///< "proxy".
  std::vector<cases::CurvePoint> points;
  std::vector<cases::CurveEvent> events;
};

/// One path with its curves: the same motion for each.
struct PathCurves {
  std::string name;   ///< "lumbar": name in files and cases.
  std::string title;  ///< Patient, needle, speed: title of the plot.
  std::vector<cases::PathPiece> pieces;
  std::vector<NamedCurve> curves;
};

/// The curves side by side as text: a row of bars every few millimetres of depth, with the largest force in that row.
/// An asterisk marks a row with a puncture of a layer.
std::string curves_text(const PathCurves& path);

/// Writes NAME.csv with one row per tick and NAME.svg with the curves over the layers. The folder must exist.
Status write_curves(const PathCurves& path, const anatomy::TissueTable& tissues, const std::filesystem::path& folder);

}  // namespace trocar::bench
