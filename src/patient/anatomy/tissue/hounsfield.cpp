#include "anatomy/tissue/hounsfield.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

namespace trocar::anatomy {
namespace {

// All numbers are assumed, with a large margin: in CTs of a trunk, a fifth or more of the voxels is air and nine tenths
// of the rest is soft tissue; in other data there are almost none.
constexpr int kAirFrom = -1200, kAirBelow = -300;
constexpr int kSoftFrom = -250, kSoftBelow = 300;
constexpr double kLeastAir = 0.001;  ///< Of all voxels.
constexpr double kLeastSoft = 0.4;   ///< Of the voxels above air.
constexpr double kLeastBody = 0.02;  ///< Of all voxels.

constexpr const char* kAdvice =
    "give a CT in Hounsfield units that shows the skin and air around it, or the missing scale with --rescale "
    "SLOPE,INTERCEPT (often 1,-1024)";
constexpr const char* kAirAdvice =
    "give a CT in Hounsfield units that shows the skin and air around it, or the missing scale with --rescale "
    "SLOPE,INTERCEPT (often 1,-1024); a CT that ends inside the body: --confirm cropped takes its sides as the skin";

class Histogram {
 public:
  explicit Histogram(const volume::CtGrid& ct) : counts_(std::size_t{1} << 16) {
    for (const std::int16_t value : ct.voxels) ++counts_[at(value)];
  }
  /// Voxels from `low` to below `high`.
  double count(int low, int high) const {
    std::size_t sum = 0;
    for (int value = std::max(low, kLowest); value < std::min(high, kHighest + 1); ++value) sum += counts_[at(value)];
    return static_cast<double>(sum);
  }
  int lowest() const {
    const auto found = std::find_if(counts_.begin(), counts_.end(), [](std::size_t count) { return count > 0; });
    return kLowest + static_cast<int>(found - counts_.begin());
  }
  int highest() const {
    const auto found = std::find_if(counts_.rbegin(), counts_.rend(), [](std::size_t count) { return count > 0; });
    return kHighest - static_cast<int>(found - counts_.rbegin());
  }

 private:
  static constexpr int kLowest = std::numeric_limits<std::int16_t>::min();
  static constexpr int kHighest = std::numeric_limits<std::int16_t>::max();
  static std::size_t at(int value) { return static_cast<std::size_t>(value - kLowest); }
  std::vector<std::size_t> counts_;
};

}  // namespace

Status apply_rescale(const Rescale& rescale, volume::CtGrid& ct) {
  constexpr double kMaxSlope = 1e4, kMaxIntercept = 1e6;
  const double slope = std::abs(rescale.slope);
  if (!(slope >= 1.0 / kMaxSlope && slope <= kMaxSlope) || !(std::abs(rescale.intercept) <= kMaxIntercept))
    return fail_usage("the rescale values are not usable",
                      fmt::format("--rescale {},{}", rescale.slope, rescale.intercept),
                      "give SLOPE,INTERCEPT such as 1,-1024");
  for (std::int16_t& voxel : ct.voxels) {
    const double hu = rescale.slope * voxel + rescale.intercept;
    if (hu >= 32767.5)
      return fail_usage(fmt::format("the rescale values convert the stored number {} to {:.0f} HU", voxel, hu),
                        fmt::format("--rescale {},{}", rescale.slope, rescale.intercept), "check slope and intercept");
    voxel = static_cast<std::int16_t>(std::lround(std::max(hu, -32768.0)));
  }
  return {};
}

Status check_hounsfield(const volume::CtGrid& ct, AirIn air) {
  const Histogram histogram(ct);
  const std::string range = fmt::format("its values are {} to {}", histogram.lowest(), histogram.highest());
  const auto all = static_cast<double>(ct.voxels.size());
  if (air == AirIn::kAroundTheBody && histogram.count(kAirFrom, kAirBelow) < kLeastAir * all)
    return fail(fmt::format("the CT shows no air ({} to {} HU): {}", kAirFrom, kAirBelow, range), {}, kAirAdvice);
  const double solid = histogram.count(kAirBelow, std::numeric_limits<std::int16_t>::max() + 1);
  if (histogram.count(kSoftFrom, kSoftBelow) < std::max(kLeastSoft * solid, kLeastBody * all))
    return fail(
        fmt::format("the CT shows too little fat and soft tissue ({} to {} HU): {}", kSoftFrom, kSoftBelow, range), {},
        kAdvice);
  return {};
}

namespace {

struct HuRange {
  std::string_view tissue;
  double low, high;                        ///< Of the mean.
  double most_gas = 0.2, most_bone = 0.2;  ///< Shares of the voxels (LabelStatistics).
};
constexpr double kAny = 1.0;
// Wide limits around textbook values for the tissue, with or without contrast agent, which makes vessels, the kidneys'
// pelvis, the bladder and the gallbladder as bright as bone. A fatty liver has 0 to 40 HU. [assumed]
constexpr std::array kRanges{HuRange{"bone", 90, 3100, 0.3, kAny},
                             HuRange{"liver", 0, 250},
                             HuRange{"liver_lesion", -30, 300, 0.2, kAny},
                             HuRange{"spleen", 15, 300},
                             HuRange{"kidney", 5, 350, 0.2, 0.5},
                             HuRange{"vessel", 0, 600, 0.2, kAny},
                             HuRange{"muscle", -50, 150},
                             HuRange{"lung", -1000, -300, kAny, 0.2},
                             HuRange{"organ", -60, 250, 0.3, 0.4},
                             HuRange{"gallbladder", -30, 150, 0.2, 0.5},
                             HuRange{"csf", -30, 80},
                             HuRange{"ascites", -30, 60},
                             HuRange{"bile_duct", -30, 150, 0.3, 0.5},
                             HuRange{"ligament", -60, 250, 0.2, 0.4},
                             HuRange{"ligamentum_flavum", -60, 250, 0.2, 0.4}};
constexpr double kSmallestJudged_ml = 1.0;

std::string finding_text(const std::string& name, const LabelStatistics& s, const HuRange& range, double margin_hu,
                         double margin_share) {
  if (s.gas_share > range.most_gas + margin_share)
    return fmt::format("{}: {:.0f} % of it is gas", name, 100.0 * s.gas_share);
  if (s.bone_share > range.most_bone + margin_share)
    return fmt::format("{}: {:.0f} % of it is as dense as bone", name, 100.0 * s.bone_share);
  if (s.mean_hu < range.low - margin_hu || s.mean_hu > range.high + margin_hu)
    return fmt::format("{}: mean {:.0f} HU, expected {:.0f} to {:.0f}", name, s.mean_hu, range.low, range.high);
  return {};
}

}  // namespace

std::vector<Finding> find_implausible_hu(const VirtualPatient& patient, const std::vector<LabelStatistics>& statistics,
                                         std::size_t* judged_count, const HuMargin& margin) {
  std::vector<Finding> findings;
  std::size_t judged = 0;
  for (const LabelStatistics& s : statistics) {
    const Label* label = patient.label_table.find(s.id);
    if (label == nullptr || label->is_derived || s.volume_ml < kSmallestJudged_ml) continue;
    const auto range =
        std::find_if(kRanges.begin(), kRanges.end(), [&](const HuRange& r) { return r.tissue == label->tissue; });
    if (range == kRanges.end()) continue;
    ++judged;
    std::string text = finding_text(label->name, s, *range, margin.hu, margin.share);
    if (!text.empty()) findings.push_back({std::move(text), label->name, s.centroid_P});
  }
  if (judged_count != nullptr) *judged_count = judged;
  return findings;
}

}  // namespace trocar::anatomy
