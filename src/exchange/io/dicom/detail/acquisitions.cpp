#include "io/dicom/detail/acquisitions.h"

#include <fmt/format.h>

#include <cstdlib>
#include <map>
#include <string>

namespace trocar::io::detail {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kFewSlices = 6;
constexpr const char* kGiveOnePhase = "give the slices of one acquisition or phase alone, in a folder of their own";

/// Sum of the differences of two slices, over some of their pixels.
double difference(std::span<const std::int16_t> a, std::span<const std::int16_t> b) {
  constexpr std::size_t kStride = 7;
  double sum = 0.0;
  for (std::size_t n = 0; n < a.size(); n += kStride) sum += std::abs(static_cast<int>(a[n]) - static_cast<int>(b[n]));
  return sum;
}

}  // namespace

Status check_acquisitions(const std::vector<DicomSlice>& slices, const fs::path& folder) {
  std::map<std::string, std::size_t> count_of;
  std::size_t changes = 0;
  for (std::size_t n = 0; n < slices.size(); ++n) {
    ++count_of[slices[n].acquisition];
    changes += n > 0 && slices[n].acquisition != slices[n - 1].acquisition ? 1 : 0;
  }
  constexpr std::size_t kMostReturns = 1;
  if (changes <= count_of.size() - 1 + kMostReturns) return {};
  return fail(fmt::format("the slices of {} acquisitions or phases alternate {} times (AcquisitionNumber, "
                          "TemporalPositionIdentifier): they are mixed in one series",
                          count_of.size(), changes),
              folder.string(), kGiveOnePhase);
}

Status check_alternation(std::span<const std::int16_t> hu, std::size_t pixels, const fs::path& folder) {
  const std::size_t count = pixels == 0 ? 0 : hu.size() / pixels;
  if (count < kFewSlices) return {};
  const auto slice = [&](std::size_t k) { return hu.subspan(k * pixels, pixels); };
  double to_next = 0.0, to_next_but_one = 0.0;
  std::size_t closer = 0;
  for (std::size_t k = 0; k + 2 < count; ++k) {
    const double next = difference(slice(k), slice(k + 1)), next_but_one = difference(slice(k), slice(k + 2));
    to_next += next;
    to_next_but_one += next_but_one;
    closer += next_but_one < next ? 1 : 0;
  }
  // Slices of one scan differ the more, the farther they lie apart; with nothing but noise both are alike.
  constexpr double kClearly = 0.9, kMost = 0.8;
  if (to_next_but_one >= kClearly * to_next || static_cast<double>(closer) < kMost * static_cast<double>(count - 2))
    return {};
  return fail(fmt::format("every slice resembles the next but one more than the next (mean difference {:.0f} %): the "
                          "slices of two acquisitions or phases are mixed in one series",
                          100.0 * to_next_but_one / to_next),
              folder.string(), kGiveOnePhase);
}

}  // namespace trocar::io::detail
