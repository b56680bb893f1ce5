#include "patient_builder/plausibility/detail/reading_match.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "patient_builder/build_patient.h"
#include "patient_builder/detail/label_boxes.h"
#include "patient_builder/plausibility/detail/usual_places.h"

namespace trocar::patient_builder::detail {
namespace {

constexpr std::size_t kMostSampled = 4'000'000;
constexpr double kSmallestValue_ml = 1.0;
constexpr double kMostPlacePoints = 1.5, kMostHuPoints = 3.0, kPerMm = 1.0 / 20.0, kPerHu = 1.0 / 100.0;

struct ValueSums {
  double voxels = 0.0, hu = 0.0, square_x = 0.0;
  Vec3 place_P = Vec3::Zero();
};

/// x and y of the voxels that are no air.
Vec3 middle_of_ct(const volume::CtGrid& ct) {
  Vec3 sum_P = Vec3::Zero();
  double count = 0.0;
  const std::size_t stride = std::max<std::size_t>(1, ct.voxels.size() / (kMostSampled / 4)) | 1;
  for (std::size_t n = 0; n < ct.voxels.size(); n += stride) {
    if (ct.voxels[n] <= anatomy::kGasBelow_hu) continue;
    sum_P += ct.geometry.centre_mm(ct.geometry.index_of(n));
    count += 1.0;
  }
  return count > 0.0 ? Vec3(sum_P / count) : Vec3(Vec3::Zero());
}

struct CountedPoint {
  double points;
  std::string words;
};

/// The structures of one reading.
class Reading {
 public:
  Reading(const ValuesInCt& in_ct, const ReadingNames& names, const anatomy::KnownStructures& known,
          const std::array<bool, 3>& reversed)
      : middle_P_(in_ct.body_middle_P) {
    for (const auto& [value, name] : names) {
      const auto found = in_ct.values.find(value);
      const anatomy::KnownStructure* structure = known.find(name);
      if (found == in_ct.values.end() || structure == nullptr) continue;
      ValueInCt in_place = found->second;
      for (int axis = 0; axis < 3; ++axis)
        if (reversed[static_cast<std::size_t>(axis)])
          in_place.middle_P[axis] = 2.0 * middle_P_[axis] - in_place.middle_P[axis];
      structures_.push_back({name, structure->tissue, vertebra_place(name), in_place});
    }
    for (const One& one : structures_) {
      judge_hu(one);
      judge_size(one);
      judge_side(one);
    }
    find_spine();
    judge_relations();
    judge_vertebrae();
  }

  ReadingMatch take() {
    std::ranges::stable_sort(found_, std::ranges::greater{}, &CountedPoint::points);
    constexpr std::size_t kMostNamed = 4;
    for (const CountedPoint& point : found_)
      if (match_.most.size() < kMostNamed) match_.most.push_back(point.words);
    count_misplaced();
    return std::move(match_);
  }

 private:
  struct One {
    std::string name, tissue;
    int vertebra = 0;
    ValueInCt in_ct;
  };

  /// Two structures of structures_ that were compared. The spine has no index of its own.
  struct Pair {
    std::size_t first, second;
    double points;
  };
  static constexpr std::size_t kNoIndex = static_cast<std::size_t>(-1);

  void count(double points, double most, std::string words) {
    if (!(points > 0.0)) return;
    match_.against += std::min(points, most);
    found_.push_back({std::min(points, most), std::move(words)});
  }
  void compare(std::size_t first, std::size_t second, double points, double most, std::string words) {
    pairs_.push_back({first, second, std::clamp(points, 0.0, most)});
    count(points, most, std::move(words));
  }

