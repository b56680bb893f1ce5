#pragma once

#include <cstddef>
#include <vector>

#include "xray/contrast/contrast_table.h"
#include "xray/contrast/detail/duct_outline.h"
#include "xray/contrast/duct_tree.h"

namespace trocar::xray {

/// Contrast agent in a tree of ducts: one-dimensional flow and mixing on its cells. Law of the flow: the injected
/// volume displaces bile; each duct that can be reached without passing an obstruction gives way in proportion to the
/// bile in it, so that the flow into a branch is proportional to the bile beyond, and all branches are full at the same
/// time. An open papilla lets a share of the injection out, later everything that the tree cannot hold; bile is
/// secreted into all ducts and empties them through it. A full tree without outlet is distended, then loses the rest
/// (reflux into the veins). Fluxes are upwind and implicit, with dispersion: iodine is conserved and never negative for
/// any step. docs/physics.md, X13.
class DuctFill {
 public:
  DuctFill(DuctTree tree, const DuctParams& params);

  /// Advances by `dt_s` (> 0, best <= 0.01). `cell` < 0 or rate 0: nothing is injected.
  void step(double dt_s, int cell, double ml_per_s, double iodine_mg_per_ml);

  const DuctTree& tree() const { return tree_; }
  double iodine_mg(std::size_t cell) const { return iodine_mg_per_ml_[cell] * volume_ml_[cell]; }
  double iodine_mg_per_ml(std::size_t cell) const { return iodine_mg_per_ml_[cell]; }
  /// Share of contrast agent (not bile) in a cell, 0..1.
  double filling(std::size_t cell) const { return filling_[cell]; }
  double volume_ml() const;    ///< Of all ducts, with their distension.
  double contrast_ml() const;  ///< Contrast agent in the ducts.
  double iodine_mg() const;
  double drained_ml() const { return drained_ml_; }  ///< Bile and contrast agent that left through the papilla.
  double drained_mg() const { return drained_mg_; }
  double refluxed_mg() const { return refluxed_mg_; }
  double displaced_ml() const { return displaced_ml_; }  ///< Bile that gave way to contrast agent, not by the papilla.
  /// Volume of the ducts that a cell reaches without passing an obstruction.
  double reachable_ml(std::size_t cell) const;
  bool has_iodine() const { return is_used_; }
  /// Adds the agent in the cells with at least this concentration, with rounded fronts and ends.
  void add_pieces(double least_mg_per_ml, std::vector<IodinePiece>& pieces) const;

 private:
  /// Cells between obstructions.
  struct Part {
    int papilla = -1;        ///< Cell.
    double rest_ml = 0.0;    ///< Volume without distension.
    double volume_ml = 0.0;  ///< Volume.
    double bile_ml = 0.0;
    double injected = 0.0;  ///< ml/s.
    double bile_out = 0.0;  ///< ml/s of bile that gives way.
    double papilla_out = 0.0;
    double growth = 0.0;
  };

  void sum_parts();
  double set_flows(double dt_s, int cell, double ml_per_s);
  void solve(double dt_s, int cell, double ml_per_s, double iodine_mg_per_ml);

  DuctTree tree_;
  detail::DuctOutline outline_;
  DuctParams params_;
  std::vector<int> part_of_;
  std::vector<Part> parts_;
  std::vector<double> volume_ml_, next_ml_, filling_, iodine_mg_per_ml_;
  std::vector<double> to_parent_;                 ///< Flow of each cell into its parent (ml/s).
  std::vector<double> exchange_, rest_exchange_;  ///< Dispersion at the face to the parent: ml/s per ml/s, ml/s.
  std::vector<double> diagonal_, upper_, lower_;  ///< Of the linear system: a cell, its parent's column, its row.
  double drained_ml_ = 0.0, drained_mg_ = 0.0, refluxed_mg_ = 0.0, displaced_ml_ = 0.0;
  bool is_used_ = false;
};

}  // namespace trocar::xray
