#include "motion_builder/detail/displacement_solver.h"

#include <algorithm>
#include <cmath>

namespace trocar::motion_builder::detail {
namespace {

using Field = std::vector<Vec3f>;

/// The symmetric operator of the energy.
class Operator {
 public:
  explicit Operator(const DisplacementProblem& problem) : problem_(problem), size_(problem.lattice.size) {
    steps_ = {1, size_[0], size_[0] * size_[1]};
    for (std::size_t corner = 0; corner < 8; ++corner)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const bool is_far = (corner >> axis & 1U) != 0;
        corner_steps_[corner] += is_far ? steps_[axis] : 0;
        corner_slopes_[corner][static_cast<Eigen::Index>(axis)] = is_far ? 0.25F : -0.25F;
      }
  }

  void apply(const Displacements& u, Displacements& result) const {
    for (std::size_t region = 0; region < kRegions; ++region) {
      result[region].assign(u[region].size(), Vec3f::Zero());
      add_edges(problem_.nodes[region], u[region], result[region]);
      add_cells(problem_.nodes[region], u[region], result[region]);
      for (std::size_t n = 0; n < u[region].size(); ++n)
        result[region][n] += problem_.nodes[region][n].pull * u[region][n];
    }
    for (std::size_t n = 0; n < problem_.border.size(); ++n) {
      const DisplacementProblem::Border& border = problem_.border[n];
      if (border.strength == 0.0F) continue;
      const Vec3f pushed = border.strength * border.normal.dot(u[1][n] - u[0][n]) * border.normal;
      result[1][n] += pushed;
      result[0][n] -= pushed;
    }
  }

  /// Inverse of about the diagonal.
  std::array<std::vector<float>, kRegions> preconditioner() const {
    std::array<std::vector<float>, kRegions> inverse;
    for (std::size_t region = 0; region < kRegions; ++region)
      for (std::size_t n = 0; n < problem_.border.size(); ++n) {
        const DisplacementProblem::Node& node = problem_.nodes[region][n];
        constexpr float kEdges = 6.0F, kCells = 8.0F / 16.0F;
        const float diagonal =
            kEdges * node.stiffness + node.pull + kCells * node.bulk + problem_.border[n].strength / 3.0F;
        inverse[region].push_back(1.0F / std::max(diagonal, 1e-6F));
      }
    return inverse;
  }

 private:
  using Nodes = std::vector<DisplacementProblem::Node>;

  void add_edges(const Nodes& nodes, const Field& u, Field& result) const {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for_each_node(axis, [&](std::size_t n) {
        const std::size_t next = n + static_cast<std::size_t>(steps_[axis]);
        // Soft beside stiff: the edge is as soft as the softer node.
        const float stiffness = std::min(nodes[n].stiffness, nodes[next].stiffness);
        const Vec3f force = stiffness * (u[n] - u[next]);
        result[n] += force;
        result[next] -= force;
      });
  }

  void add_cells(const Nodes& nodes, const Field& u, Field& result) const {
    for (std::int64_t k = 0; k + 1 < size_[2]; ++k)
      for (std::int64_t j = 0; j + 1 < size_[1]; ++j)
        for (std::int64_t i = 0; i + 1 < size_[0]; ++i) {
          const auto n = static_cast<std::size_t>(i + j * steps_[1] + k * steps_[2]);
          if (nodes[n].bulk == 0.0F) continue;
          float divergence = 0.0F;
          for (std::size_t c = 0; c < 8; ++c)
            divergence += corner_slopes_[c].dot(u[n + static_cast<std::size_t>(corner_steps_[c])]);
          for (std::size_t c = 0; c < 8; ++c)
            result[n + static_cast<std::size_t>(corner_steps_[c])] += nodes[n].bulk * divergence * corner_slopes_[c];
        }
  }

  template <class Visit>
  void for_each_node(std::size_t without_last_along, const Visit& visit) const {
    volume::Index3 end = size_;
    --end[without_last_along];
    for (std::int64_t k = 0; k < end[2]; ++k)
      for (std::int64_t j = 0; j < end[1]; ++j)
        for (std::int64_t i = 0; i < end[0]; ++i) visit(static_cast<std::size_t>(i + j * steps_[1] + k * steps_[2]));
  }

  const DisplacementProblem& problem_;
  volume::Index3 size_;
  std::array<std::int64_t, 3> steps_{};
  std::array<std::int64_t, 8> corner_steps_{};
  std::array<Vec3f, 8> corner_slopes_;
};

double dot(const Displacements& a, const Displacements& b) {
  double sum = 0.0;
  for (std::size_t region = 0; region < kRegions; ++region)
    for (std::size_t n = 0; n < a[region].size(); ++n) sum += static_cast<double>(a[region][n].dot(b[region][n]));
  return sum;
}

/// target += factor * other
void add(Displacements& target, float factor, const Displacements& other) {
  for (std::size_t region = 0; region < kRegions; ++region)
    for (std::size_t n = 0; n < target[region].size(); ++n) target[region][n] += factor * other[region][n];
}

}  // namespace

Displacements solve(const DisplacementProblem& problem, const Displacements& start, int most_steps, double tolerance) {
  const Operator energy(problem);
  const auto inverse = energy.preconditioner();
  Displacements u = start, applied, residual;
  for (std::size_t region = 0; region < kRegions; ++region) {
    u[region].resize(problem.nodes[region].size(), Vec3f::Zero());
    for (const DisplacementProblem::Node& node : problem.nodes[region])
      residual[region].push_back(node.pull * node.target_mm);
  }
  const double first = dot(residual, residual);
  energy.apply(u, applied);
  add(residual, -1.0F, applied);
  const auto precondition = [&](const Displacements& from) {
    Displacements to = from;
    for (std::size_t region = 0; region < kRegions; ++region)
      for (std::size_t n = 0; n < to[region].size(); ++n) to[region][n] *= inverse[region][n];
    return to;
  };
  Displacements z = precondition(residual), direction = z;
  double progress = dot(residual, z);
  for (int step = 0; step < most_steps && dot(residual, residual) > tolerance * tolerance * first; ++step) {
    energy.apply(direction, applied);
    const double length = progress / dot(direction, applied);
    add(u, static_cast<float>(length), direction);
    add(residual, -static_cast<float>(length), applied);
    z = precondition(residual);
    const double next = dot(residual, z);
    const auto share = static_cast<float>(next / progress);
    for (std::size_t region = 0; region < kRegions; ++region)
      for (std::size_t n = 0; n < direction[region].size(); ++n)
        direction[region][n] = z[region][n] + share * direction[region][n];
    progress = next;
  }
  return u;
}

}  // namespace trocar::motion_builder::detail