  /// Leaves out the structure with the most points against it, until the others agree.
  void count_misplaced() {
    std::vector<double> points(structures_.size(), 0.0);
    std::vector<bool> is_compared(structures_.size(), false), is_out(structures_.size(), false);
    for (const Pair& pair : pairs_)
      for (const std::size_t n : {pair.first, pair.second})
        if (n != kNoIndex) is_compared[n] = true;
    match_.compared = static_cast<std::size_t>(std::ranges::count(is_compared, true));
    constexpr double kAgrees = 1.0;
    while (match_.misplaced < structures_.size()) {
      std::ranges::fill(points, 0.0);
      double total = 0.0;
      for (const Pair& pair : pairs_) {
        const bool is_left_out =
            (pair.first != kNoIndex && is_out[pair.first]) || (pair.second != kNoIndex && is_out[pair.second]);
        if (is_left_out) continue;
        total += pair.points;
        for (const std::size_t n : {pair.first, pair.second})
          if (n != kNoIndex) points[n] += pair.points;
      }
      if (total < kAgrees) return;
      is_out[static_cast<std::size_t>(std::ranges::max_element(points) - points.begin())] = true;
      ++match_.misplaced;
    }
  }

  void judge_hu(const One& one) {
    const UsualHu* usual = usual_hu(one.name, one.tissue);
    if (usual == nullptr) return;
    const double mean = one.in_ct.mean_hu;
    count(kPerHu * std::max(usual->low - mean, mean - usual->high), kMostHuPoints,
          fmt::format("{} has {:.0f} HU", one.name, mean));
  }

  void judge_size(const One& one) {
    const UsualSize* usual = usual_size(one.name, one.vertebra > 0);
    if (usual == nullptr) return;
    const double ml = one.in_ct.ml;
    count(std::max((ml - usual->high_ml) / usual->high_ml, usual->low_ml > 0.0 ? 1.0 - ml / usual->low_ml : 0.0),
          kMostPlacePoints, fmt::format("{} has {:.0f} ml", one.name, ml));
    count(kPerMm * (one.in_ct.spread_x_mm - usual->spread_x_mm), kMostPlacePoints,
          fmt::format("{} lies on both sides", one.name));
  }

  /// Left and right, front and back of the body's middle.
  void judge_side(const One& one) {
    const Vec3 from_middle = one.in_ct.middle_P - middle_P_;
    for (const UsualSide& side : usual_sides(one.name, one.vertebra > 0)) {
      const double at = from_middle[side.axis];
      count(kPerMm * std::max(side.low_mm - at, at - side.high_mm), kMostPlacePoints,
            fmt::format("{} lies {:.0f} mm {} the middle", one.name, std::abs(at),
                        side.axis == 0 ? (at > 0.0 ? "left of" : "right of") : (at > 0.0 ? "behind" : "in front of")));
    }
  }

  struct Placed {
    std::size_t index;
    Vec3 p_P;
  };
  std::optional<Placed> find_place(std::string_view name) const {
    if (name == kSpine) return spine_;
    const auto found = std::ranges::find(structures_, name, &One::name);
    if (found == structures_.end()) return std::nullopt;
    return Placed{static_cast<std::size_t>(found - structures_.begin()), found->in_ct.middle_P};
  }

  void find_spine() {
    Vec3 sum_P = Vec3::Zero();
    double number = 0.0;
    for (const One& one : structures_)
      if (one.vertebra >= kT1 + 10 && one.vertebra <= kL5) {
        sum_P += one.in_ct.middle_P;
        number += 1.0;
      }
    if (number > 0.0) spine_ = Placed{kNoIndex, sum_P / number};
  }

  void judge_relations() {
    constexpr std::array kOpposite{"right of", "in front of", "below"};
    for (const UsualRelation& relation : usual_relations()) {
      const auto first = find_place(relation.first), second = find_place(relation.second);
      if (!first || !second) continue;
      const double beyond_mm = relation.least_mm - (first->p_P[relation.axis] - second->p_P[relation.axis]);
      compare(first->index, second->index, kPerMm * beyond_mm, kMostPlacePoints,
              fmt::format("{} too far {} {}", relation.first, kOpposite[static_cast<std::size_t>(relation.axis)],
                          relation.second));
    }
    for (const UsualDistance& usual : usual_distances()) {
      const auto first = find_place(usual.first), second = find_place(usual.second);
      if (!first || !second) continue;
      const double mm = (first->p_P - second->p_P).norm();
      compare(first->index, second->index, kPerMm * std::max(usual.least_mm - mm, mm - usual.most_mm), kMostPlacePoints,
              fmt::format("{} {:.0f} mm from {}", usual.first, mm, usual.second));
    }
  }

