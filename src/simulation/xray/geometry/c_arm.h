#pragma once

#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include "core/result.h"
#include "geometry/pose.h"

namespace trocar::xray {

/// Position and optics of a C-arm (docs/physics.md, X1). Angles 0, 0: the detector is in front of the patient
/// (anterior), the source behind. All lengths in mm at their place, unless stated.
struct CArm {
  double lao_deg = 0.0;                ///< Detector towards the patient's left, right (RAO) negative. Range -180..180.
  double cranial_deg = 0.0;            ///< Detector towards the head, feet (caudal) negative. Range -90..90.
  Vec3 isocentre_P = Vec3::Zero();     ///< The point that stays in the middle of the image.
  double source_isocentre_mm = 700.0;  ///< Range 300..1500.
  double source_detector_mm = 1100.0;  ///< Range 400..2000, greater than source_isocentre_mm + 50.
  double field_mm = 300.0;  ///< Edge of the square part of the detector that is read (magnification). 50..500.
  int pixels = 512;         ///< Along each edge. Range 16..2048.
  /// Collimation: the irradiated share of the field, about its middle, along the columns and the rows. Range 0.05..1.
  std::array<double, 2> collimation{1.0, 1.0};

  bool operator==(const CArm&) const = default;
};

/// One clear line if a value is out of its range.
Status check_c_arm(const CArm& arm);

/// Rays of a C-arm: from the source to the middles of the pixels. Pixel (0, 0) is the upper left one of the image as it
/// is shown: seen from the detector's side (a viewer before the patient), the head up.
struct XrayRays {
  Vec3 source_P = Vec3::Zero();
  Vec3 first_pixel_P = Vec3::Zero();  ///< Middle of pixel (0, 0).
  Vec3 column_P = Vec3::UnitX();      ///< From a pixel to the next one of its row.
  Vec3 row_P = -Vec3::UnitZ();        ///< From a pixel to the next one of its column.
  int columns = 0, rows = 0;

  Vec3 pixel_P(double column, double row) const noexcept { return first_pixel_P + column * column_P + row * row_P; }
  /// Pixel (column, row), not rounded, on which a point falls; not finite for points beside or behind the source.
  std::array<double, 2> project(const Vec3& p_P) const noexcept;
};
XrayRays rays_of(const CArm& arm) noexcept;

/// Unit vector from the isocentre to the detector, in P.
Vec3 towards_detector_P(const CArm& arm) noexcept;

/// Magnification of objects at the isocentre.
double magnification(const CArm& arm) noexcept;

/// An X-ray unit: a row of data/carms.toml.
struct CArmPreset {
  std::string name, title;
  CArm arm;                       ///< Angles 0, the largest field.
  std::vector<double> fields_mm;  ///< Edges of the fields that it offers, falling.
  double largest_lao_deg = 90.0;  ///< Reach to the left and to the right.
  double largest_cranial_deg = 45.0;
  double kv = 80.0, aluminium_mm = 3.0, copper_mm = 0.1;  ///< Tube (xray/physics/beam.h).
  double detector_mm = 0.6;                               ///< Caesium iodide (beam.h).
};

/// All units, in the file's order. Errors name the line: a number out of range, an arm that check_c_arm refuses.
Result<std::vector<CArmPreset>> load_c_arms(const std::filesystem::path& file);
/// The unit with this name. Error (exit status 2): no such unit; the advice lists them.
Result<CArmPreset> load_c_arm(const std::filesystem::path& file, std::string_view name);

}  // namespace trocar::xray
