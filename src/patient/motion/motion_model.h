#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/result.h"
#include "geometry/vec.h"
#include "volume/grid.h"

namespace trocar::motion {

inline constexpr std::size_t kMostDrivers = 2;
inline constexpr std::size_t kMostRegions = 2;
/// Range of a driver: 0 is end-expiration, 1 the deep breath that a model was made for. Others are clamped.
inline constexpr double kLeastDrive = -0.3, kMostDrive = 1.5;
/// Strongest shortening of a region that a model may make, with its drivers anywhere within their range: the symmetric
/// part of the displacement gradient has no eigenvalue below -kMostShortening. Below 1 the map of a region is
/// one-to-one and its Jacobian positive (the map x + u(x) is then strictly monotone).
inline constexpr double kMostShortening = 0.85;

/// What a motion model is made of. Lengths in mm, frame A.
struct MotionParts {
  using Scalars = std::array<double, kMostDrivers>;

  std::vector<std::string> drivers;  ///< What moves the patient: "diaphragm", "chest". At least one.
  std::vector<std::string> regions;  ///< One, or two that slide past each other: "wall", "inside".
  /// Nodes of the displacement modes; axes along those of A.
  volume::GridGeometry lattice;
  /// modes[region * drivers.size() + driver]: displacement where the driver is 1, as coefficients of quadratic
  /// B-splines, one a node, i fastest. Beyond the nodes the displacement of the edge continues.
  std::vector<std::vector<Vec3f>> modes;
  /// With two regions: how deep a point is in the second one (negative: in the first one), trilinear; about a distance:
  /// no steeper than 1.5 mm per mm. Any axes.
  volume::FloatGrid border_mm;
  double liver_mm =
      24.4;            ///< How far the liver moves down where the drivers are 1: the scale of breaths. Range 1..100.
  Scalars at_ct{};     ///< Values of the drivers when the CT was taken; 0: at end-expiration.
  std::string source;  ///< How the model was made, and what of it is assumed: one line. Not a part of the hash.
};

/// How the anatomy of a patient moves against its rest, the CT: frame A (at rest) to frame P (now). Displacement modes
/// of two regions that slide past each other, in proportion to a few drivers. Immutable.
class MotionModel {
 public:
  /// Errors: too few or too many drivers or regions, a number that is not finite or above 150 mm, sizes that do not
  /// fit, a shortening above kMostShortening at a node. `where` names the source.
  static Result<std::shared_ptr<const MotionModel>> make(MotionParts parts, const std::string& where);

  /// The same without the last of these, for those who make models.
  static Result<std::shared_ptr<const MotionModel>> unchecked(MotionParts parts, const std::string& where);
  /// Strongest shortening at a node of the lattice, and half way to the next ones, with the drivers anywhere in their
  /// range.
  double shortening(int region, std::size_t node) const;

  const MotionParts& parts() const noexcept { return parts_; }
  const std::string& hash() const noexcept { return hash_; }  ///< Of the parts: the same model in two processes.

  using Scalars = MotionParts::Scalars;

  /// Region of a point at rest. Real-time safe, like all that follows.
  int region_of(const Vec3& p_A) const noexcept { return depth_mm(p_A) < 0.0 ? 0 : last_region_; }
  /// How deep a point at rest is in the second region; negative: in the first one.
  double depth_mm(const Vec3& p_A) const noexcept;
  /// Displacement (mm) of a point at rest as part of a region: the sum of drives * mode. `drives`: drivers against the
  /// CT's (MotionParts::at_ct).
  Vec3 displacement_mm(int region, const Vec3& p_A, const Scalars& drives) const noexcept;
  /// The same with its gradient, d displacement / d p_A.
  struct Field {
    Vec3 displacement_mm;
    Mat3 gradient;
  };
  Field field(int region, const Vec3& p_A, const Scalars& drives) const noexcept;
  /// No point of the tissue moves further (mm) with these drives.
  double most_displacement_mm(const Scalars& drives) const noexcept;
  /// The displacements of the regions differ by no more (mm).
  double most_slide_mm(const Scalars& drives) const noexcept;

 private:
  struct Sums {
    Vec3 middle_mm = Vec3::Zero();  ///< Displacement of the node in the middle; the rest is relative to it.
    Eigen::Array4f value = Eigen::Array4f::Zero();
    std::array<Eigen::Array4f, 3> along{Eigen::Array4f::Zero(), Eigen::Array4f::Zero(), Eigen::Array4f::Zero()};
  };
  explicit MotionModel(MotionParts parts);
  template <bool kHasSlope>
  Sums sums(int region, const Vec3& p_A, const Scalars& drives) const noexcept;

  MotionParts parts_;
  std::string hash_;
  int last_region_ = 0;
  /// By region: four floats (x, y, z, 0) for each driver of a node, then the next node.
  std::vector<float> coefficients_;
  std::size_t region_stride_ = 0;
  Vec3 nodes_per_mm_ = Vec3::Ones();
  std::array<double, kMostDrivers> longest_mm_{}, widest_mm_{};
};

}  // namespace trocar::motion
