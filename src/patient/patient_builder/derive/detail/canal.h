#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "patient_builder/derive/derive_structures.h"
#include "patient_builder/derive/detail/derived_labels.h"
#include "patient_builder/detail/label_boxes.h"

namespace trocar::patient_builder::detail {

/// The vertebral canal in one axial slice. Fractional voxel indices.
struct CanalSlice {
  double i = 0.0, j = 0.0;     ///< Its centre.
  double half_width_mm = 0.0;  ///< To the left and right.
  bool is_found = false;
};

/// The vertebral canal slice by slice, from feet to head.
struct Canal {
  std::int64_t first_k = 0;
  std::vector<CanalSlice> slices;
  std::uint8_t cord = 0;  ///< Label that it was found from ("spinal_cord", "spinal_canal"); 0: from the vertebrae.

  /// nullptr: no canal in this slice.
  const CanalSlice* at(std::int64_t k) const noexcept;
  std::int64_t last_k() const noexcept { return first_k + static_cast<std::int64_t>(slices.size()) - 1; }
};

/// Finds the canal from a label of cord or canal; without one from the rings that the vertebrae form in axial slices,
/// interpolated between them. Empty: fewer than two vertebrae, or neither a cord nor a closed ring.
std::optional<Canal> find_canal(const DerivedLabels& labels, const SpineLabels& spine);

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

/// Adds what is chosen of dural_sac, ligamentum_flavum and epidural_fat, and shortens a labelled spinal cord that
/// contains the sac. Published sizes: canal_contents.cpp.
void derive_canal_contents(DerivedLabels& labels, const SpineLabels& spine, const Canal& canal,
                           const PosteriorWall& wall, const DeriveChoice& choice);

/// Adds what is chosen of interspinous_ligament and supraspinous_ligament.
void derive_spinous_ligaments(DerivedLabels& labels, const SpineLabels& spine, const Canal& canal,
                              const PosteriorWall& wall, const DeriveChoice& choice);

}  // namespace trocar::patient_builder::detail
