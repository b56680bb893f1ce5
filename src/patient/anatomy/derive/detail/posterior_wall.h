#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "anatomy/derive/detail/canal.h"

namespace trocar::anatomy::detail {

/// The posterior wall of the vertebral canal as a surface j(i, k) in voxel indices: the inner face of laminae and
/// joints, and straight between the laminae of neighbouring vertebrae, where the ligamentum flavum closes the canal.
class PosteriorWall {
 public:
  struct Cell {
    float face_j = std::numeric_limits<float>::quiet_NaN();  ///< Between the last voxel of the canal and the wall.
    std::uint8_t above = 0;  ///< Places of the vertebrae (SpineLabels): at a lamina both are its own.
    std::uint8_t below = 0;

    bool is_known() const noexcept { return face_j == face_j; }
    bool is_gap() const noexcept { return above != below; }
  };

  PosteriorWall(const DerivedLabels& labels, const SpineLabels& spine, const Canal& canal);

  /// A cell that is not known where the wall was not found.
  const Cell& at(std::int64_t i, std::int64_t k) const noexcept;
  std::int64_t first_i() const noexcept { return first_i_; }
  std::int64_t last_i() const noexcept { return first_i_ + columns_ - 1; }
  std::int64_t first_k() const noexcept { return first_k_; }
  std::int64_t last_k() const noexcept { return first_k_ + rows_ - 1; }
  /// Length along j of a line through the wall per length along its normal, 1 to 2: the wall is oblique.
  double slant(std::int64_t i, std::int64_t k) const noexcept;

 private:
  Cell& cell(std::int64_t i, std::int64_t k) noexcept {
    return cells_[static_cast<std::size_t>((k - first_k_) * columns_ + i - first_i_)];
  }
  void find_faces(const DerivedLabels& labels, const SpineLabels& spine, const Canal& canal);
  void remove_far_faces(const Canal& canal);
  void bridge_gaps();

  volume::GridGeometry geometry_;
  std::int64_t first_i_ = 0, columns_ = 0, first_k_ = 0, rows_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace trocar::anatomy::detail
