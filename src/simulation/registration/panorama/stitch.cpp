#include "registration/panorama/stitch.h"

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/result.h"

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

namespace {

constexpr int kIterations = 40;
constexpr double kDifference = 1e-6;  ///< Of the numerical derivative, rad and mm.

Vector6 motion_vector(const Pose& E, const Vec3& middle) {
  const Eigen::AngleAxisd turn(E.R());
  Vector6 v;
  v << turn.angle() * turn.axis(), E * middle - middle;
  return v;
}

Pose moved(const Pose& X, const Vector6& step) {
  const Vec3 rotation = step.head<3>();
  const double angle = rotation.norm();
  const Mat3 R = angle > 0.0 ? Eigen::AngleAxisd(angle, rotation / angle).toRotationMatrix() : Mat3::Identity();
  return {Eigen::Quaterniond(X.R() * R).normalized().toRotationMatrix(), X.p() + step.tail<3>()};
}

/// Difference of an edge's motion from that of the poses, in A.
Vector6 difference_of(const PoseEdge& edge, const Pose& X_0A, const Pose& X_0B) {
  return motion_vector(X_0A.inverse() * X_0B * edge.X_AB.inverse(), edge.middle_A);
}

double length_mm(const Vector6& difference, double arm_mm) {
  return difference.tail<3>().norm() + arm_mm * difference.head<3>().norm();
}

class Solver {
 public:
  Solver(std::size_t nodes, const std::vector<PoseEdge>& edges, const PoseGraphOptions& options)
      : edges_(edges), options_(options), X_(nodes), used_(edges.size(), true) {
    for (const PoseEdge& edge : edges) roots_.push_back(root_of(edge.information));
  }

  /// Poses along the tree of the strongest edges in use, from the first node.
  void grow_tree() {
    X_.assign(X_.size(), std::nullopt);
    if (X_.empty()) return;
    X_[0] = Pose();
    std::vector<std::size_t> order(edges_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t x, std::size_t y) { return edges_[x].strength > edges_[y].strength; });
    for (bool has_grown = true; has_grown;) {
      has_grown = false;
      for (const std::size_t e : order) {
        const PoseEdge& edge = edges_[e];
        if (!used_[e] || X_[edge.a].has_value() == X_[edge.b].has_value()) continue;
        if (X_[edge.a]) {
          X_[edge.b] = *X_[edge.a] * edge.X_AB;
        } else {
          X_[edge.a] = *X_[edge.b] * edge.X_AB.inverse();
        }
        has_grown = true;
        break;  // the strongest first
      }
    }
  }

