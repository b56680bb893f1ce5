#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "anatomy/patient.h"
#include "core/result.h"
#include "ultrasound/tissue/acoustic_table.h"

namespace trocar::ultrasound::detail {

/// HU of gas, as in src/patient/anatomy; gas in bowel is labelled bowel.
inline constexpr int kGasBelow_hu = -300;

/// Value of TissueVolume::tissue outside the body.
inline constexpr std::uint8_t kNoTissue = 0xFF;

/// Part of a patient's grid that contains the body and a margin, with the axis of the thickest voxels last (slices).
struct BodyWindow {
  volume::GridGeometry geometry;      ///< Geometry of the part, with the axes in their new order.
  std::array<std::size_t, 3> stride;  ///< Offset between adjacent voxels along each axis, in the patient's grid.
  std::size_t first;                  ///< Offset of its voxel (0, 0, 0) in the patient's grid.

  std::size_t patient_offset(std::int64_t u, std::int64_t v, std::int64_t w) const noexcept {
    return first + static_cast<std::size_t>(u) * stride[0] + static_cast<std::size_t>(v) * stride[1] +
           static_cast<std::size_t>(w) * stride[2];
  }
};

/// Error: no voxel lies inside the body, or no skin is in the volume.
Result<BodyWindow> find_body_window(const anatomy::VirtualPatient& patient, double margin_mm);

/// Acoustic tissue and HU deviation of the patient's own voxels.
struct TissueVolume {
  volume::GridGeometry geometry;
  std::uint8_t gas = 0;              ///< Tissue index of gas.
  std::vector<std::uint8_t> tissue;  ///< Index into the table, or kNoTissue.
  std::vector<std::int8_t> texture;  ///< See AcousticScene::texture. Empty until make_texture fills it.

  std::size_t slice_size() const noexcept { return static_cast<std::size_t>(geometry.size[0] * geometry.size[1]); }
  const std::uint8_t* tissue_slice(std::int64_t w) const noexcept {
    return tissue.data() + static_cast<std::size_t>(w) * slice_size();
  }
  const std::int8_t* texture_slice(std::int64_t w) const noexcept {
    return texture.data() + static_cast<std::size_t>(w) * slice_size();
  }
};

/// Error: a label whose tissue has no row.
Status check_tissues(const anatomy::LabelTable& labels, const AcousticTable& table);

/// Maps labels to tissues by their name in the table. Gas in bowel and unlabelled voxels are classified by their HU.
/// Errors: a tissue without a row.
Result<TissueVolume> make_tissue_volume(const anatomy::VirtualPatient& patient, const BodyWindow& window,
                                        const AcousticTable& table);

/// Fills `texture`: the CT's deviation from the mean of its structure (label), smoothed by a Gaussian of about
/// `sigma_mm` over the same tissue only. Voxels at a tissue's border, where the CT mixes both, have a small weight.
void make_texture(const anatomy::VirtualPatient& patient, const BodyWindow& window, double sigma_mm,
                  TissueVolume& volume);

}  // namespace trocar::ultrasound::detail
