#include "cohort/separation.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cohort/detail/bisect.h"
#include "cohort/detail/distributions.h"
#include "core/check.h"

namespace trocar::cohort {
namespace {

/// Variance of the area that n1 and n2 people give if the true one is `area`, both groups exponential (Hanley and
/// McNeil 1982, with Newcombe's pooled size).
double area_variance(double area, double n1, double n2) {
  const double pooled = 0.5 * (n1 + n2) - 1.0;
  return area * (1.0 - area) / (n1 * n2) * (1.0 + pooled * ((1.0 - area) / (2.0 - area) + area / (1.0 + area)));
}

std::vector<std::size_t> by_size(std::span<const double> p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return p[a] < p[b]; });
  return order;
}

}  // namespace

Interval auc_interval(double auc, std::size_t n1, std::size_t n2) {
  TROCAR_CHECK(auc >= 0.0 && auc <= 1.0 && n1 >= 1 && n2 >= 1);
  static const double z = normal_quantile(0.975);
  const auto reach = [&](double area) {
    return z * std::sqrt(area_variance(area, static_cast<double>(n1), static_cast<double>(n2)));
  };
  // The true areas from which the observed one is 1.96 of their own standard errors away.
  const auto from_below = [&](double area) { return area + reach(area) - auc; };
  const auto from_above = [&](double area) { return area - reach(area) - auc; };
  return {auc > 0.0 ? bisect(0.0, auc, from_below) : 0.0, auc < 1.0 ? bisect(auc, 1.0, from_above) : 1.0};
}

Result<Separation> separation_of(std::span<const double> experts, std::span<const double> novices, Better better) {
  Separation separation;
  TROCAR_TRY(separation.test, rank_sum_test(experts, novices));
  separation.experts = experts.size();
  separation.novices = novices.size();
  separation.expert_median = *quantile_of(experts, 0.5);
  separation.novice_median = *quantile_of(novices, 0.5);
  const double higher = separation.test.u / static_cast<double>(experts.size() * novices.size());
  separation.auc = better == Better::kLower ? 1.0 - higher : higher;
  separation.auc_interval = auc_interval(separation.auc, experts.size(), novices.size());
  return separation;
}

const char* to_string(Correction correction) noexcept {
  switch (correction) {
    case Correction::kNone:
      return "none";
    case Correction::kHolm:
      return "Holm";
    case Correction::kBenjaminiHochberg:
      return "Benjamini-Hochberg";
  }
  return "";
}

std::vector<double> corrected_p(std::span<const double> p, Correction correction) {
  std::vector<double> corrected(p.begin(), p.end());
  if (correction == Correction::kNone) return corrected;
  const std::vector<std::size_t> order = by_size(p);
  const std::size_t count = p.size();
  double so_far = correction == Correction::kHolm ? 0.0 : 1.0;
  for (std::size_t n = 0; n < count; ++n) {
    if (correction == Correction::kHolm) {  // from the smallest p, never falling
      const std::size_t at = order[n];
      so_far = std::max(so_far, p[at] * static_cast<double>(count - n));
      corrected[at] = std::min(1.0, so_far);
    } else {  // from the largest p, never rising
      const std::size_t rank = count - n, at = order[rank - 1];
      so_far = std::min(so_far, p[at] * static_cast<double>(count) / static_cast<double>(rank));
      corrected[at] = so_far;
    }
  }
  return corrected;
}

}  // namespace trocar::cohort
