#pragma once

#include <optional>

#include "metrics/detail/uniform_sampler.h"

namespace trocar::metrics::detail {

/// The needle's way without the noise of its recording: from its first moment through the means of a UniformSampler to
/// its last one. Noise adds to a length with every moment: 0.02 mm at 1 kHz make five times the length of a way.
class SmoothPath {
 public:
  struct Point {
    Vec3 tip_P, axis_P;
    double depth_mm = 0.0;  ///< 0 where the recording has none.
    double inside = 0.0;    ///< Share of the way about it that lies in the body, 0..1.
  };

  /// Calls visit(from, to) for each new piece of the way. Pieces do not lead over a pause or a gap.
  template <class Visit>
  void add(const Step& step, Visit&& visit) {
    const bool is_joined = step.before != nullptr && step.dt_s <= UniformSampler::kLongestGap_s;
    if (!is_joined) {
      finish(visit);
      last_ = point_of(step.now);
    }
    now_ = point_of(step.now);
    sampler_.add(step, [&](const UniformSampler::Sample& sample) {
      const Point mean{sample.tip_P, sample.axis_P.normalized(), sample.depth_mm, sample.inside};
      visit(*last_, mean);
      last_ = mean;
    });
  }
  /// The piece from the last mean to the last moment.
  template <class Visit>
  void finish(Visit&& visit) const {
    if (last_ && now_) visit(*last_, *now_);
  }

 private:
  static Point point_of(const Moment& moment) {
    const double depth_mm = moment.depth_mm.value_or(0.0);
    return {moment.tip_P, moment.axis_P, depth_mm, depth_mm > 0.0 ? 1.0 : 0.0};
  }

  UniformSampler sampler_;
  std::optional<Point> last_, now_;  ///< The end of the way so far; the last moment.
};

}  // namespace trocar::metrics::detail
