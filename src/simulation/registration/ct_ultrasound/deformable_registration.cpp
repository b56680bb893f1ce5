#include "registration/ct_ultrasound/deformable_registration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <vector>

#include "core/parallel.h"
#include "registration/ct_ultrasound/detail/sampled_information.h"
#include "registration/ct_ultrasound/detail/working_images.h"
#include "volume/sampling.h"

namespace trocar::registration {
namespace {

constexpr std::size_t kFieldSamples = 60000;
constexpr double kUs_mm = 1.5, kCt_mm = 0.8;  ///< Smoothing.
constexpr double kLeastJacobian = 0.1;
constexpr std::size_t kMemory = 6;     ///< Steps that the optimiser remembers.
constexpr double kFirstStep_mm = 0.5;  ///< Largest displacement of a node in the first step.
constexpr double kLongestStep_mm = 4.0;
constexpr std::uint64_t kSampleSeed = 21;

using Numbers = Eigen::VectorXd;

/// Nodes for a box with the whole grid inside the domain.
volume::GridGeometry lattice_over(const volume::GridGeometry& grid, double node_mm) {
  volume::GridGeometry lattice = grid;
  lattice.spacing_mm = Vec3::Constant(node_mm);
  Vec3 first;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<int>(a);
    const double extent_mm = static_cast<double>(grid.size[a]) * grid.spacing_mm[axis];
    const auto cells = static_cast<std::int64_t>(std::ceil(extent_mm / node_mm));
    lattice.size[a] = cells + 4;
    const double spare_mm = static_cast<double>(cells) * node_mm - extent_mm;
    first[axis] = -(0.5 * spare_mm + 1.5 * node_mm) / grid.spacing_mm[axis] - 0.5;
  }
  lattice.origin_P = grid.to_mm(first);
  return lattice;
}

struct SplineSample {
  Vec3 p;
  volume::SplineWeights weights;
};

/// Cost of a field (-I + bending energy) and its gradient by the coefficients.
class Cost {
 public:
  Cost(const detail::Level& level, const volume::GridGeometry& lattice, const std::vector<Vec3>& points,
       double bending_per_mm2)
      : level_(level),
        bending_per_mm2_(bending_per_mm2 / static_cast<double>(lattice.voxel_count())),
        information_(contrasts(level.us, points)) {
    field_.lattice = lattice;
    field_.coefficients_mm.assign(lattice.voxel_count(), Vec3::Zero());
    for (const Vec3& p : points) samples_.push_back({p, volume::spline_weights(lattice, p)});
  }

  std::size_t size() const { return 3 * field_.coefficients_mm.size(); }
  volume::SplineField field(const Numbers& x) const {
    volume::SplineField result = field_;
    for (std::size_t n = 0; n < result.coefficients_mm.size(); ++n)
      result.coefficients_mm[n] = x.segment<3>(static_cast<Eigen::Index>(3 * n));
    return result;
  }

  double evaluate(const Numbers& x, Numbers& gradient) {
    const volume::SplineField field = this->field(x);
    std::vector<double> values(samples_.size());
    std::vector<Vec3> slopes_mm(samples_.size());
    parallel_for(samples_.size(), 1024, [&](std::size_t first, std::size_t last) {
      for (std::size_t n = first; n < last; ++n) {
        const Vec3 q = samples_[n].p + volume::displacement_at(field, samples_[n].p);
        values[n] = volume::sample_linear(level_.ct, q);
        slopes_mm[n] = volume::gradient_per_mm(level_.ct, q);
      }
    });
    std::vector<double> slopes;
    information_value = information_.evaluate(values, slopes);
    gradient = Numbers::Zero(x.size());
    for (std::size_t n = 0; n < samples_.size(); ++n) add_sample(n, -slopes[n] * slopes_mm[n], gradient);
    return add_bending(x, gradient) - information_value;
  }

  double information_value = 0.0;  ///< Of the last evaluation.

 private:
  static std::vector<float> contrasts(const volume::FloatGrid& us, const std::vector<Vec3>& points) {
    std::vector<float> values;
    for (const Vec3& p : points) values.push_back(static_cast<float>(volume::sample_linear(us, p)));
    return values;
  }

