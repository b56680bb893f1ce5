#include "anatomy/tissue/plausible_hu.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace trocar::anatomy {
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
