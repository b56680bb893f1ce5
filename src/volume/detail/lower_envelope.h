#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace trocar::detail {

/// Lower envelope of the parabolas (x - position)^2 + value, added in order of rising position (Felzenszwalb &
/// Huttenlocher 2012, doi 10.4086/toc.2012.v008a019); here at any positions, evaluated at multiples of a spacing.
class LowerEnvelope {
 public:
  explicit LowerEnvelope(std::size_t capacity) : parabolas_(capacity) {}

  void clear() noexcept { count_ = 0; }

  /// A parabola of infinite value is none. At most `capacity` may be added; positions rise strictly.
  void add(double position, double value) noexcept {
    if (value == std::numeric_limits<double>::infinity()) return;
    const double height = value + position * position;
    double from = -std::numeric_limits<double>::infinity();
    while (count_ > 0) {
      const Parabola& last = parabolas_[count_ - 1];
      from = (height - last.height) / (2.0 * (position - last.position));
      if (from > last.from) break;
      --count_;
      from = -std::numeric_limits<double>::infinity();
    }
    parabolas_[count_++] = {position, value, height, from};
  }

  /// out[n] = the envelope at n * spacing; infinity where nothing was added.
  void evaluate(double spacing, std::span<float> out) const noexcept {
    if (count_ == 0) {
      for (float& v : out) v = std::numeric_limits<float>::infinity();
      return;
    }
    std::size_t current = 0;
    for (std::size_t n = 0; n < out.size(); ++n) {
      const double x = static_cast<double>(n) * spacing;
      while (current + 1 < count_ && parabolas_[current + 1].from < x) ++current;
      const double along = x - parabolas_[current].position;
      out[n] = static_cast<float>(along * along + parabolas_[current].value);
    }
  }

 private:
  struct Parabola {
    double position;
    double value;
    double height;  ///< Value plus squared position.
    double from;    ///< It is the lowest from here to the next one's.
  };
  std::vector<Parabola> parabolas_;
  std::size_t count_ = 0;
};

}  // namespace trocar::detail
