#pragma once

#include <array>
#include <memory>
#include <vector>

#include "ultrasound/doppler/detail/centreline.h"
#include "ultrasound/doppler/vessel_flow.h"

namespace trocar {

inline constexpr std::int32_t kBrickBits = 3;
inline constexpr std::int32_t kBrick = 1 << kBrickBits;
inline constexpr std::int32_t kBrickSide = kBrick + 1;
inline constexpr float kSpeedStep_mm_per_s = 0.1F;

/// Makes a VesselFlow label by label.
class VesselFlowMaker {
 public:
  VesselFlowMaker(const VirtualPatient& patient, FlowTable table, const VesselFlowOptions& options);

  void add(const Label& label);
  std::shared_ptr<const VesselFlow> finish();

 private:
  /// A box of voxels; of the patient's labels or of the flow's grid.
  struct Box {
    Index3 low, high;  ///< Both within.
  };

  /// Depth below the surface (mm, negative outside) on a piece of the flow's grid.
  struct Lumen {
    FloatGrid own;     ///< Of the label alone.
    FloatGrid joined;  ///< With the beginnings of the vessels that join it: they may be cut out of it.
  };

  std::array<bool, 256> find_joining(const Label& label) const;
  Box box_of(const Label& label) const;
  GridGeometry flow_grid_over(const Box& box) const;
  FloatGrid depth_of(const MaskGrid& mask, const GridGeometry& target) const;
  Lumen find_lumen(const Label& label) const;
  void add_tree(const detail::CentrelineTree& tree, const std::vector<bool>& from_root, const Label& label,
                const FlowRule& rule, double widest_mm);
  void fill(const Lumen& lumen, std::size_t first_branch);
  VesselFlow::Cell& cell(std::int64_t brick, std::int64_t offset);
  void store(const Index3& at, const VesselFlow::Cell& value);

  const VirtualPatient& patient_;
  VesselFlowOptions options_;
  std::shared_ptr<VesselFlow> flow_;
};

}  // namespace trocar
