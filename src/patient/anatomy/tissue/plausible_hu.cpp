#include "anatomy/tissue/plausible_hu.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace trocar::anatomy {
namespace {

struct HuRange {
  std::string_view tissue;
  double low;
  double high;
};
// Wide limits around textbook values for the tissue, with or without contrast agent. [assumed]
constexpr std::array kRanges{
    HuRange{"bone", 90, 2000},        HuRange{"liver", 0, 250},      HuRange{"liver_lesion", -30, 300},
    HuRange{"spleen", 0, 300},        HuRange{"kidney", -10, 350},   HuRange{"vessel", -20, 600},
    HuRange{"muscle", -50, 150},      HuRange{"lung", -1000, -300},  HuRange{"organ", -60, 250},
    HuRange{"gallbladder", -30, 150}, HuRange{"csf", -30, 80},       HuRange{"ascites", -30, 60},
    HuRange{"bile_duct", -30, 150},   HuRange{"ligament", -60, 250}, HuRange{"ligamentum_flavum", -60, 250}};
constexpr double kSmallestJudged_ml = 1.0;

}  // namespace

std::vector<Finding> find_implausible_hu(const VirtualPatient& patient, const std::vector<LabelStatistics>& statistics,
                                         std::size_t* judged_count, double margin_hu) {
  std::vector<Finding> doubts;
  std::size_t judged = 0;
  for (const LabelStatistics& s : statistics) {
    const Label* label = patient.label_table.find(s.id);
    if (label == nullptr || label->is_derived || s.volume_ml < kSmallestJudged_ml) continue;
    const auto range =
        std::find_if(kRanges.begin(), kRanges.end(), [&](const HuRange& r) { return r.tissue == label->tissue; });
    if (range == kRanges.end()) continue;
    ++judged;
    if (s.mean_hu >= range->low - margin_hu && s.mean_hu <= range->high + margin_hu) continue;
    doubts.push_back(
        {fmt::format("{}: mean {:.0f} HU, expected {:.0f} to {:.0f}", label->name, s.mean_hu, range->low, range->high),
         label->name, s.centroid_P});
  }
  if (judged_count != nullptr) *judged_count = judged;
  return doubts;
}

}  // namespace trocar::anatomy
