#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/result.h"

namespace trocar::ultrasound {

enum class TransducerKind {
  kConvex,            ///< Elements on an arc, scanlines along its radii.
  kLinear,            ///< Elements on a line, parallel scanlines.
  kPhased,            ///< A small face, scanlines steered from its middle.
  kMechanicalConvex,  ///< A convex array that a motor swings in elevation (3D sweep).
};

/// A transducer (data/transducers.toml). Frame T: x lateral, y away from the array, z = x × y elevation, origin at the
/// array's centre.
struct Transducer {
  std::string name;  ///< "C5-2".
  std::string description;
  TransducerKind kind = TransducerKind::kConvex;
  double frequency_mhz = 3.5;  ///< Centre frequency of the transmitted pulse. Range 1..20.
  double lowest_mhz = 2.0;
  double highest_mhz = 5.0;
  double bandwidth = 0.6;               ///< Fractional, -6 dB, of the pulse and its echo. Range 0.2..1.2.
  int elements = 128;                   ///< Range 16..1024.
  int active_elements = 64;             ///< Largest number of elements that work together. Range 8..elements.
  double pitch_mm = 0.5;                ///< Distance between elements' centres, along the face.
  double radius_mm = 60.0;              ///< Radius of the array's arc; convex kinds only.
  double field_of_view_rad = 1.2;       ///< Angle between the outermost scanlines; fans only.
  double elevation_aperture_mm = 12.0;  ///< Height of an element.
  double elevation_focus_mm = 70.0;     ///< Depth of the lens' focus.
  double f_number = 3.0;                ///< Smallest ratio of depth to receiving aperture.
  double depth_mm = 160.0;              ///< Default depth of the picture.
  double greatest_depth_mm = 300.0;
  double focus_mm = 80.0;        ///< Default depth of the transmit focus.
  int scanlines = 256;           ///< Default.
  double sweep_rad = 0.0;        ///< Whole angle of the mechanical sweep; kMechanicalConvex only.
  double sweep_radius_mm = 0.0;  ///< Distance of the motor's axis behind the middle of the face; the axis is along x.

  /// Width of the face along its surface, mm.
  double face_width_mm() const noexcept { return pitch_mm * elements; }
  /// Largest active aperture, mm.
  double aperture_mm() const noexcept { return pitch_mm * active_elements; }
};

/// All transducers of a file. Errors name file, transducer and key: unknown key, out of range, no source.
Result<std::vector<Transducer>> load_transducers(const std::filesystem::path& path);
/// One by name; an unknown one is an error that lists the names (exit status 2).
Result<Transducer> load_transducer(const std::filesystem::path& path, std::string_view name);

}  // namespace trocar::ultrasound
