#include "registration/matching/detail/nearest.h"

#include <algorithm>

#include "core/parallel.h"
#include "core/result.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "registration/matching/detail/nearest.cpp"
#include <hwy/foreach_target.h>
// After foreach_target.h, which sets the instruction set that these headers compile for.
#include <hwy/highway.h>

#ifndef TROCAR_REGISTRATION_NEAREST_TILE
#define TROCAR_REGISTRATION_NEAREST_TILE
namespace trocar::registration::detail {
inline constexpr std::size_t kTile = 4;  ///< Descriptors of either set that are multiplied together.
}
#endif

HWY_BEFORE_NAMESPACE();
namespace trocar::registration::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Products of 4 rows and `Columns` columns, into rows of kTile products. The sums fit the registers.
template <std::size_t Columns>
void multiply(const std::int16_t* const* a, const std::int16_t* const* b, std::int32_t* products) {
  const hn::ScalableTag<std::int16_t> s16;
  const hn::ScalableTag<std::int32_t> s32;
  // Some targets add every second product to a sum of its own.
  hn::Vec<decltype(s32)> even[kTile][Columns], odd[kTile][Columns];
  for (std::size_t r = 0; r < kTile; ++r)
    for (std::size_t c = 0; c < Columns; ++c) even[r][c] = odd[r][c] = hn::Zero(s32);
  for (std::size_t n = 0; n < kDescriptorSize; n += hn::Lanes(s16)) {
    hn::Vec<decltype(s16)> column[Columns];
    for (std::size_t c = 0; c < Columns; ++c) column[c] = hn::LoadU(s16, b[c] + n);
    for (std::size_t r = 0; r < kTile; ++r) {
      const auto row = hn::LoadU(s16, a[r] + n);
      for (std::size_t c = 0; c < Columns; ++c)
        even[r][c] = hn::ReorderWidenMulAccumulate(s32, row, column[c], even[r][c], odd[r][c]);
    }
  }
  for (std::size_t r = 0; r < kTile; ++r)
    for (std::size_t c = 0; c < Columns; ++c)
      products[r * kTile + c] = hn::GetLane(hn::SumOfLanes(s32, hn::Add(even[r][c], odd[r][c])));
}

/// Products of 4 x 4 descriptors, row by row.
void multiply_tile(const std::int16_t* const* a, const std::int16_t* const* b, std::int32_t* products) {
#if HWY_TARGET <= HWY_AVX3
  multiply<4>(a, b, products);
#else
  multiply<2>(a, b, products);
  multiply<2>(a, b + 2, products + 2);
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace trocar::registration::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace trocar::registration::detail {
HWY_EXPORT(multiply_tile);

namespace {

constexpr std::size_t kRowsTogether = 256;    ///< Of a thread.
constexpr std::size_t kColumnsTogether = 64;  ///< 256 KiB, in the second cache.

struct Set {
  std::span<const Descriptor> descriptors;
  std::span<const std::uint32_t> owners;
};

/// Pointers to the descriptors of a tile; the last one again beyond the end.
void point_to_tile(const Set& set, std::size_t first, const std::int16_t** rows) {
  for (std::size_t n = 0; n < kTile; ++n)
    rows[n] = set.descriptors[std::min(first + n, set.descriptors.size() - 1)].data();
}

void offer_tile(const Set& a, std::size_t row, const Set& b, std::size_t column, std::vector<Nearest>& of_a,
                std::vector<Nearest>& of_b) {
  const std::int16_t* rows[kTile];
  const std::int16_t* columns[kTile];
  std::int32_t products[kTile * kTile];
  point_to_tile(a, row, rows);
  point_to_tile(b, column, columns);
  HWY_DYNAMIC_DISPATCH(multiply_tile)(rows, columns, products);
  for (std::size_t r = 0; r < kTile && row + r < a.descriptors.size(); ++r) {
    for (std::size_t c = 0; c < kTile && column + c < b.descriptors.size(); ++c) {
      const std::int32_t product = products[r * kTile + c];
      of_a[row + r].offer(product, static_cast<std::uint32_t>(column + c), b.owners[column + c]);
      of_b[column + c].offer(product, static_cast<std::uint32_t>(row + r), a.owners[row + r]);
    }
  }
}

void multiply_rows(const Set& a, std::size_t first, std::size_t last, const Set& b, std::vector<Nearest>& of_a,
                   std::vector<Nearest>& of_b) {
  for (std::size_t block = 0; block < b.descriptors.size(); block += kColumnsTogether) {
    const std::size_t end = std::min(block + kColumnsTogether, b.descriptors.size());
    for (std::size_t row = first; row < last; row += kTile)
      for (std::size_t column = block; column < end; column += kTile) offer_tile(a, row, b, column, of_a, of_b);
  }
}

}  // namespace

void Nearest::merge(const Nearest& other) noexcept {
  const bool is_other = other.product > product || (other.product == product && other.index < index);
  const Nearest& winner = is_other ? other : *this;
  const Nearest& loser = is_other ? *this : other;
  Nearest merged = winner;
  merged.second = std::max(winner.second, loser.owner == winner.owner ? loser.second : loser.product);
  *this = merged;
}

NearestOfBoth find_nearest(std::span<const Descriptor> a, std::span<const std::uint32_t> owners_a,
                           std::span<const Descriptor> b, std::span<const std::uint32_t> owners_b) {
  TROCAR_CHECK(a.size() == owners_a.size() && b.size() == owners_b.size());
  NearestOfBoth nearest{std::vector<Nearest>(a.size()), std::vector<Nearest>(b.size())};
  if (a.empty() || b.empty()) return nearest;
  const Set set_a{a, owners_a}, set_b{b, owners_b};
  const std::size_t parts = (a.size() + kRowsTogether - 1) / kRowsTogether;
  std::vector<std::vector<Nearest>> of_b(parts);
  parallel_for(parts, 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t part = first; part < last; ++part) {
      of_b[part].resize(b.size());
      multiply_rows(set_a, part * kRowsTogether, std::min(a.size(), (part + 1) * kRowsTogether), set_b, nearest.of_a,
                    of_b[part]);
    }
  });
  for (const std::vector<Nearest>& part : of_b)
    for (std::size_t n = 0; n < b.size(); ++n) nearest.of_b[n].merge(part[n]);
  return nearest;
}

}  // namespace trocar::registration::detail
#endif
