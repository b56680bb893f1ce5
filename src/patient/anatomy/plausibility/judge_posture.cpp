// The CT table against the posture.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "anatomy/plausibility/judge_anatomy.h"

namespace trocar::anatomy {
namespace {

// Assumed: a table's shell is denser than foam and clothes, runs through most slices, and is as wide as the body.
constexpr int kTableAbove_hu = -700;
constexpr double kBlock_mm = 5.0;
constexpr double kShareOfSlices = 0.7;
constexpr double kLeastCover = 0.35;  ///< Of the body's width that the table covers on its side.
constexpr double kLeastBeside = 0.6;  ///< The same on the left and right, where an arm covers some of it.
constexpr double kClearCover = 2.0;   ///< Times that on every other side: arms and the table's rims cover less.
constexpr std::int64_t kFewestSlices = 5;

/// Seen along the body, in blocks of voxels: which ones hold body, and which ones the table.
struct TableView {
  std::int64_t nx = 0, ny = 0;
  std::vector<std::uint8_t> body, table;
  bool is_body(std::int64_t x, std::int64_t y) const { return body[static_cast<std::size_t>(y * nx + x)] != 0; }
  bool is_table(std::int64_t x, std::int64_t y) const { return table[static_cast<std::size_t>(y * nx + x)] != 0; }
};

/// Body or something dense outside it, in the blocks of one slice.
struct SliceBlocks {
  std::vector<std::uint8_t> body, dense;
};

void fill_blocks(const volume::CtGrid& ct, const volume::MaskGrid& body, std::int64_t k,
                 const std::array<std::int64_t, 2>& step, const TableView& view, SliceBlocks& blocks) {
  std::ranges::fill(blocks.body, std::uint8_t{0});
  std::ranges::fill(blocks.dense, std::uint8_t{0});
  const volume::GridGeometry& g = ct.geometry;
  std::size_t n = g.offset({0, 0, k});
  for (std::int64_t j = 0; j < g.size[1]; ++j)
    for (std::int64_t i = 0; i < g.size[0]; ++i, ++n) {
      const auto block = static_cast<std::size_t>(j / step[1] * view.nx + i / step[0]);
      if (body.voxels[n] != 0) {
        blocks.body[block] = 1;
      } else if (ct.voxels[n] > kTableAbove_hu) {
        blocks.dense[block] = 1;
      }
    }
}

bool is_near_body(const SliceBlocks& blocks, const TableView& view, std::int64_t x, std::int64_t y) {
  for (std::int64_t v = std::max<std::int64_t>(y - 1, 0); v <= std::min(y + 1, view.ny - 1); ++v)
    for (std::int64_t u = std::max<std::int64_t>(x - 1, 0); u <= std::min(x + 1, view.nx - 1); ++u)
      if (blocks.body[static_cast<std::size_t>(v * view.nx + u)] != 0) return true;
  return false;
}

TableView view_along_body(const volume::CtGrid& ct, const volume::MaskGrid& body) {
  const volume::GridGeometry& g = ct.geometry;
  const std::array<std::int64_t, 2> step{std::max<std::int64_t>(1, std::lround(kBlock_mm / g.spacing_mm.x())),
                                         std::max<std::int64_t>(1, std::lround(kBlock_mm / g.spacing_mm.y()))};
  TableView view{(g.size[0] + step[0] - 1) / step[0], (g.size[1] + step[1] - 1) / step[1], {}, {}};
  const auto count = static_cast<std::size_t>(view.nx * view.ny);
  std::vector<std::int64_t> body_slices(count), dense_slices(count);
  SliceBlocks blocks{std::vector<std::uint8_t>(count), std::vector<std::uint8_t>(count)};
  for (std::int64_t k = 0; k < g.size[2]; ++k) {
    fill_blocks(ct, body, k, step, view, blocks);
    for (std::int64_t y = 0; y < view.ny; ++y)
      for (std::int64_t x = 0; x < view.nx; ++x) {
        const auto block = static_cast<std::size_t>(y * view.nx + x);
        body_slices[block] += blocks.body[block];
        dense_slices[block] += blocks.dense[block] != 0 && !is_near_body(blocks, view, x, y) ? 1 : 0;
      }
  }
  for (std::size_t block = 0; block < count; ++block) {
    view.body.push_back(2 * body_slices[block] > g.size[2] ? 1 : 0);
    const double share = static_cast<double>(dense_slices[block]) / static_cast<double>(g.size[2]);
    view.table.push_back(share >= kShareOfSlices ? 1 : 0);
  }
  return view;
}

/// Share of the body's lines along an axis (x: 0, y: 1) with a piece of the table beyond the body at the low and at
/// the high end.
std::array<double, 2> cover_along(const TableView& view, bool is_y) {
  const std::int64_t lines = is_y ? view.nx : view.ny, length = is_y ? view.ny : view.nx;
  double of_body = 0.0;
  std::array<double, 2> covered{};
  for (std::int64_t line = 0; line < lines; ++line) {
    std::int64_t first = length, last = -1;
    const auto is_body = [&](std::int64_t n) { return is_y ? view.is_body(line, n) : view.is_body(n, line); };
    const auto is_table = [&](std::int64_t n) { return is_y ? view.is_table(line, n) : view.is_table(n, line); };
    for (std::int64_t n = 0; n < length; ++n)
      if (is_body(n)) first = std::min(first, n), last = n;
    if (last < 0) continue;
    of_body += 1.0;
    bool is_low = false, is_high = false;
    for (std::int64_t n = 0; n < first; ++n) is_low |= is_table(n);
    for (std::int64_t n = last + 1; n < length; ++n) is_high |= is_table(n);
    covered[0] += is_low ? 1.0 : 0.0;
    covered[1] += is_high ? 1.0 : 0.0;
  }
  for (double& share : covered) share /= std::max(of_body, 1.0);
  return covered;
}

const char* side_words(Posture posture) {
  switch (posture) {
    case Posture::kProne:
      return "in front of the body";
    case Posture::kLeftLateral:
      return "left of the body";
    case Posture::kRightLateral:
      return "right of the body";
    case Posture::kSupine:
    case Posture::kSitting:
      break;
  }
  return "behind the body";
}

}  // namespace

std::optional<Posture> find_scanned_posture(const volume::CtGrid& ct, const volume::MaskGrid& body) {
  if (ct.geometry.size[2] < kFewestSlices) return std::nullopt;
  const TableView view = view_along_body(ct, body);
  const auto x = cover_along(view, false), y = cover_along(view, true);
  std::array<std::pair<double, Posture>, 4> sides{{{y[1], Posture::kSupine},
                                                   {y[0], Posture::kProne},
                                                   {x[1], Posture::kLeftLateral},
                                                   {x[0], Posture::kRightLateral}}};
  std::ranges::sort(sides, [](const auto& a, const auto& b) { return a.first > b.first; });
  const auto& [cover, posture] = sides[0];
  const bool is_beside = posture == Posture::kLeftLateral || posture == Posture::kRightLateral;
  if (cover < (is_beside ? kLeastBeside : kLeastCover) || cover < kClearCover * sides[1].first) return std::nullopt;
  return posture;
}

std::vector<AnatomyFinding> judge_posture(const volume::CtGrid& ct, const volume::MaskGrid& body, Posture posture) {
  const std::optional<Posture> scanned = find_scanned_posture(ct, body);
  if (!scanned || *scanned == posture) return {};
  return {{kPosture,
           fmt::format("the table lies {}: the CT was taken {} ({}), and organs, gas and fluid lie as they did then, "
                       "while the patient is {} ({})",
                       side_words(*scanned), posture_words(*scanned), posture_name(*scanned), posture_words(posture),
                       posture_name(posture)),
           fmt::format("build with {}{}", kUsePosture, posture_name(*scanned)), false,
           fmt::format("{}{}", kUsePosture, posture_name(*scanned))}};
}

}  // namespace trocar::anatomy