  void add_sample(std::size_t n, const Vec3& slope, Numbers& gradient) const {
    const volume::SplineWeights& w = samples_[n].weights;
    if (!w.is_inside) return;
    for (std::int64_t c = 0; c < 4; ++c)
      for (std::int64_t b = 0; b < 4; ++b)
        for (std::int64_t a = 0; a < 4; ++a) {
          const std::size_t node = field_.lattice.offset({w.first[0] + a, w.first[1] + b, w.first[2] + c});
          gradient.segment<3>(static_cast<Eigen::Index>(3 * node)) += w.weight[0][static_cast<std::size_t>(a)] *
                                                                      w.weight[1][static_cast<std::size_t>(b)] *
                                                                      w.weight[2][static_cast<std::size_t>(c)] * slope;
        }
  }

  /// Adds weight * mean over nodes of the squared second differences (mixed ones twice), and its gradient.
  double add_bending(const Numbers& x, Numbers& gradient) const {
    const auto& size = field_.lattice.size;
    double energy = 0.0;
    for (std::size_t n = 0; n < field_.coefficients_mm.size(); ++n) {
      const volume::Index3 at = field_.lattice.index_of(n);
      for (std::size_t a = 0; a < 3; ++a) {
        if (at[a] > 0 && at[a] + 1 < size[a])
          energy += add_difference({{moved(at, a, -1), 1.0}, {at, -2.0}, {moved(at, a, 1), 1.0}}, 1.0, x, gradient);
        const std::size_t b = (a + 1) % 3;
        if (at[a] + 1 < size[a] && at[b] + 1 < size[b])
          energy += add_difference(
              {{at, 1.0}, {moved(at, a, 1), -1.0}, {moved(at, b, 1), -1.0}, {moved(moved(at, a, 1), b, 1), 1.0}}, 2.0,
              x, gradient);
      }
    }
    return energy;
  }

  struct Term {
    volume::Index3 node;
    double factor;
  };
  static volume::Index3 moved(volume::Index3 node, std::size_t axis, std::int64_t step) {
    node[axis] += step;
    return node;
  }
  double add_difference(std::initializer_list<Term> terms, double times, const Numbers& x, Numbers& gradient) const {
    const auto start = [&](const Term& term) {
      return static_cast<Eigen::Index>(3 * field_.lattice.offset(term.node));
    };
    Vec3 sum = Vec3::Zero();
    for (const Term& term : terms) sum += term.factor * x.segment<3>(start(term));
    const double weight = times * bending_per_mm2_;
    for (const Term& term : terms) gradient.segment<3>(start(term)) += 2.0 * weight * term.factor * sum;
    return weight * sum.squaredNorm();
  }

  const detail::Level& level_;
  double bending_per_mm2_;
  detail::SampledInformation information_;
  volume::SplineField field_;
  std::vector<SplineSample> samples_;
};

/// Descent directions of the limited-memory BFGS method (Nocedal, Math Comput 35:773, 1980).
class Memory {
 public:
  void add(const Numbers& step, const Numbers& change) {
    if (step.dot(change) <= 1e-12 * step.norm() * change.norm()) return;
    pairs_.push_back({step, change});
    if (pairs_.size() > kMemory) pairs_.pop_front();
  }
  Numbers direction(const Numbers& gradient) const {
    Numbers q = gradient;
    std::vector<double> shares(pairs_.size());
    for (std::size_t n = pairs_.size(); n-- > 0;) {
      shares[n] = pairs_[n].step.dot(q) / pairs_[n].step.dot(pairs_[n].change);
      q -= shares[n] * pairs_[n].change;
    }
    q *= pairs_.empty() ? kFirstStep_mm / std::max(gradient.cwiseAbs().maxCoeff(), 1e-12)
                        : pairs_.back().step.dot(pairs_.back().change) / pairs_.back().change.squaredNorm();
    for (std::size_t n = 0; n < pairs_.size(); ++n)
      q += (shares[n] - pairs_[n].change.dot(q) / pairs_[n].step.dot(pairs_[n].change)) * pairs_[n].step;
    const double largest = q.cwiseAbs().maxCoeff();
    return largest > kLongestStep_mm ? Numbers(-q * (kLongestStep_mm / largest)) : Numbers(-q);
  }
  bool is_empty() const { return pairs_.empty(); }
  void clear() { pairs_.clear(); }

