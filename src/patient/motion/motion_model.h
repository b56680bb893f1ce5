#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "geometry/vec.h"

namespace trocar::motion {

inline constexpr std::size_t kMostDrivers = 4;
inline constexpr std::size_t kMostRegions = 8;
inline constexpr std::size_t kMostModes = 16;
/// Largest value of a driver, either sign; a larger one is clamped.
inline constexpr double kMostDrive = 1.5;
/// Largest displacement gradient of a region with all its drivers at kMostDrive. Below 1 the map of a region is
/// one-to-one and its Jacobian is positive (Banach: x + u(x) with a contraction u).
inline constexpr double kMostGradient = 0.8;

/// How the displacement of a mode is distributed in its region.
enum class Profile : std::uint8_t {
  kUniform,  ///< The same everywhere.
  kRamp,     ///< Zero at the centre, 1 at `extent_mm` along the axis from it, linear: a shear or a stretch.
  kBump,     ///< exp(-r^2 / (2 extent^2)) around the centre.
};

/// A displacement that grows in proportion to one scalar, the driver. Lengths in mm, frame A.
struct MotionMode {
  static constexpr int kEveryRegion = -1;

  int driver = 0;             ///< Index of a driver of the model.
  int region = kEveryRegion;  ///< Index of a region of the model.
  Profile profile = Profile::kUniform;
  Vec3 displacement_mm = Vec3::Zero();  ///< Where the profile and the driver are 1. At most 100 mm long.
  Vec3 centre_A = Vec3::Zero();
  Vec3 axis_A = Vec3::UnitZ();  ///< Unit; of a ramp.
  double extent_mm = 1.0;       ///< Range 1..1000.
};

/// The points with normal_A . p_A <= offset_mm.
struct HalfSpace {
  Vec3 normal_A = Vec3::UnitZ();  ///< Unit.
  double offset_mm = 0.0;
};

/// A part of the body that moves as one; neighbouring regions slide along their border.
struct MotionRegion {
  std::string name;
  std::vector<HalfSpace> sides;  ///< The region is what all of them share; none: everywhere.
};

/// What a model is made of. A point belongs to the first region that contains it; the last one has no sides.
struct MotionParts {
  std::vector<std::string> drivers;
  std::vector<MotionRegion> regions;
  std::vector<MotionMode> modes;
};

/// How the anatomy of a patient moves against its rest, the CT: frame A (at rest) to frame P (now). Immutable.
class MotionModel {
 public:
  /// Errors: a number out of its range, a name that is missing, more parts than the limits above, a border without end
  /// (the last region has sides), a displacement gradient above kMostGradient. `where` names the source.
  static Result<std::shared_ptr<const MotionModel>> make(MotionParts parts, const std::string& where);

  const MotionParts& parts() const noexcept { return parts_; }
  const std::string& hash() const noexcept { return hash_; }  ///< Of the parts: the same model in two processes.

  using Scalars = std::array<double, kMostDrivers>;

  /// Region of a point at rest. Real-time safe, like all that follows.
  int region_of(const Vec3& p_A) const noexcept;
  /// How far (mm) a point at rest is from belonging to a region; 0: it does.
  double outside_mm(int region, const Vec3& p_A) const noexcept;
  /// Displacement (mm) that a region's modes give a point at rest: the sum of driver * profile * displacement.
  Vec3 displacement_mm(int region, const Vec3& p_A, const Scalars& drivers) const noexcept;
  /// The same with its gradient, d displacement / d p_A.
  struct Field {
    Vec3 displacement_mm;
    Mat3 gradient;
  };
  Field field(int region, const Vec3& p_A, const Scalars& drivers) const noexcept;

 private:
  explicit MotionModel(MotionParts parts);
  bool contains(std::size_t region, const Vec3& p_A) const noexcept;

  MotionParts parts_;
  std::string hash_;
};

}  // namespace trocar::motion
