#include "patient_builder/detail/merge_sources.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <compare>
#include <cstdint>
#include <map>
#include <set>
#include <string_view>

#include "core/parallel.h"
#include "core/result.h"
#include "volume/resample.h"

namespace trocar::patient_builder::detail {
namespace {

constexpr double kMinOverlap = 0.05;         // of the smaller grid; below, the files belong to different scans
constexpr double kMostlyCovered = 0.99;      // share of the CT, above which nothing is missing but a rim
constexpr std::size_t kMaxStructures = 230;  // of 255 label values; the others are for derived labels
constexpr std::size_t kBlock = 1 << 16;

std::array<std::size_t, 256> count_values(const volume::LabelGrid& labels) {
  std::array<std::size_t, 256> counts{};
  for (const std::uint8_t value : labels.voxels) ++counts[value];
  return counts;
}

bool is_left_out(std::string_view name, const anatomy::KnownStructures& known) {
  return name == kIgnoredStructure || known.is_background(name) || known.is_region(name);
}

/// "my_roi" (label 3), "livr" (label 5, perhaps liver); label values 7, 9 without a name.
struct UnknownLabels {
  std::vector<std::string> names, files;
  std::vector<int> values;

  void add(const LabelSource& source, const anatomy::KnownStructures& known) {
    const std::size_t before = names.size() + values.size();
    std::array<bool, 256> is_named{};
    for (const auto& [value, name] : source.names) {
      if (value >= 0 && value <= 255) is_named[static_cast<std::size_t>(value)] = true;
      if (is_left_out(name, known) || known.find(name) != nullptr) continue;
      std::vector<std::string> notes;
      if (!source.is_described) notes.push_back(fmt::format("label {}", value));
      for (const std::string& similar : known.similar_names(name, 1)) notes.push_back("perhaps " + similar);
      names.push_back(notes.empty() ? fmt::format("\"{}\"", name)
                                    : fmt::format("\"{}\" ({})", name, fmt::join(notes, ", ")));
    }
    const auto counts = count_values(source.labels);
    for (std::size_t value = 1; value < counts.size(); ++value)
      if (counts[value] > 0 && !is_named[value]) values.push_back(static_cast<int>(value));
    const bool is_new = files.empty() || files.back() != source.file;
    if (names.size() + values.size() > before && is_new) files.push_back(source.file);
  }

