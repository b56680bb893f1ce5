#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace trocar::volume::detail {

/// Lower envelope of the parabolas (x - position)^2 + value, added in order of rising position (Felzenszwalb &
/// Huttenlocher 2012, doi 10.4086/toc.2012.v008a019); here at arbitrary positions, evaluated at multiples of a spacing,
/// and without the divisions that compute the intersections.
class LowerEnvelope {
 public:
  explicit LowerEnvelope(std::size_t capacity) : parabolas_(capacity) {}

  void clear() noexcept { count_ = 0; }

  /// Adds a parabola; one of infinite value is ignored. At most `capacity` may be added; positions rise strictly.
  void add(double position, double value) noexcept {
    if (value == std::numeric_limits<double>::infinity()) return;
    const Parabola added{position, value};
    while (count_ >= 2 && is_hidden(parabolas_[count_ - 2], parabolas_[count_ - 1], added)) --count_;
    parabolas_[count_++] = added;
  }

  /// out[n] = the envelope at n * spacing; infinity if no parabola was added.
  void evaluate(double spacing, std::span<float> out) const noexcept {
    if (count_ == 0) {
      std::fill(out.begin(), out.end(), std::numeric_limits<float>::infinity());
      return;
    }
    std::size_t current = 0;
    for (std::size_t n = 0; n < out.size(); ++n) {
      const double x = static_cast<double>(n) * spacing;
      double lowest = parabolas_[current].at(x);
      for (; current + 1 < count_; ++current) {
        const double next = parabolas_[current + 1].at(x);
        if (next > lowest) break;
        lowest = next;
      }
      out[n] = static_cast<float>(lowest);
    }
  }

 private:
  struct Parabola {
    double position;
    double value;
    double at(double x) const noexcept { return (x - position) * (x - position) + value; }
  };

  /// True if b is nowhere below both a and c: c intersects a before b does.
  static bool is_hidden(const Parabola& a, const Parabola& b, const Parabola& c) noexcept {
    const double ab = b.position - a.position;
    const double bc = c.position - b.position;
    const double ac = ab + bc;
    return ac * b.value - bc * a.value - ab * c.value >= ab * bc * ac;
  }

  std::vector<Parabola> parabolas_;
  std::size_t count_ = 0;
};

}  // namespace trocar::volume::detail
