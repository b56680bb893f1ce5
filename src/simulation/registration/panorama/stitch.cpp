#include "registration/panorama/stitch.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace trocar::registration {
namespace {

constexpr double kFarthest_mm = 3.0;        ///< A refinement that moves a pair farther found another maximum.
constexpr double kLeastEdgeOverlap = 0.05;  ///< Of a pair that is refined by its poses in the graph.

PoseEdge to_edge(const PairRegistration& pair) {
  PoseEdge edge;
  edge.a = pair.a;
  edge.b = pair.b;
  edge.X_AB = pair.X_AB;
  edge.information = pair.information;
  edge.middle_A = pair.middle_A;
  edge.strength = pair.significance;
  return edge;
}

Result<std::vector<PairRegistration>> register_pairs(const std::vector<PreparedVolume>& volumes,
                                                     const PairOptions& options, const Progress& progress) {
  std::vector<PairRegistration> pairs;
  const double count = 0.5 * static_cast<double>(volumes.size() * (volumes.size() - 1));
  for (std::size_t a = 0; a < volumes.size(); ++a) {
    for (std::size_t b = a + 1; b < volumes.size(); ++b) {
      report(progress, "registering pairs", 0.8 * static_cast<double>(pairs.size()) / count);
      TROCAR_TRY(PairRegistration pair, register_pair(volumes[a], volumes[b], options));
      pair.a = a;
      pair.b = b;
      pairs.push_back(std::move(pair));
    }
  }
  return pairs;
}

double motion_mm(const Pose& X, const Pose& Y, const Vec3& middle_A, double arm_mm) {
  const Pose E = X * Y.inverse();
  return (E * middle_A - middle_A).norm() + arm_mm * Eigen::AngleAxisd(E.R()).angle();
}

/// Edges of all pairs that overlap at the poses of the graph, refined from there.
std::vector<PoseEdge> refine_edges(const std::vector<PreparedVolume>& volumes, const PoseGraph& graph,
                                   const StitchOptions& options, const Progress& progress) {
  std::vector<PoseEdge> edges;
  for (std::size_t a = 0; a < volumes.size(); ++a) {
    report(progress, "refining all pairs", 0.8 + 0.2 * static_cast<double>(a) / static_cast<double>(volumes.size()));
    for (std::size_t b = a + 1; b < volumes.size(); ++b) {
      if (!graph.X_0N[a] || !graph.X_0N[b]) continue;
      const Pose X_AB = graph.X_0N[a]->inverse() * *graph.X_0N[b];
      const Alignment refined = refine_pair(volumes[a], volumes[b], X_AB);
      if (refined.ncc <= 0.0 || refined.overlap < kLeastEdgeOverlap) continue;
      if (motion_mm(refined.X_AB, X_AB, refined.middle_A, options.graph.arm_mm) > kFarthest_mm) continue;
      PoseEdge edge;
      edge.a = a;
      edge.b = b;
      edge.X_AB = refined.X_AB;
      edge.information = refined.information;
      edge.middle_A = refined.middle_A;
      edge.strength = refined.ncc * refined.overlap;
      edges.push_back(edge);
    }
  }
  return edges;
}

}  // namespace

Result<Stitching> stitch(const std::vector<PreparedVolume>& volumes, const StitchOptions& options,
                         const Progress& progress) {
  if (volumes.size() < 2) return fail_usage("fewer than two volumes", {}, "give two or more volumes");
  TROCAR_TRY(std::vector<PairRegistration> pairs, register_pairs(volumes, options.pair, progress));
  std::vector<PoseEdge> edges;
  for (const PairRegistration& pair : pairs)
    if (pair.is_found) edges.push_back(to_edge(pair));
  PoseGraph graph = solve_pose_graph(volumes.size(), edges, options.graph);
  Stitching result;
  std::size_t found = 0;
  for (PairRegistration& pair : pairs) {
    StitchEdge edge;
    if (pair.is_found) {
      edge.is_used = std::find(graph.removed.begin(), graph.removed.end(), found) == graph.removed.end();
      edge.contradiction_mm = graph.contradiction_mm[found++];
    }
    edge.pair = std::move(pair);
    result.edges.push_back(std::move(edge));
  }
  const PoseGraph refined =
      solve_pose_graph(volumes.size(), refine_edges(volumes, graph, options, progress), options.graph);
  for (std::size_t n = 0; n < volumes.size(); ++n)
    result.X_0N.push_back(refined.X_0N[n] ? refined.X_0N[n] : graph.X_0N[n]);
  report(progress, "done", 1.0);
  return result;
}

}  // namespace trocar::registration
