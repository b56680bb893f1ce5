// Whether the numbers of a segmentation mean what the label map says, or what another one says.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "anatomy/derive/detail/spine_labels.h"
#include "anatomy/plausibility/judge_anatomy.h"

namespace trocar::anatomy {
namespace {

constexpr std::size_t kMostVisited = 4'000'000;
constexpr double kSmallest_ml = 1.0;

/// What the CT shows in the voxels of one value.
struct ValueSums {
  double voxels = 0.0;
  double hu = 0.0;
  Vec3 place_P = Vec3::Zero();
  double mean_hu() const { return hu / voxels; }
  Vec3 middle_P() const { return place_P / voxels; }
};

/// By value; voxels outside the CT are left out. Looks at a part of the voxels of a large volume.
std::map<int, ValueSums> sums_of(const volume::CtGrid& ct, const volume::LabelGrid& labels) {
  std::map<int, ValueSums> sums;
  const std::size_t stride = std::max<std::size_t>(1, labels.voxels.size() / kMostVisited) | 1;
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
  }
  const double sampled_ml = labels.geometry.voxel_volume_mm3() / 1000.0 * static_cast<double>(stride);
  std::erase_if(sums, [&](const auto& entry) { return entry.second.voxels * sampled_ml < kSmallest_ml; });
  return sums;
}

/// Typical mean HU of a tissue, with and without contrast agent. [assumed, narrower than plausible_hu.cpp]
struct TypicalHu {
  std::string_view tissue;
  double low, high;
};
constexpr std::array kTypical{
    TypicalHu{"bone", 110, 900},       TypicalHu{"lung", -950, -450}, TypicalHu{"liver", 20, 180},
    TypicalHu{"spleen", 20, 220},      TypicalHu{"kidney", 10, 280},  TypicalHu{"organ", -30, 170},
    TypicalHu{"bowel", -200, 160},     TypicalHu{"vessel", 10, 450},  TypicalHu{"muscle", -30, 110},
    TypicalHu{"gallbladder", -20, 80}, TypicalHu{"fluid", -30, 100},  TypicalHu{"csf", -20, 80},
    TypicalHu{"soft_tissue", -80, 150}};

/// How much a reading contradicts the CT: 0 is none, 1 for each 100 HU beyond what is typical, at most 3 a structure.
double contradiction_of(const std::map<int, ValueSums>& sums, const std::vector<std::pair<int, std::string>>& names,
                        const KnownStructures& known) {
  constexpr double kPerHu = 0.01, kMost = 3.0;
  double total = 0.0;
  std::map<int, Vec3> vertebrae;  // by their place from head to feet
  for (const auto& [value, name] : names) {
    const auto sum = sums.find(value);
    const KnownStructure* structure = known.find(name);
    if (sum == sums.end() || structure == nullptr) continue;
    if (const int place = detail::vertebra_place(name); place > 0) vertebrae.emplace(place, sum->second.middle_P());
    const auto typical = std::ranges::find(kTypical, structure->tissue, &TypicalHu::tissue);
    if (typical == kTypical.end()) continue;
    const double mean = sum->second.mean_hu();
    total += std::min(kMost, kPerHu * std::max({0.0, typical->low - mean, mean - typical->high}));
  }
  // Vertebrae lie below each other in their order, at the distances of vertebrae.
  constexpr double kLeastStep_mm = 12.0,
                   kLargestStep_mm = 70.0;  // [assumed, wide: 15 in a child's neck, 45 in a tall adult's back]
  for (auto below = vertebrae.begin(); below != vertebrae.end();) {
    const auto above = below++;
    if (below == vertebrae.end()) break;
    const double step_mm = (above->second.z() - below->second.z()) / static_cast<double>(below->first - above->first);
    total += step_mm >= kLeastStep_mm && step_mm <= kLargestStep_mm ? -0.5 : kMost;
  }
  return total;
}

}  // namespace

std::vector<AnatomyFinding> judge_numbers(const volume::CtGrid& ct, const std::vector<LabelSource>& sources,
                                          const KnownStructures& known) {
  std::vector<AnatomyFinding> findings;
  constexpr double kClear = 2.0;
  for (const LabelSource& source : sources) {
    if (source.other_readings.empty()) continue;
    const auto sums = sums_of(ct, source.labels);
    const double given = contradiction_of(sums, source.names, known);
    for (const OtherReading& other : source.other_readings) {
      const double otherwise = contradiction_of(sums, other.names, known);
      if (otherwise + kClear > given) continue;
      findings.push_back(
          {kNumbers,
           fmt::format("the label numbers look like those of {}: so read, they agree with the CT, and as "
                       "given they do not",
                       other.words),
           fmt::format("build with --label-map {}, or --confirm {} if the numbers are right", other.label_map,
                       kNumbers),
           true, kUseLabelMap + other.label_map});
    }
  }
  return findings;
}

}  // namespace trocar::anatomy