  Status status() const {
    if (files.empty()) return {};
    std::string what;
    if (!names.empty()) what = fmt::format("unknown structure names: {}", fmt::join(names, ", "));
    if (!values.empty())
      what += fmt::format("{}label values without a name: {}", what.empty() ? "" : "; ", fmt::join(values, ", "));
    return fail(
        what, fmt::format("{}", fmt::join(files, ", ")),
        "assign TotalSegmentator names, or ignore the labels with ignore = [...], in a label map (--label-map)");
  }
};

Status check_names(const std::vector<LabelSource>& sources, const anatomy::KnownStructures& known) {
  UnknownLabels unknown;
  for (const LabelSource& source : sources) unknown.add(source, known);
  return unknown.status();
}

/// Files that cover a part of the CT, by this part (%).
using PartialFiles = std::map<int, std::vector<std::string>>;

Status check_overlap(const LabelSource& source, const volume::GridGeometry& grid, PartialFiles& partial) {
  if (source.labels.empty())
    return fail("the segmentation has no voxels", source.file, "export the segmentation again");
  const double covered = volume::overlap_fraction(source.labels.geometry, grid);
  const double overlap = std::max(covered, volume::overlap_fraction(grid, source.labels.geometry));
  if (overlap < kMinOverlap)
    return fail(fmt::format("the segmentation does not overlap the CT ({:.1f} % common)", 100.0 * overlap), source.file,
                "give the segmentation that was made from this CT");
  if (!source.is_described && covered < kMostlyCovered)
    partial[static_cast<int>(std::lround(100.0 * covered))].push_back(source.file);
  return {};
}

void warn_of_partial_files(const PartialFiles& partial, std::vector<std::string>& warnings) {
  for (const auto& [percent, files] : partial)
    warnings.push_back(fmt::format("the segmentation covers {} % of the CT; beyond it, structures have no label: {}{}",
                                   percent, files.front(),
                                   files.size() > 1 ? fmt::format(" and {} more", files.size() - 1) : ""));
}

/// Structures that occur more than once become one: "liver" of liver.nii.gz and of seg.nii.gz.
void warn_of_repeated_names(const std::vector<LabelSource>& sources, const anatomy::KnownStructures& known,
                            std::vector<std::string>& warnings) {
  std::map<std::string, std::vector<std::string>> places;  // by plain name
  std::map<std::string, std::string> first_name;
  std::set<std::string> regions;
  for (const LabelSource& source : sources) {
    const auto counts = count_values(source.labels);
    for (const auto& [value, name] : source.names) {
      if (known.is_region(name)) regions.insert(name);
      const anatomy::KnownStructure* structure = is_left_out(name, known) ? nullptr : known.find(name);
      const bool occurs = value > 0 && value <= 255 && counts[static_cast<std::size_t>(value)] > 0;
      if (structure == nullptr || structure->tissue == "skin" || !occurs) continue;
      places[anatomy::plain_name(name)].push_back(
          source.is_described ? source.file : fmt::format("label {} of {}", value, source.file));
      first_name.emplace(anatomy::plain_name(name), name);
    }
  }
  for (const auto& [plain, labels] : places)
    if (labels.size() > 1)
      warnings.push_back(fmt::format("{} labels are named \"{}\" and become one structure: {}", labels.size(),
                                     first_name[plain], fmt::join(labels, ", ")));
  if (!regions.empty())
    warnings.push_back(fmt::format("regions that hold several structures were left out: {}", fmt::join(regions, ", ")));
}

/// Volume of each structure in its own file, by plain name (mm³).
std::map<std::string, double> volumes_of(const std::vector<LabelSource>& sources) {
  std::map<std::string, double> volumes;
  for (const LabelSource& source : sources) {
    const auto counts = count_values(source.labels);
    for (const auto& [value, name] : source.names)
      if (value > 0 && value <= 255)
        volumes[anatomy::plain_name(name)] +=
            static_cast<double>(counts[static_cast<std::size_t>(value)]) * source.labels.geometry.voxel_volume_mm3();
  }
  return volumes;
}

/// Merges one source after the other. Their names are known or left out (check_names). A voxel in two structures gets
/// the one of higher priority, among equals the smaller structure: independent of the order of files and segments.
class Merger {
 public:
  Merger(const volume::GridGeometry& grid, const anatomy::KnownStructures& known, std::map<std::string, double> volumes)
      : known_(known), volumes_(std::move(volumes)), overlaps_(256 * 256) {
    merged_.labels = volume::LabelGrid(grid);
  }

  Status add(LabelSource source, std::vector<std::string>& empty_masks) {
    volume::LabelGrid labels = volume::along_P(std::move(source.labels));
    if (!labels.geometry.matches(merged_.labels.geometry))
      labels = volume::resample_nearest(labels, merged_.labels.geometry, 0);
    const auto counts = count_values(labels);
    std::array<std::uint8_t, 256> id_of{};
    for (const auto& [value, name] : source.names) {
      if (value < 0 || value > 255)
        return fail(fmt::format("label value {} of \"{}\" is not in 0..255", value, name), source.file,
                    "number the labels from 0 to 255");
      const auto v = static_cast<std::uint8_t>(value);
      if (v == 0 || is_left_out(name, known_)) continue;
      if (counts[v] == 0) {
        // A label map can name more structures than a scan contains; an empty mask file causes a warning.
        if (source.names.size() == 1) empty_masks.push_back(name);
        continue;
      }
      const anatomy::KnownStructure* structure = known_.find(name);
      TROCAR_ASSERT(structure != nullptr);
      if (structure->tissue == "skin") {
        add_body_hint(labels, v);
        continue;
      }
      if (merged_.table.labels.size() == kMaxStructures)
        return fail(fmt::format("more than {} structures", kMaxStructures), source.file,
                    "leave some out with a label map");
      id_of[v] = find_or_add(name, *structure);
    }
    paint(labels, id_of);
    return {};
  }

  MergedLabels take() { return std::move(merged_); }

