#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "geometry/pose.h"
#include "image/image.h"
#include "ultrasound/doppler/doppler_settings.h"
#include "ultrasound/doppler/vessel_flow.h"
#include "ultrasound/engine/beam.h"
#include "ultrasound/probe/scan_geometry.h"
#include "ultrasound/scanner/scanner.h"

namespace trocar::ultrasound {

class EchoEngine;

/// Input of one colour frame.
struct DopplerInput {
  Pose X_PT;  ///< Transducer in the patient now.
  ScanGeometry geometry;
  Beam beam;
  double time_s = 0.0;     ///< Time of the heart.
  std::uint64_t seed = 0;  ///< Seed of the noise; differs from frame to frame.
  /// The engine that rendered this frame: losses along the path, and the indentation under the face. nullptr: only
  /// kPlainLoss_db_per_cm_mhz, no indentation.
  const EchoEngine* engine = nullptr;
  motion::PatientMotion motion{};  ///< Where the patient is, and in which phase of the breath.
};
inline constexpr double kPlainLoss_db_per_cm_mhz = 0.5;

/// Colour Doppler measurements: cells on scanlines, gate runs fastest.
struct DopplerFrame {
  double first_line = 0.0;  ///< Scanline of the picture at the first line of cells.
  double line_step = 2.0;
  int lines = 0;
  double first_mm = 0.0;  ///< Depth of the middle of the first gate.
  double gate_mm = 0.6;
  int gates = 0;
  double scale_cm_per_s = 30.0;  ///< Nyquist velocity in use.
  /// Estimated velocity along the beam, positive towards the transducer, aliased into +-scale. 0 where there is no
  /// flow.
  std::vector<float> velocity_cm_per_s;
  std::vector<std::uint8_t> has_flow;  ///< 1: flow is displayed; else 0.
  std::vector<float> re, im;           ///< Autocorrelation over one pulse interval, in units of the noise's power.

  std::size_t at(int line, int gate) const noexcept {
    return static_cast<std::size_t>(line) * static_cast<std::size_t>(gates) + static_cast<std::size_t>(gate);
  }
};

/// Colour Doppler of the vessels' flow (docs/physics.md U15): velocity along the beam from the phase of the
/// autocorrelation of blood's echoes between pulses, with aliasing, wall filter, noise and persistence. Buffers are
/// allocated for a geometry and box; render() allocates nothing while both stay the same. The result does not depend on
/// the number of threads.
class ColourDoppler {
 public:
  explicit ColourDoppler(std::shared_ptr<const VesselFlow> flow);
  ~ColourDoppler();
  ColourDoppler(ColourDoppler&&) noexcept;
  ColourDoppler& operator=(ColourDoppler&&) noexcept;

  DopplerSettings settings;  ///< Settings out of range are clamped.

  /// Valid until the next call.
  const DopplerFrame& render(const DopplerInput& input) noexcept;
  /// The last frame's colours over the picture of the same scan, with the box's outline. Valid until the next call.
  const image::RgbImage& overlay(const image::GrayImage& image, const RasterGeometry& raster) noexcept;
  /// Clears persistence.
  void reset() noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Colour of a velocity as a fraction of the scale (-1..1), after inversion and shift of the baseline. Towards the
/// transducer: red, orange, yellow. Away from it: blue to cyan. Dark near the baseline. Real-time safe.
image::Rgb doppler_colour(double share, const DopplerSettings& settings) noexcept;
/// Draws the colour bar with +-scale (cm/s) at its ends; its top left at (column, row).
void draw_colour_bar(image::RgbImage& image, int column, int row, int columns, int rows, double scale_cm_per_s,
                     const DopplerSettings& settings);

}  // namespace trocar::ultrasound
