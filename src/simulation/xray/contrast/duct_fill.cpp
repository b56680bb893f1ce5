#include "xray/contrast/duct_fill.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace trocar::xray {
namespace {

constexpr double kLeastBetween_mm = 0.1;  ///< Between the middles of two cells.

}  // namespace

DuctFill::DuctFill(DuctTree tree, const DuctParams& params) : tree_(std::move(tree)), outline_(tree_), params_(params) {
  const std::size_t count = tree_.cells.size();
  part_of_.assign(count, 0);
  exchange_.assign(count, 0.0);
  rest_exchange_.assign(count, 0.0);
  for (std::size_t n = 0; n < count; ++n) {
    const DuctCell& cell = tree_.cells[n];
    volume_ml_.push_back(cell.volume_ml());
    const bool is_new = cell.parent < 0 || cell.is_closed;
    if (is_new) parts_.emplace_back();
    part_of_[n] = is_new ? static_cast<int>(parts_.size()) - 1 : part_of_[static_cast<std::size_t>(cell.parent)];
    Part& part = parts_[static_cast<std::size_t>(part_of_[n])];
    if (cell.end == DuctEnd::kPapilla || cell.root_end == DuctEnd::kPapilla) part.papilla = static_cast<int>(n);
    part.rest_ml += volume_ml_.back();
    if (is_new) continue;
    const DuctCell& parent = tree_.cells[static_cast<std::size_t>(cell.parent)];
    const double length_mm = std::max(0.5 * (cell.length_mm() + parent.length_mm()), kLeastBetween_mm);
    const double radius_mm = std::min(cell.radius_a_mm, parent.radius_b_mm);
    exchange_[n] = params_.dispersivity_mm / length_mm;
    rest_exchange_[n] = params_.mixing_mm2_per_s * std::numbers::pi * radius_mm * radius_mm / length_mm / kMm3PerMl;
  }
  next_ml_ = volume_ml_;
  filling_.assign(count, 0.0);
  iodine_mg_per_ml_.assign(count, 0.0);
  to_parent_.assign(count, 0.0);
  diagonal_.assign(count, 0.0);
  upper_.assign(count, 0.0);
  lower_.assign(count, 0.0);
}

void DuctFill::step(double dt_s, int cell, double ml_per_s, double iodine_mg_per_ml) {
  const bool injects = cell >= 0 && ml_per_s > 0.0;
  if (!injects && !is_used_) return;
  is_used_ = true;
  sum_parts();
  const double refluxed = set_flows(dt_s, injects ? cell : -1, ml_per_s);
  refluxed_mg_ += dt_s * refluxed * iodine_mg_per_ml;
  solve(dt_s, injects ? cell : -1, ml_per_s - refluxed, iodine_mg_per_ml);
}

