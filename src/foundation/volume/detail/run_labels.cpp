#include "volume/detail/run_labels.h"

#include <numeric>

namespace trocar::volume::detail {
namespace {

/// Union-find over runs; a root is the first run of its tree.
class Forest {
 public:
  explicit Forest(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0U); }

  std::uint32_t root(std::uint32_t n) noexcept {
    while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
    return n;
  }
  void join(std::uint32_t a, std::uint32_t b) noexcept {
    a = root(a);
    b = root(b);
    if (a < b) {
      parent_[b] = a;
    } else {
      parent_[a] = b;
    }
  }

 private:
  std::vector<std::uint32_t> parent_;
};

void find_runs(std::span<const std::uint8_t> row, bool of_set, std::vector<Run>& runs) {
  const std::size_t n = row.size();
  for (std::size_t i = 0; i < n;) {
    while (i < n && (row[i] != 0) != of_set) ++i;
    const std::size_t first = i;
    while (i < n && (row[i] != 0) == of_set) ++i;
    if (i > first) runs.push_back({static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(i - 1), 0});
  }
}

/// Joins the runs of two adjacent rows that share a column.
void join_rows(const RunLabels& labels, std::size_t row_a, std::size_t row_b, Forest& forest) {
  std::size_t a = labels.row_begin[row_a];
  std::size_t b = labels.row_begin[row_b];
  while (a < labels.row_begin[row_a + 1] && b < labels.row_begin[row_b + 1]) {
    const Run& run_a = labels.runs[a];
    const Run& run_b = labels.runs[b];
    if (run_a.first <= run_b.last && run_b.first <= run_a.last)
      forest.join(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
    if (run_a.last < run_b.last) {
      ++a;
    } else {
      ++b;
    }
  }
}

}  // namespace

RunLabels label_runs(std::span<const std::uint8_t> voxels, const Block& block, bool of_set) {
  RunLabels labels;
  labels.block = block;
  const std::size_t row_count = block.rows * block.planes;
  labels.row_begin.reserve(row_count + 1);
  for (std::size_t r = 0; r < row_count; ++r) {
    labels.row_begin.push_back(labels.runs.size());
    find_runs(voxels.subspan(r * block.columns, block.columns), of_set, labels.runs);
  }
  labels.row_begin.push_back(labels.runs.size());

  Forest forest(labels.runs.size());
  for (std::size_t r = 0; r < row_count; ++r) {
    if (r % block.rows > 0) join_rows(labels, r - 1, r, forest);
    if (r >= block.rows) join_rows(labels, r - block.rows, r, forest);
  }

  // A root precedes every other run of its tree, so its component is known when theirs is needed.
  for (std::size_t n = 0; n < labels.runs.size(); ++n) {
    const std::uint32_t root = forest.root(static_cast<std::uint32_t>(n));
    labels.runs[n].component =
        root == n ? static_cast<std::uint32_t>(labels.component_count++) : labels.runs[root].component;
  }
  return labels;
}

}  // namespace trocar::volume::detail