 private:
  struct Pair {
    Numbers step, change;
  };
  std::deque<Pair> pairs_;
};

/// Lowers the cost from zero displacements; at most `most_steps` steps. Each step is halved until the cost falls.
Numbers minimise(Cost& cost, const DeformableOptions& options, const Progress& progress) {
  constexpr int kMostHalvings = 8;
  constexpr double kEnough = 1e-4;  ///< Share of the expected fall of the cost.
  Numbers x = Numbers::Zero(static_cast<Eigen::Index>(cost.size()));
  Numbers gradient;
  double value = cost.evaluate(x, gradient);
  Memory memory;
  for (int step = 0; step < options.most_steps; ++step) {
    if (options.is_cancelled && options.is_cancelled()) break;
    report(progress, "deforming", static_cast<double>(step) / options.most_steps);
    Numbers direction = memory.direction(gradient);
    double length = 1.0;
    Numbers next, next_gradient;
    double next_value = value;
    int halvings = 0;
    for (; halvings < kMostHalvings; ++halvings, length *= 0.5) {
      next = x + length * direction;
      next_value = cost.evaluate(next, next_gradient);
      if (next_value < value + kEnough * length * gradient.dot(direction)) break;
    }
    if (halvings == kMostHalvings) {
      if (memory.is_empty()) break;
      memory.clear();
      continue;
    }
    memory.add(next - x, next_gradient - gradient);
    const double fall = value - next_value;
    x = next;
    gradient = next_gradient;
    value = next_value;
    if (fall < 1e-6) break;
  }
  return x;
}

}  // namespace

Result<DeformableRegistration> register_deformable(const volume::CtGrid& ct, const volume::LabelGrid& us,
                                                   const Beams& beams, const Pose& X_CU,
                                                   const DeformableOptions& options, const Progress& progress) {
  TROCAR_TRY(const detail::WorkingUltrasound prepared, detail::prepare_ultrasound(us, beams));
  volume::FloatGrid ct_U = detail::prepare_ct(ct, X_CU * prepared.centre, prepared.radius_mm);
  const Pose X_UC = X_CU.inverse();
  ct_U.geometry.origin_P = X_UC * ct_U.geometry.origin_P;
  ct_U.geometry.R_PV = X_UC.R() * ct_U.geometry.R_PV;
  const detail::Level level = detail::make_level(prepared, ct_U, kUs_mm, kCt_mm, 1);
  const std::vector<Vec3> points = detail::sample_usable(prepared, kFieldSamples, options.seed ^ kSampleSeed);
  Cost cost(level, lattice_over(us.geometry, options.node_mm), points, options.bending_per_mm2);

  DeformableRegistration result;
  Numbers gradient;
  cost.evaluate(Numbers::Zero(static_cast<Eigen::Index>(cost.size())), gradient);
  result.metric_before = cost.information_value;
  const Numbers x = minimise(cost, options, progress);
  if (options.is_cancelled && options.is_cancelled())
    return fail("the registration was cancelled", {}, "start it again");
  cost.evaluate(x, gradient);
  result.metric = cost.information_value;
  result.field_U = cost.field(x);
  for (const Vec3& p : points) {
    const double moved_mm = volume::displacement_at(result.field_U, p).norm();
    result.mean_mm += moved_mm / static_cast<double>(points.size());
    result.largest_mm = std::max(result.largest_mm, moved_mm);
    result.least_jacobian = std::min(result.least_jacobian, volume::jacobian_at(result.field_U, p));
  }
  if (result.least_jacobian < kLeastJacobian)
    return fail(fmt::format("the deformation folds space (least Jacobian {:.2f})", result.least_jacobian), {},
                "use the rigid result");
  return result;
}

}  // namespace trocar::registration