  /// Vertebrae lie below each other in their order, at the distances of vertebrae.
  void judge_vertebrae() {
    constexpr double kLeastStep_mm = 12.0,
                     kLargestStep_mm = 70.0;  // [assumed, wide: 15 in a child's neck, 45 in a tall adult's back]
    constexpr double kAgrees = 0.5;
    std::map<int, std::size_t> by_place;
    for (std::size_t n = 0; n < structures_.size(); ++n)
      if (structures_[n].vertebra > 0) by_place.emplace(structures_[n].vertebra, n);
    for (auto below = by_place.begin(); below != by_place.end();) {
      const auto above = below++;
      if (below == by_place.end()) break;
      const One &upper = structures_[above->second], &lower = structures_[below->second];
      const double step_mm =
          (upper.in_ct.middle_P.z() - lower.in_ct.middle_P.z()) / static_cast<double>(below->first - above->first);
      const bool agrees = step_mm >= kLeastStep_mm && step_mm <= kLargestStep_mm;
      if (agrees) match_.agreed += kAgrees;
      compare(above->second, below->second, agrees ? 0.0 : kMostHuPoints, kMostHuPoints,
              fmt::format("{} is not next above {}", upper.name, lower.name));
    }
  }

  Vec3 middle_P_;
  std::vector<One> structures_;
  std::optional<Placed> spine_;
  std::vector<Pair> pairs_;
  std::vector<CountedPoint> found_;
  ReadingMatch match_;
};

}  // namespace

ValuesInCt measure_values(const volume::CtGrid& ct, const volume::LabelGrid& labels) {
  std::map<int, ValueSums> sums;
  const std::size_t stride = std::max<std::size_t>(1, labels.voxels.size() / kMostSampled) | 1;
  for (std::size_t n = 0; n < labels.voxels.size(); n += stride) {
    if (labels.voxels[n] == 0) continue;
    const Vec3 p_P = labels.geometry.centre_mm(labels.geometry.index_of(n));
    const Vec3 index = ct.geometry.to_index(p_P);
    const volume::Index3 ijk{std::lround(index.x()), std::lround(index.y()), std::lround(index.z())};
    if (!ct.geometry.contains(ijk)) continue;
    ValueSums& sum = sums[labels.voxels[n]];
    sum.voxels += 1.0;
    sum.hu += ct[ijk];
    sum.place_P += p_P;
    sum.square_x += p_P.x() * p_P.x();
  }
  const double sampled_ml = labels.geometry.voxel_volume_mm3() / 1000.0 * static_cast<double>(stride);
  ValuesInCt in_ct;
  for (const auto& [value, sum] : sums) {
    if (sum.voxels * sampled_ml < kSmallestValue_ml) continue;
    const Vec3 middle_P = sum.place_P / sum.voxels;
    const double variance = std::max(0.0, sum.square_x / sum.voxels - middle_P.x() * middle_P.x());
    in_ct.values[value] = {sum.voxels * sampled_ml, sum.hu / sum.voxels, middle_P, std::sqrt(variance)};
  }
  in_ct.body_middle_P = middle_of_ct(ct);
  return in_ct;
}

ReadingMatch match_reading(const ValuesInCt& in_ct, const ReadingNames& names, const anatomy::KnownStructures& known,
                           const std::array<bool, 3>& reversed) {
  return Reading(in_ct, names, known, reversed).take();
}

ReadingMatch match_any_direction(const ValuesInCt& in_ct, const ReadingNames& names,
                                 const anatomy::KnownStructures& known) {
  ReadingMatch best = match_reading(in_ct, names, known);
  for (unsigned axes = 1; axes < 8; ++axes) {
    ReadingMatch match = match_reading(in_ct, names, known, {(axes & 1U) != 0, (axes & 2U) != 0, (axes & 4U) != 0});
    if (match.against < best.against) best = std::move(match);
  }
  return best;
}

}  // namespace trocar::patient_builder::detail