  void solve() {
    std::vector<std::size_t> free;  // nodes with a pose, without the first
    for (std::size_t n = 1; n < X_.size(); ++n)
      if (X_[n]) free.push_back(n);
    if (free.empty()) return;
    std::vector<Eigen::Index> column(X_.size(), -1);
    for (std::size_t n = 0; n < free.size(); ++n) column[free[n]] = static_cast<Eigen::Index>(6 * n);
    double damping = 1e-4, cost = cost_of(X_);
    for (int iteration = 0; iteration < kIterations && damping < 1e8; ++iteration) {
      Eigen::MatrixXd H =
          Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(6 * free.size()), static_cast<Eigen::Index>(6 * free.size()));
      Eigen::VectorXd g = Eigen::VectorXd::Zero(H.rows());
      for (std::size_t e = 0; e < edges_.size(); ++e)
        if (is_active(e)) add_edge(e, column, H, g);
      H.diagonal() *= 1.0 + damping;
      const Eigen::VectorXd step = H.ldlt().solve(-g);
      auto next = X_;
      for (std::size_t n = 0; n < free.size(); ++n)
        next[free[n]] = moved(*X_[free[n]], step.segment<6>(static_cast<Eigen::Index>(6 * n)));
      const double next_cost = cost_of(next);
      if (!(next_cost < cost)) {
        damping *= 10.0;
        continue;
      }
      const bool is_done = cost - next_cost < 1e-12 * cost;
      X_ = std::move(next);
      cost = next_cost;
      damping *= 0.1;
      if (is_done) break;
    }
  }

  double contradiction_mm(std::size_t e) const {
    return is_active(e) ? length_mm(difference_of(edges_[e], *X_[edges_[e].a], *X_[edges_[e].b]), options_.arm_mm)
                        : 0.0;
  }

  /// Removes the weakest of the edges that contradict most; false if none does.
  bool remove_worst() {
    double worst_mm = options_.largest_mm;
    for (std::size_t e = 0; e < edges_.size(); ++e) worst_mm = std::max(worst_mm, contradiction_mm(e));
    if (worst_mm <= options_.largest_mm) return false;
    std::optional<std::size_t> weakest;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (contradiction_mm(e) < std::max(options_.largest_mm, 0.3 * worst_mm)) continue;
      if (!weakest || edges_[e].strength < edges_[*weakest].strength) weakest = e;
    }
    used_[*weakest] = false;
    removed_.push_back(*weakest);
    return true;
  }

  const std::vector<std::optional<Pose>>& poses() const { return X_; }
  const std::vector<std::size_t>& removed() const { return removed_; }

 private:
  static Matrix6 root_of(const Matrix6& information) {
    const Eigen::LLT<Matrix6> cholesky(information);
    return cholesky.info() == Eigen::Success ? Matrix6(cholesky.matrixU()) : Matrix6(Matrix6::Identity());
  }
  bool is_active(std::size_t e) const { return used_[e] && X_[edges_[e].a] && X_[edges_[e].b]; }

  double weight_of(const Vector6& difference) const {
    const double ratio = length_mm(difference, options_.arm_mm) / options_.robust_mm;
    return 1.0 / (1.0 + ratio * ratio);
  }
  double cost_of(const std::vector<std::optional<Pose>>& X) const {
    double sum = 0.0;
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      if (!is_active(e)) continue;
      const Vector6 d = difference_of(edges_[e], *X[edges_[e].a], *X[edges_[e].b]);
      const double ratio = length_mm(d, options_.arm_mm) / options_.robust_mm;
      // Cauchy's cost over the squared length, times the measured precision.
      sum += (roots_[e] * d).squaredNorm() * (ratio > 1e-9 ? std::log1p(ratio * ratio) / (ratio * ratio) : 1.0);
    }
    return sum;
  }

  void add_edge(std::size_t e, const std::vector<Eigen::Index>& column, Eigen::MatrixXd& H, Eigen::VectorXd& g) const {
    const PoseEdge& edge = edges_[e];
    const Vector6 difference = difference_of(edge, *X_[edge.a], *X_[edge.b]);
    const double root_weight = std::sqrt(weight_of(difference));
    Matrix6 by_a, by_b;
    for (int p = 0; p < 6; ++p) {
      Vector6 step = Vector6::Zero();
      step[p] = kDifference;
      by_a.col(p) = (difference_of(edge, moved(*X_[edge.a], step), *X_[edge.b]) - difference) / kDifference;
      by_b.col(p) = (difference_of(edge, *X_[edge.a], moved(*X_[edge.b], step)) - difference) / kDifference;
    }
    const Matrix6 root = root_weight * roots_[e];
    const Vector6 r = root * difference;
    const Matrix6 J[2] = {root * by_a, root * by_b};
    const Eigen::Index at[2] = {column[edge.a], column[edge.b]};
    for (int x = 0; x < 2; ++x) {
      if (at[x] < 0) continue;
      g.segment<6>(at[x]) += J[x].transpose() * r;
      for (int y = 0; y < 2; ++y)
        if (at[y] >= 0) H.block<6, 6>(at[x], at[y]) += J[x].transpose() * J[y];
    }
  }

  const std::vector<PoseEdge>& edges_;
  const PoseGraphOptions& options_;
  std::vector<std::optional<Pose>> X_;
  std::vector<bool> used_;
  std::vector<Matrix6> roots_;
  std::vector<std::size_t> removed_;
};

}  // namespace

PoseGraph solve_pose_graph(std::size_t nodes, const std::vector<PoseEdge>& edges, const PoseGraphOptions& options) {
  TROCAR_CHECK(options.arm_mm > 0.0 && options.largest_mm > 0.0 && options.robust_mm > 0.0);
  Solver solver(nodes, edges, options);
  do {
    solver.grow_tree();
    solver.solve();
  } while (solver.remove_worst());
  PoseGraph graph;
  graph.X_0N = solver.poses();
  graph.removed = solver.removed();
  for (std::size_t e = 0; e < edges.size(); ++e) graph.contradiction_mm.push_back(solver.contradiction_mm(e));
  return graph;
}

}  // namespace trocar::registration
