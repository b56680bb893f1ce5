#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "xray/contrast/contrast_table.h"
#include "xray/contrast/duct_tree.h"

namespace trocar::xray::detail {

/// Shape of contrast agent in the cells of a tree of ducts. At a front the agent is a core in the middle of the
/// duct, as in laminar flow: the lower the concentration relative to the greatest one within about two diameters, the
/// thinner is the core, so that a front ends as a rounded, soft nose. Closed ends of ducts are round. docs/physics.md,
/// X13.
class DuctOutline {
 public:
  explicit DuctOutline(const DuctTree& tree);

  /// Adds the cells with at least this concentration. Each cell keeps its iodine; its volume may differ from the cone's
  /// (distension). The tree is that of the constructor.
  void add_pieces(const DuctTree& tree, const std::vector<double>& volume_ml,
                  const std::vector<double>& iodine_mg_per_ml, double least_mg_per_ml,
                  std::vector<IodinePiece>& pieces) const;

 private:
  void add_core(const DuctCell& cell, std::size_t n, const std::array<double, 2>& factors, double mg,
                std::vector<IodinePiece>& pieces) const;
  std::vector<double> find_relative(const DuctTree& tree, const std::vector<double>& iodine_mg_per_ml) const;

  std::vector<double> fall_;      ///< Factor of a front's greatest concentration from a cell to its parent.
  std::vector<double> to_end_a_;  ///< From a cell's a and
  std::vector<double> to_end_b_;  ///< from its b to the closed end of the duct, mm; infinite: none is near.
};

}  // namespace trocar::xray::detail
