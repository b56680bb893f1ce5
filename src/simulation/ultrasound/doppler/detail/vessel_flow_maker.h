#pragma once

#include <array>
#include <memory>
#include <vector>

#include "ultrasound/doppler/vessel_flow.h"
#include "volume/centreline.h"

namespace trocar::ultrasound {

inline constexpr std::int32_t kBrickBits = 3;
inline constexpr std::int32_t kBrick = 1 << kBrickBits;
inline constexpr std::int32_t kBrickSide = kBrick + 1;
inline constexpr float kSpeedStep_mm_per_s = 0.1F;

/// Makes a VesselFlow label by label.
class VesselFlowMaker {
 public:
  VesselFlowMaker(const anatomy::VirtualPatient& patient, FlowTable table, const VesselFlowOptions& options);

  void add(const anatomy::Label& label);
  std::shared_ptr<const VesselFlow> finish();

 private:
  /// A box of voxels of the patient's labels or of the flow's grid.
  struct Box {
    volume::Index3 low, high;  ///< Both corners are in the box.
  };

  /// Depth below the surface (mm, negative outside) on a piece of the flow's grid.
  struct Lumen {
    volume::FloatGrid own;     ///< Depth in the label alone.
    volume::FloatGrid joined;  ///< Depth in the label and the first parts of the vessels that join it; these may be cut
                               ///< out of the label.
  };

  std::array<bool, 256> find_joining(const anatomy::Label& label) const;
  Box box_of(const anatomy::Label& label) const;
  volume::GridGeometry flow_grid_over(const Box& box) const;
  volume::FloatGrid depth_of(const volume::MaskGrid& mask, const volume::GridGeometry& target) const;
  Lumen find_lumen(const anatomy::Label& label) const;
  void add_tree(const volume::CentrelineTree& tree, const std::vector<bool>& from_root, const anatomy::Label& label,
                const FlowRule& rule, double widest_mm);
  void fill(const Lumen& lumen, std::size_t first_branch);
  VesselFlow::Cell& cell(std::int64_t brick, std::int64_t offset);
  void store(const volume::Index3& at, const VesselFlow::Cell& value);

  const anatomy::VirtualPatient& patient_;
  VesselFlowOptions options_;
  std::shared_ptr<VesselFlow> flow_;
};

}  // namespace trocar::ultrasound
