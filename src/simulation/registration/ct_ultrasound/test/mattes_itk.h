#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

/// ITK's metric behind plain types, the reference of PoseMetric: ITK brings an Eigen of its own, so a file that
/// includes ITK must not include ours.
namespace trocar::registration::testing {

/// A volume of floats in LPS mm, i running fastest; the owner keeps the voxels alive.
struct ImageView {
  const float* voxels = nullptr;
  std::array<std::int64_t, 3> size{};
  std::array<double, 3> spacing_mm{}, origin_mm{};
  std::array<std::array<double, 3>, 3> direction{};  ///< direction[row][column], columns: i, j, k.
};

/// Rotations (rad) about x, y, z of ITK's Euler3DTransform, then a translation (mm).
using MotionNumbers = std::array<double, 6>;

/// Mutual information of ultrasound samples and a CT (Mattes et al., IEEE Trans Med Imaging 22:120, 2003;
/// docs/physics.md R12). Deterministic: one thread. Not for use by several threads at once.
class MattesItk {
 public:
  /// Points in the frame that both images share; the motion rotates about `centre`.
  MattesItk(const ImageView& us, const ImageView& ct, std::span<const std::array<double, 3>> points,
            const std::array<double, 3>& centre, int bins);
  ~MattesItk();
  MattesItk(const MattesItk&) = delete;
  MattesItk& operator=(const MattesItk&) = delete;

  /// Nats; 0 if too few points lie in the CT.
  double value(const MotionNumbers& motion);
  struct Slope {
    double value = 0.0;
    MotionNumbers gradient{};  ///< Of the value, per rad and per mm.
  };
  Slope value_and_gradient(const MotionNumbers& motion);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace trocar::registration::testing
