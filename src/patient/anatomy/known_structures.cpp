#include "anatomy/known_structures.h"

#include <algorithm>
#include <numeric>

namespace trocar::anatomy {
namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({row[j] + 1, row[j + 1] + 1, replaced});
    }
  }
  return row.back();
}

}  // namespace

const KnownStructure* KnownStructures::find(std::string_view name) const {
  const std::string plain = plain_name(name);
  const std::string key = without_side(plain);
  const auto row = std::find_if(rows_.begin(), rows_.end(), [&](const Row& r) {
    return (!r.needs_side || key.size() < plain.size()) && r.pattern.matches(key);
  });
  return row != rows_.end() ? &structures_[row->structure] : nullptr;
}

bool KnownStructures::is_background(std::string_view name) const {
  return std::find(background_.begin(), background_.end(), plain_name(name)) != background_.end();
}

bool KnownStructures::is_region(std::string_view name) const {
  return std::find(regions_.begin(), regions_.end(), plain_name(name)) != regions_.end();
}

std::vector<std::string> KnownStructures::similar_names(std::string_view name, std::size_t count) const {
  const std::string wanted = plain_name(name);
  std::vector<std::pair<std::size_t, std::string>> candidates;
  const auto consider = [&](const std::string& known) {
    const std::string spelled = plain_name(known);
    const std::size_t distance = edit_distance(wanted, spelled);
    // With more changes it is another word, not a misspelling: "my_roi" is not "thyroid".
    const std::size_t allowed = std::max<std::size_t>(1, (std::max(wanted.size(), spelled.size()) + 1) / 4);
    if (distance <= allowed) candidates.emplace_back(distance, known);
  };
  for (const std::string& known : totalsegmentator_) consider(known);
  for (const Row& row : rows_) {
    if (row.pattern.has_region()) continue;  // this includes all names of TotalSegmentator
    const std::string& known = row.pattern.stem();
    const auto spelled = [&](const auto& candidate) { return plain_name(candidate.second) == known; };
    if (std::none_of(candidates.begin(), candidates.end(), spelled)) consider(known);
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::string> names;
  for (std::size_t n = 0; n < std::min(count, candidates.size()); ++n) names.push_back(candidates[n].second);
  return names;
}

}  // namespace trocar::anatomy