  /// Overlaps of two structures above 1 ml, largest first: in one line, or empty.
  std::string overlap_text() const {
    constexpr double kSmallest_ml = 1.0;
    constexpr std::size_t kMostNamed = 8;
    std::vector<std::pair<double, std::string>> found;
    for (const anatomy::Label& kept : merged_.table.labels)
      for (const anatomy::Label& lost : merged_.table.labels) {
        const auto voxels = static_cast<double>(overlaps_[256U * kept.id + lost.id]);
        const double ml = voxels * merged_.labels.geometry.voxel_volume_mm3() / 1000.0;
        if (ml > kSmallest_ml)
          found.emplace_back(-ml, fmt::format("{:.1f} ml of {} and {} (now {})", ml, kept.name, lost.name, kept.name));
      }
    std::sort(found.begin(), found.end());
    std::vector<std::string> texts;
    for (std::size_t n = 0; n < std::min(found.size(), kMostNamed); ++n) texts.push_back(found[n].second);
    if (found.size() > kMostNamed) texts.push_back(fmt::format("{} more", found.size() - kMostNamed));
    return texts.empty() ? std::string() : fmt::format("overlapping structures: {}", fmt::join(texts, ", "));
  }

 private:
  std::uint8_t find_or_add(const std::string& name, const anatomy::KnownStructure& structure) {
    for (const anatomy::Label& label : merged_.table.labels)
      if (anatomy::plain_name(label.name) == anatomy::plain_name(name)) return label.id;
    const auto id = static_cast<std::uint8_t>(merged_.table.labels.size() + 1);
    merged_.table.labels.push_back({id, name, structure.tissue, structure.color});
    rank_[id] = {structure.priority, -volumes_[anatomy::plain_name(name)], anatomy::plain_name(name)};
    return id;
  }

  void add_body_hint(const volume::LabelGrid& labels, std::uint8_t value) {
    if (merged_.body_hint.empty()) merged_.body_hint = volume::MaskGrid(labels.geometry);
    for (std::size_t n = 0; n < labels.voxels.size(); ++n) merged_.body_hint.voxels[n] |= labels.voxels[n] == value;
  }

  void paint(const volume::LabelGrid& labels, const std::array<std::uint8_t, 256>& id_of) {
    parallel_for(labels.voxels.size(), kBlock, [&](std::size_t first, std::size_t last) {
      for (std::size_t n = first; n < last; ++n) {
        const std::uint8_t id = id_of[labels.voxels[n]];
        std::uint8_t& voxel = merged_.labels.voxels[n];
        if (id == 0 || id == voxel) continue;
        const std::uint8_t before = voxel;
        if (before == 0 || rank_[id] > rank_[before]) voxel = id;
        if (before != 0) overlaps_[256U * voxel + (voxel == id ? before : id)].fetch_add(1, std::memory_order_relaxed);
      }
    });
  }

  /// What decides between two structures: the larger rank has the voxel.
  struct Rank {
    int priority = 0;
    double minus_volume = 0.0;
    std::string name;
    auto operator<=>(const Rank&) const = default;
  };

  const anatomy::KnownStructures& known_;
  MergedLabels merged_;
  std::map<std::string, double> volumes_;
  std::array<Rank, 256> rank_{};
  std::vector<std::atomic<std::uint32_t>> overlaps_;  ///< Voxels by the structure that has them and the other one.
};

}  // namespace

Result<MergedLabels> merge_sources(std::vector<LabelSource> sources, const volume::GridGeometry& grid,
                                   const anatomy::KnownStructures& known, std::vector<std::string>& warnings) {
  if (sources.empty()) return fail_usage("no segmentation given", "--labels", "give at least one label file");
  TROCAR_TRY_STATUS(check_names(sources, known));
  PartialFiles partial;
  for (const LabelSource& source : sources) TROCAR_TRY_STATUS(check_overlap(source, grid, partial));
  warn_of_partial_files(partial, warnings);
  warn_of_repeated_names(sources, known, warnings);
  const std::string where = sources.size() == 1 ? sources.front().file : fmt::format("{} files", sources.size());
  Merger merger(grid, known, volumes_of(sources));
  std::vector<std::string> empty_masks;
  for (LabelSource& source : sources) {
    TROCAR_TRY_STATUS(merger.add(std::move(source), empty_masks));
  }
  if (std::string text = merger.overlap_text(); !text.empty()) warnings.push_back(std::move(text));
  MergedLabels merged = merger.take();
  if (merged.table.labels.empty())
    return fail("all masks are empty", where, "check that the segmentation belongs to this CT and is not blank");
  if (!empty_masks.empty()) warnings.push_back(fmt::format("empty masks left out: {}", fmt::join(empty_masks, ", ")));
  return merged;
}

}  // namespace trocar::patient_builder::detail