void DuctFill::sum_parts() {
  for (Part& part : parts_) part = {part.papilla, part.rest_ml, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  for (std::size_t n = 0; n < tree_.cells.size(); ++n) {
    Part& part = parts_[static_cast<std::size_t>(part_of_[n])];
    part.volume_ml += volume_ml_[n];
    part.bile_ml += volume_ml_[n] * std::max(1.0 - filling_[n], 0.0);
  }
}

/// Flows between the cells from the balance of volume; returns the part of the injection (ml/s) that does not fit.
double DuctFill::set_flows(double dt_s, int cell, double ml_per_s) {
  double refluxed = 0.0;
  for (std::size_t p = 0; p < parts_.size(); ++p) {
    Part& part = parts_[p];
    if (cell >= 0 && part_of_[static_cast<std::size_t>(cell)] == static_cast<int>(p)) part.injected = ml_per_s;
    const bool is_open = part.papilla >= 0;
    const double share = is_open ? params_.papilla_share : 0.0;
    part.bile_out = std::min(part.injected * (1.0 - share), part.bile_ml / dt_s);
    const double rest = part.injected - part.bile_out;
    if (is_open) {
      part.papilla_out = rest + part.volume_ml / params_.drain_s;
    } else {
      const double room_ml = std::max(part.rest_ml * (1.0 + params_.distension) - part.volume_ml, 0.0);
      part.growth = std::min(rest, room_ml / dt_s);
      refluxed += rest - part.growth;
    }
    displaced_ml_ += dt_s * part.bile_out;
  }
  // Each cell's own balance, then the sums over all cells beyond.
  for (std::size_t n = 0; n < tree_.cells.size(); ++n) {
    const Part& part = parts_[static_cast<std::size_t>(part_of_[n])];
    const double share = volume_ml_[n] / part.volume_ml;
    const double bile_ml = volume_ml_[n] * std::max(1.0 - filling_[n], 0.0);
    double surplus = -part.growth * share;
    if (part.bile_ml > 0.0) surplus -= part.bile_out * bile_ml / part.bile_ml;
    if (part.papilla >= 0) surplus += volume_ml_[n] / params_.drain_s;
    if (part.papilla == static_cast<int>(n)) surplus -= part.papilla_out;
    if (cell == static_cast<int>(n)) surplus += ml_per_s - refluxed;
    to_parent_[n] = surplus;
    next_ml_[n] = volume_ml_[n] + dt_s * part.growth * share;
  }
  for (std::size_t n = tree_.cells.size(); n-- > 0;) {
    const DuctCell& at = tree_.cells[n];
    if (at.parent < 0 || at.is_closed) {
      to_parent_[n] = 0.0;  // the balance of a whole part
      continue;
    }
    to_parent_[static_cast<std::size_t>(at.parent)] += to_parent_[n];
  }
  return refluxed;
}

/// One implicit step of filling and iodine. The system has the tree's shape, so that elimination from the leaves to the
/// roots needs no further entries.
void DuctFill::solve(double dt_s, int cell, double ml_per_s, double iodine_mg_per_ml) {
  const std::size_t count = tree_.cells.size();
  for (std::size_t n = 0; n < count; ++n) {
    diagonal_[n] = next_ml_[n];
    filling_[n] *= volume_ml_[n];
    iodine_mg_per_ml_[n] *= volume_ml_[n];
  }
  if (cell >= 0) {
    filling_[static_cast<std::size_t>(cell)] += dt_s * ml_per_s;
    iodine_mg_per_ml_[static_cast<std::size_t>(cell)] += dt_s * ml_per_s * iodine_mg_per_ml;
  }
  for (const Part& part : parts_)
    if (part.papilla >= 0) diagonal_[static_cast<std::size_t>(part.papilla)] += dt_s * part.papilla_out;
  for (std::size_t n = 0; n < count; ++n) {
    const DuctCell& at = tree_.cells[n];
    if (at.parent < 0 || at.is_closed) continue;
    const double mixed = dt_s * (exchange_[n] * std::abs(to_parent_[n]) + rest_exchange_[n]);
    const double out = dt_s * std::max(to_parent_[n], 0.0) + mixed;
    const double in = dt_s * std::max(-to_parent_[n], 0.0) + mixed;
    diagonal_[n] += out;
    lower_[n] = -out;
    diagonal_[static_cast<std::size_t>(at.parent)] += in;
    upper_[n] = -in;
  }
  for (std::size_t n = count; n-- > 0;) {
    const DuctCell& at = tree_.cells[n];
    if (at.parent < 0 || at.is_closed) continue;
    const auto parent = static_cast<std::size_t>(at.parent);
    const double factor = lower_[n] / diagonal_[n];
    diagonal_[parent] -= factor * upper_[n];
    filling_[parent] -= factor * filling_[n];
    iodine_mg_per_ml_[parent] -= factor * iodine_mg_per_ml_[n];
  }
  for (std::size_t n = 0; n < count; ++n) {
    const DuctCell& at = tree_.cells[n];
    if (at.parent >= 0 && !at.is_closed) {
      filling_[n] -= upper_[n] * filling_[static_cast<std::size_t>(at.parent)];
      iodine_mg_per_ml_[n] -= upper_[n] * iodine_mg_per_ml_[static_cast<std::size_t>(at.parent)];
    }
    filling_[n] /= diagonal_[n];
    iodine_mg_per_ml_[n] /= diagonal_[n];
  }
  for (const Part& part : parts_) {
    if (part.papilla < 0) continue;
    drained_ml_ += dt_s * part.papilla_out;
    drained_mg_ += dt_s * part.papilla_out * iodine_mg_per_ml_[static_cast<std::size_t>(part.papilla)];
  }
  volume_ml_ = next_ml_;
}

double DuctFill::volume_ml() const {
  double sum = 0.0;
  for (const double ml : volume_ml_) sum += ml;
  return sum;
}

double DuctFill::contrast_ml() const {
  double sum = 0.0;
  for (std::size_t n = 0; n < volume_ml_.size(); ++n) sum += volume_ml_[n] * filling_[n];
  return sum;
}

double DuctFill::iodine_mg() const {
  double sum = 0.0;
  for (std::size_t n = 0; n < volume_ml_.size(); ++n) sum += iodine_mg(n);
  return sum;
}

double DuctFill::reachable_ml(std::size_t cell) const {
  double sum = 0.0;
  for (std::size_t n = 0; n < volume_ml_.size(); ++n)
    if (part_of_[n] == part_of_[cell]) sum += volume_ml_[n];
  return sum;
}

void DuctFill::add_pieces(double least_mg_per_ml, std::vector<IodinePiece>& pieces) const {
  outline_.add_pieces(tree_, volume_ml_, iodine_mg_per_ml_, least_mg_per_ml, pieces);
}

}  // namespace trocar::xray
