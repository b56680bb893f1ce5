#pragma once

#include <vector>

#include "anatomy/patient.h"
#include "volume/grid.h"

namespace trocar::xray {

/// Kind of the end of a duct.
enum class DuctEnd : unsigned char {
  kNone,        ///< It goes on.
  kPeripheral,  ///< Ends in the organ, in the gallbladder, or where the label ends.
  kPapilla,     ///< Open into the bowel.
  kObstructed,  ///< Closed by a tumour.
};

/// A piece of a duct: a truncated cone between two nodes of the tree.
struct DuctCell {
  Vec3 a_P = Vec3::Zero(), b_P = Vec3::Zero();  ///< a: towards the root.
  double radius_a_mm = 1.0, radius_b_mm = 1.0;
  int parent = -1;               ///< Cell at a; smaller than the cell's own index; -1: the first cell of a tree.
  bool is_closed = false;        ///< Nothing flows between this cell and its parent: an obstruction.
  DuctEnd end = DuctEnd::kNone;  ///< Kind of the end at b; that at a of a cell without parent: `root_end`.
  DuctEnd root_end = DuctEnd::kNone;

  double length_mm() const { return (b_P - a_P).norm(); }
  double volume_ml() const;  ///< Of the cone without round ends.
};

/// Bile ducts as a graph without loops. Frame P. The volume of all cells is that of the labels.
struct DuctTree {
  std::vector<DuctCell> cells;

  double volume_ml() const;
  /// Cell whose tube contains a point or is nearest to it, if its wall is not farther than `within_mm`; -1: none.
  int find_cell(const Vec3& p_P, double within_mm) const;
};

struct DuctTreeOptions {
  double bridge_mm = 4.0;      ///< Gaps in the label up to this width are bridged. Range 0..20.
  double finest_mm = 0.8;      ///< Finest grid for the centrelines. Range 0.3..3.
  double encased_share = 0.3;  ///< A duct is closed at its narrowest place where this share of its circumference
                               ///< touches a lesion. Assumed, range 0.2..1.
};

/// Ducts from all labels of the tissue "bile_duct", by centrelines (volume/centreline.h) of the joined labels: pieces
/// that lie apart by at most `bridge_mm` are joined, smaller pieces than 20 mm³ that lie farther away are left out. A
/// branch's radii are scaled so that its volume is that of its voxels. The papilla is the widest end that touches
/// bowel. Empty if the patient has no such label.
DuctTree make_duct_tree(const anatomy::VirtualPatient& patient, const DuctTreeOptions& options = {});

}  // namespace trocar::xray
