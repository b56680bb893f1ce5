#pragma once

#include <memory>
#include <span>
#include <vector>

#include "lab/ultrasound/scene_painter.h"

/// Scenes with a single object, like a test phantom, that isolate each artefact. X_PT is the identity. `y` is depth
/// below the face's centre, mm.
namespace trocar::ultrasound {

/// Tissues of the test scenes, with round numbers, so that measured values can be compared with set values. All tissues
/// without other values have 1540 m/s and 1000 kg/m3, so that borders between them do not reflect.
enum class TestTissue : std::uint8_t {
  kAir,
  kWater,     ///< Without echoes and losses.
  kTissue,    ///< Speckle of 0 dB, 0.5 dB/cm/MHz.
  kLossless,  ///< The same without loss.
  kLossy,     ///< The same with 0.8 dB/cm/MHz^1.2.
  kMinus12,   ///< kTissue with speckle of -12 dB; the next ones likewise.
  kMinus6,
  kPlus6,
  kPlus12,
  kBone,   ///< 3500 m/s, 1900 kg/m3, 10 dB/cm/MHz.
  kGas,    ///< Like air, smooth.
  kFast,   ///< 1640 m/s at the impedance of the others, without loss.
  kSlow,   ///< 1450 m/s likewise.
  kDense,  ///< 1200 kg/m3, without loss: reflects 1/11 of the amplitude.
  kDenser  ///< 2000 kg/m3, without loss: reflects 1/3 of the amplitude.
};
inline constexpr std::uint8_t index_of(TestTissue tissue) noexcept {
  return static_cast<std::uint8_t>(tissue);
}
AcousticTable test_table();

using ScenePtr = std::shared_ptr<const AcousticScene>;

/// One tissue everywhere.
ScenePtr homogeneous_scene(const SceneBox& box, TestTissue tissue);
/// Points in a medium with or without speckle.
ScenePtr points_scene(const SceneBox& box, TestTissue medium, std::vector<AcousticPoint> points);
/// Layers across the beam, each down to its depth; the last one continues below.
struct TestLayer {
  double to_y_mm;
  TestTissue tissue;
};
ScenePtr layers_scene(const SceneBox& box, std::span<const TestLayer> layers, std::vector<AcousticPoint> points = {});
/// Cylinders along z in a medium. A rod is limited to |z| < half_length_mm; the default is practically unlimited.
struct TestRod {
  double x_mm, y_mm, radius_mm;
  TestTissue tissue;
  double half_length_mm = 1e9;
};
ScenePtr rods_scene(const SceneBox& box, TestTissue medium, std::span<const TestRod> rods,
                    std::vector<AcousticPoint> points = {});
/// A slab from -half_width to half_width in x, between two depths, like the cross-section of a rib.
struct TestSlab {
  double half_width_mm, from_y_mm, to_y_mm;
  TestTissue tissue;
};
ScenePtr slab_scene(const SceneBox& box, TestTissue medium, const TestSlab& slab);
/// All tissue behind a plane through (0, y), whose normal is turned by `tilt_rad` about z, is `behind`, like lung
/// behind the diaphragm.
struct TestPlane {
  double y_mm;
  double tilt_rad;  ///< Positive: nearer to the face at positive x.
  TestTissue behind = TestTissue::kGas;
};
ScenePtr plane_scene(const SceneBox& box, TestTissue medium, const TestPlane& plane, std::span<const TestRod> rods = {},
                     std::vector<AcousticPoint> points = {});
/// Position of the mirror image of a point of the image plane (x, y).
Vec3 mirrored(const Vec3& p_P, const TestPlane& plane);
/// Tissue whose skin lies `gap_mm` behind a flat face for x > from_x_mm.
ScenePtr gap_scene(const SceneBox& box, TestTissue tissue, double from_x_mm, double gap_mm);

}  // namespace trocar::ultrasound
