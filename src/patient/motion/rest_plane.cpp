#include "motion/rest_plane.h"

#include <algorithm>
#include <utility>

namespace trocar::motion {
namespace {

constexpr int kStep = 4;

struct Node {
  Vec3 p_A;
  int region;
};

/// Nodes at every kStep-th point of a row and one beyond its end.
void fill_nodes(const PatientMotion& motion, const volume::SlicePlane& plane, int row, std::vector<Node>& nodes) {
  nodes.clear();
  const Vec3 row_P = plane.origin_P + row * plane.step_v_P;
  for (int u = 0; u < plane.columns + kStep; u += kStep) {
    const Vec3 p_A = motion.to_rest(row_P + u * plane.step_u_P);
    nodes.push_back({p_A, motion.region(p_A)});
  }
}

/// A row between two rows of nodes, `t` of the way down.
void fill_row(const PatientMotion& motion, const volume::SlicePlane& plane, int row, const std::vector<Node>& above,
              const std::vector<Node>& below, Vec3f* rest_A) {
  const double t = static_cast<double>(row % kStep) / kStep;
  for (int u = 0; u < plane.columns; ++u) {
    const auto cell = static_cast<std::size_t>(u / kStep);
    const Node &a = above[cell], &b = above[cell + 1], &c = below[cell], &d = below[cell + 1];
    if (a.region != b.region || a.region != c.region || a.region != d.region) {
      rest_A[u] = motion.to_rest(plane.origin_P + row * plane.step_v_P + u * plane.step_u_P).cast<float>();
      continue;
    }
    const double s = static_cast<double>(u % kStep) / kStep;
    const Vec3 left_A = a.p_A + t * (c.p_A - a.p_A), right_A = b.p_A + t * (d.p_A - b.p_A);
    rest_A[u] = (left_A + s * (right_A - left_A)).cast<float>();
  }
}

}  // namespace

void rest_of_plane(const PatientMotion& motion, const volume::SlicePlane& plane, std::vector<Vec3f>& rest_A) {
  const int columns = std::max(plane.columns, 0), rows = std::max(plane.rows, 0);
  rest_A.resize(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  if (rest_A.empty()) return;
  std::vector<Node> above, below;
  fill_nodes(motion, plane, 0, below);
  for (int row = 0; row < rows; ++row) {
    if (row % kStep == 0) {
      std::swap(above, below);
      fill_nodes(motion, plane, row + kStep, below);
    }
    fill_row(motion, plane, row, above, below, rest_A.data() + static_cast<std::ptrdiff_t>(row) * columns);
  }
}

}  // namespace trocar::motion
