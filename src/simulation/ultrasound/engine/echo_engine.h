#pragma once

#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "core/result.h"
#include "geometry/pose.h"
#include "geometry/vec.h"
#include "motion/patient_motion.h"
#include "ultrasound/engine/beam.h"
#include "ultrasound/probe/scan_geometry.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::ultrasound {

/// Deviations from straight propagation and single reflection; each can be switched off.
struct Artefacts {
  bool attenuation = true;       ///< Shadow behind bone and gas, enhancement behind fluid.
  bool downshift = true;         ///< Attenuation lowers the centre frequency: deeper echoes are wider and louder.
  bool reverberation = true;     ///< A-lines, ring-down at gas.
  bool mirror = true;            ///< Mirror image at a strong, smooth reflector (the diaphragm).
  bool refraction = true;        ///< Edge shadows, bent scanlines.
  bool range_distortion = true;  ///< Depth follows from time; the speed of sound differs between tissues.
  bool side_lobes = true;        ///< Side lobes.
  bool contact_loss = true;      ///< Air where the face has no contact with the skin.
  bool clutter = true;           ///< Haze of the near field, and of what is beside the beam.
  bool noise = true;             ///< Noise of the receiver; increases with depth because the gain does.

  bool operator==(const Artefacts&) const = default;
};

/// "attenuation", "downshift", "reverberation", "mirror", "refraction", "range-distortion", "side-lobes",
/// "contact-loss", "clutter", "noise".
std::vector<std::string_view> artefact_names();
/// Switches one off, or "all". An unknown name is an error that lists the names (exit status 2).
Status switch_off(Artefacts& artefacts, std::string_view name);

/// Acoustic model of a needle. Frame P, mm. A needle with non-finite values, or shorter than its point, has no echo.
struct NeedleEcho {
  std::span<const Vec3> shaft_P;  ///< Polyline from the hub to the tip; bent needles have more than two points.
  double diameter_mm = 1.2;       ///< Range 0.2..5.
  double tip_mm = 3.0;  ///< Length of the roughened or bevelled tip, which reflects in all directions. Range 0..30.
  double displacement_mm = 0.0;  ///< Displacement of tissue at the tip along the axis. Range -10..10.
  /// Diameter of the bore, filled with fluid, divided by the outer diameter; 0 with the stylet in. Range 0..0.9. 18 G,
  /// regular wall: 0.84 of 1.27 mm (ISO 9626).
  double bore_share = 0.66;
};

/// Settings of transmission and reception: the scanner controls that act before the echoes are computed.
struct Acquisition {
  double depth_mm = 160.0;
  double frequency_mhz = 3.5;
  double focus_mm = 80.0;
  int lines = 256;          ///< Range 2..1024.
  int samples = 1024;       ///< Samples per scanline. Range 16..4096.
  int steering_angles = 3;  ///< Number of compounding angles whose images are averaged. Range 1..5; 1: full speckle.
  int planes = 5;           ///< Planes across the beam's thickness. 1, 3, 5, 7 or 9.
  /// Scatterers in the smallest resolution cell: a share of the same ones, so that fewer keep the speckle's pattern.
  /// Four give fully developed speckle. Range 1..4.
  double scatterers = 4.0;
  /// Tissue harmonic imaging: receives the second harmonic, near `frequency_mhz`, of a transmitted beam of half the
  /// frequency; see harmonic_mhz(). Without effect for a transducer whose band has less than an octave.
  bool is_harmonic = false;
  Artefacts artefacts;

  bool operator==(const Acquisition&) const = default;
};
/// The transducer's own defaults.
Acquisition default_acquisition(const Transducer& transducer);

/// Scanlines first, first + 1 … last - 1.
struct LineRange {
  int first = 0;
  int last = 0;

  bool is_empty() const noexcept { return last <= first; }
  int count() const noexcept { return is_empty() ? 0 : last - first; }
  bool operator==(const LineRange&) const = default;
};

/// Input of one frame.
struct BModeInput {
  Pose X_PT;  ///< Transducer in the patient now.
  std::span<const NeedleEcho> needles;
  double time_s = 0.0;
  /// Scanlines to renew, widened to multiples of four; empty: all. The others keep their echoes, as in a scanner that
  /// shows its picture while scanlines still return (rolling acquisition). Echoes across the seam are mixed within the
  /// beam's main lobe. The first frame after set_acquisition() renews all.
  LineRange renewed{};
  /// True: scanlines outside `renewed` are silent instead of keeping their echoes, so that the frame does not depend on
  /// earlier ones. Only the renewed scanlines of the result are then valid.
  bool is_alone = false;
  motion::PatientMotion motion{};  ///< Where the patient is.
};

/// Echoes of one frame, beamformed, demodulated and not yet amplified: complex baseband, scanline by scanline (sample
/// runs fastest), angle after angle. 1.0 is the root mean square of liver's speckle without attenuation.
struct BasebandFrame {
  ScanGeometry geometry;
  Beam beam;
  int steering_angles = 1;
  /// Further angles, behind the others in `re` and `im`, whose sound overlaps near the face only. Their share of an
  /// average falls from 1 in front of near_full to 0 at near_samples; their deeper samples are 0.
  int near_angles = 0, near_full = 0, near_samples = 0;
  std::vector<float> re, im;   ///< (steering_angles + near_angles) * lines * samples.
  std::vector<float> contact;  ///< Per scanline: 1 where the face is coupled to the skin, 0 in air.
  LineRange renewed;           ///< Scanlines that differ from the frame before; empty: all.
};

/// Share of the scanlines that are coupled to the skin, 0..1.
double coupled_share(const BasebandFrame& frame) noexcept;

/// Losses of the last frame along one scanline; for Doppler.
struct SoundPath {
  std::span<const float> gain;  ///< Per sample: amplitude of an echo from there after losses, without its own strength.
  /// Tissue displayed at depth r has its rest position at r - pressed_mm * dent_share.
  float pressed_mm = 0.0F;
  std::span<const float> dent_share;
  float mirror_depth_mm = std::numeric_limits<float>::infinity();  ///< Deeper samples display a mirror image.
};

/// An engine that computes the echoes of one transducer on one patient. Buffers are allocated once; render() allocates
/// nothing. The result does not depend on the number of threads.
class EchoEngine {
 public:
  EchoEngine() = default;
  EchoEngine(const EchoEngine&) = delete;
  EchoEngine& operator=(const EchoEngine&) = delete;
  EchoEngine(EchoEngine&&) noexcept = default;
  EchoEngine& operator=(EchoEngine&&) noexcept = default;
  virtual ~EchoEngine() = default;

  /// Sets the settings and allocates the buffers again.
  virtual void set_acquisition(const Acquisition& acquisition) = 0;
  virtual const Acquisition& acquisition() const noexcept = 0;
  virtual const ScanGeometry& geometry() const noexcept = 0;

  /// The echoes from that pose. The frame stays valid until the next call.
  virtual const BasebandFrame& render(const BModeInput& input) noexcept = 0;
  /// Losses along a scanline of the last frame; valid until the next call of render(). 0 <= line < lines.
  virtual SoundPath sound_path(int line) const = 0;
};

}  // namespace trocar::ultrasound
