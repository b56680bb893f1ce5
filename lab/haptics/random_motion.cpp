#include "lab/haptics/random_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace trocar::haptics {
namespace {

constexpr double kOver_mm = 15.0;  // of the start over the skin
constexpr double kHover_mm = 3.0;
constexpr double kInAir_mm_per_s = 150.0;
constexpr double kLongest_s = 1.0;        // of a pause
constexpr double kWidestSwing_mm = 15.0;  // of the tip about a pivot behind it
constexpr double kInside_mm = 3.0;        // an elastic motion stays this far from both ends of its channel

/// A random motion as it is composed.
class Composer {
 public:
  Composer(const MotionPlace& place, Random& random, double pivot_mm)
      : place_(place),
        random_(random),
        widest_rad_(std::min(place.widest_rad, kWidestSwing_mm / std::max(pivot_mm, 1.0))),
        motion_({needle_pose(place.skin_P, place.axis_P).R(), place.skin_P - kOver_mm * place.inward_P}, pivot_mm) {
    const Vec3 any = std::abs(place.inward_P.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitY();
    side_P_ = place.inward_P.cross(any).normalized();
    other_P_ = place.inward_P.cross(side_P_);
  }

  Random& random() noexcept { return random_; }
  const MotionPlace& place() const noexcept { return place_; }
  bool chance(double share) noexcept { return random_.uniform() < share; }
  int count(int least, int most) noexcept {
    return least + static_cast<int>(random_.uniform() * static_cast<double>(most - least + 1));
  }
  /// A way along the axis from the place on the skin, as a translation from the start.
  Vec3 along(double way_mm) const noexcept { return kOver_mm * place_.inward_P + way_mm * place_.axis_P; }
  /// Over the skin on the axis.
  Vec3 over() const noexcept {
    constexpr double kGrazing = 0.17;
    return along(-kHover_mm / std::max(kGrazing, place_.axis_P.dot(place_.inward_P)));
  }
  Vec3 on_skin(double most_mm) noexcept {
    const double angle = random_.uniform(0.0, 2.0 * std::numbers::pi);
    return random_.uniform(0.05, 1.0) * most_mm * (std::cos(angle) * side_P_ + std::sin(angle) * other_P_);
  }
  /// A direction across the axis, times at most `most_mm`.
  Vec3 across(double most_mm) noexcept {
    Vec3 v = on_skin(1.0);
    v -= v.dot(place_.axis_P) * place_.axis_P;
    return most_mm * v;
  }
  Vec3 turn() noexcept {
    const double most = widest_rad_ * random_.uniform();
    if (chance(0.2)) return random_.uniform(-3.0, 3.0) * most * place_.axis_P;  // roll
    Vec3 v(random_.normal(), random_.normal(), random_.normal());
    return most * v.normalized();
  }
  Vec3 maybe_turn(double share) noexcept { return chance(share) ? turn() : Vec3(Vec3::Zero()); }
  double tempo() noexcept { return std::min(330.0, place_.tempo_mm_per_s * random_.uniform(0.7, 1.4)); }

  void go(const Vec3& shift_P, const Vec3& turn_P = Vec3::Zero()) { motion_.go(shift_P, turn_P, tempo()); }
  void pass(const Vec3& shift_P, const Vec3& turn_P) { motion_.pass(shift_P, turn_P, tempo()); }
  void fly(const Vec3& shift_P, const Vec3& turn_P = Vec3::Zero()) { motion_.go(shift_P, turn_P, kInAir_mm_per_s); }
  void maybe_wait(double share) {
    if (chance(share)) motion_.wait(random_.uniform(0.0, kLongest_s));
  }
  /// Back along the axis from `from_mm` by `by_mm`, as tissue recoils: with this time constant.
  void recede(double from_mm, double by_mm, double time_s) {
    constexpr int kSteps = 16;
    constexpr double kStep = 0.25;  // of the time constant
    double left = 1.0;
    for (int i = 0; i < kSteps; ++i) {
      const double next = i + 1 < kSteps ? left * std::exp(-kStep) : 0.0;
      const double mm_per_s = std::max(0.1, (left - next) * by_mm / (kStep * time_s));
      const Vec3 to_P = along(from_mm - (1.0 - next) * by_mm);
      if (i + 1 < kSteps) {
        motion_.pass(to_P, Vec3::Zero(), mm_per_s);
      } else {
        motion_.go(to_P, Vec3::Zero(), mm_per_s);
      }
      left = next;
    }
  }
  /// Off the skin from wherever the tool is.
  void lift() {
    const double deep_mm = (motion_.shift_P() - kOver_mm * place_.inward_P).dot(place_.inward_P);
    go(motion_.shift_P() - (std::max(0.0, deep_mm) + 2.0 * kHover_mm) * place_.inward_P, motion_.turn_rad_P());
  }
  ClosedMotion close() {
    motion_.close(kInAir_mm_per_s);
    return std::move(motion_);
  }

 private:
  const MotionPlace& place_;
  Random& random_;
  double widest_rad_;
  ClosedMotion motion_;
  Vec3 side_P_, other_P_;
};

constexpr double kWidestDrag_mm = 20.0;

ClosedMotion drag(Composer c) {
  const double load_mm = c.random().uniform(0.2, 0.98) * c.place().closed_mm;
  c.fly(c.over());
  c.go(c.along(load_mm));
  c.maybe_wait(0.3);
  c.go(c.along(load_mm) + c.on_skin(kWidestDrag_mm), c.maybe_turn(0.3));
  c.maybe_wait(0.3);
  c.lift();
  return c.close();
}

ClosedMotion slide(Composer c) {
  c.fly(c.over());
  for (int i = c.count(2, 6); i > 0; --i) {
    const double load_mm = c.random().uniform(0.1, 0.98) * c.place().closed_mm;
    c.go(c.along(load_mm) + c.on_skin(0.7 * kWidestDrag_mm), c.maybe_turn(0.6));
    c.maybe_wait(0.2);
  }
  c.lift();
  return c.close();
}

ClosedMotion tap(Composer c) {
  c.fly(c.over());
  for (int i = c.count(2, 6); i > 0; --i) {
    c.go(c.along(c.random().uniform(0.05, 0.98) * c.place().closed_mm));
    c.maybe_wait(0.3);
    c.go(c.chance(0.5) ? c.over() : c.along(c.random().uniform(-1.0, 0.3)));
  }
  c.fly(c.over());
  return c.close();
}

double inside(Composer& c) {
  return c.random().uniform(std::min(c.place().closed_mm, c.place().deepest_mm), c.place().deepest_mm);
}

ClosedMotion puncture(Composer c) {
  c.fly(c.over());
  c.go(c.along(inside(c)));
  c.maybe_wait(0.5);
  c.go(c.over());
  return c.close();
}

ClosedMotion giving_way(Composer c) {
  const double at_mm = c.place().closed_mm;
  c.fly(c.over());
  const bool follows = c.chance(0.6);  // the tissue that recoils
  double way_mm = at_mm + c.random().uniform(0.02, 2.0);
  c.go(c.along(way_mm));
  if (follows) {
    way_mm += c.random().uniform(0.0, c.chance(0.3) ? 25.0 : 8.0);
    c.fly(c.along(way_mm));  // to what lies behind, before the tissue has recoiled
    const double by_mm = c.random().uniform(0.2, 1.1) * at_mm;
    c.recede(way_mm, by_mm, c.random().uniform(0.08, 0.4));
    way_mm -= by_mm;
  }
  for (int i = c.count(1, 4); i > 0; --i) {
    c.maybe_wait(0.7);
    way_mm =
        c.chance(0.5) ? std::max(0.0, way_mm + c.random().uniform(-10.0, 5.0)) : c.random().uniform(0.0, at_mm + 5.0);
    c.go(c.along(way_mm));
  }
  c.maybe_wait(0.7);
  c.go(c.over());
  return c.close();
}

ClosedMotion reentry(Composer c) {
  c.fly(c.over());
  c.go(c.along(inside(c)));
  c.maybe_wait(0.3);
  c.go(c.over());
  for (int i = c.count(1, 2); i > 0; --i) {
    const Vec3 beside = c.chance(0.3) ? Vec3(Vec3::Zero()) : c.across(3.0);
    const Vec3 turn = c.chance(0.5) ? Vec3(Vec3::Zero()) : 0.4 * c.turn();
    c.maybe_wait(0.3);
    c.fly(c.over() + beside, turn);
    c.go(c.along(inside(c)) + beside, turn);
    c.maybe_wait(0.3);
    c.go(c.over() + beside, turn);
  }
  return c.close();
}

constexpr double kWidestBend_mm = 15.0;

/// Deep in the body, by `move`, and out again.
template <class Move>
ClosedMotion deep(Composer c, Move&& move) {
  const double depth_mm = inside(c);
  c.fly(c.over());
  c.go(c.along(depth_mm));
  c.maybe_wait(0.3);
  for (int i = c.count(1, 5); i > 0; --i) {
    move(c, depth_mm);
    c.maybe_wait(0.2);
  }
  c.go(c.along(depth_mm));
  c.go(c.over());
  return c.close();
}

ClosedMotion bend(Composer c) {
  const bool goes_deeper = c.chance(0.5);
  return deep(std::move(c), [goes_deeper](Composer& d, double depth_mm) {
    const double by_mm = goes_deeper ? d.random().uniform(-0.5, 0.1) * depth_mm : 0.0;
    d.go(d.along(depth_mm + by_mm) + d.across(kWidestBend_mm));
  });
}

ClosedMotion turn(Composer c) {
  return deep(std::move(c), [](Composer& d, double depth_mm) { d.go(d.along(depth_mm), d.turn()); });
}

ClosedMotion screw(Composer c) {
  c.fly(c.over());
  for (int i = c.count(2, 6); i > 0; --i)
    c.go(c.along(c.random().uniform(-2.0, c.place().deepest_mm)) + c.across(0.6 * kWidestBend_mm), c.turn());
  c.lift();
  return c.close();
}

ClosedMotion spline(Composer c) {
  c.fly(c.over());
  for (int i = c.count(3, 10); i > 0; --i)
    c.pass(c.along(c.random().uniform(-5.0, c.place().deepest_mm)) + c.across(0.8 * kWidestBend_mm), c.maybe_turn(0.7));
  c.lift();
  return c.close();
}

ClosedMotion elastic_skin(Composer c) {
  c.fly(c.over());
  for (int i = c.count(1, 6); i > 0; --i) {
    const double load_mm = c.random().uniform(0.1, 1.0) * c.place().closed_mm;
    c.go(c.along(load_mm) + c.on_skin(0.7 * kWidestDrag_mm), c.maybe_turn(0.5));
  }
  c.lift();
  return c.close();
}

ClosedMotion elastic_channel(Composer c) {
  const double deepest_mm = c.place().deepest_mm - kInside_mm;
  const auto depth = [&] { return c.random().uniform(kInside_mm, deepest_mm); };
  c.fly(c.over());
  c.go(c.along(depth()));
  for (int i = c.count(1, 6); i > 0; --i) c.go(c.along(depth()) + c.across(kWidestBend_mm), c.maybe_turn(0.6));
  c.go(c.along(depth()));
  c.go(c.over());
  return c.close();
}

}  // namespace

const char* to_string(MotionKind kind) noexcept {
  switch (kind) {
    case MotionKind::kDrag:
      return "drag";
    case MotionKind::kSlide:
      return "slide";
    case MotionKind::kTap:
      return "tap";
    case MotionKind::kPuncture:
      return "puncture";
    case MotionKind::kGiveWay:
      return "give-way";
    case MotionKind::kReentry:
      return "reentry";
    case MotionKind::kBend:
      return "bend";
    case MotionKind::kTurn:
      return "turn";
    case MotionKind::kScrew:
      return "screw";
    case MotionKind::kSpline:
      return "spline";
    case MotionKind::kElasticSkin:
      return "elastic-skin";
    case MotionKind::kElasticChannel:
      return "elastic-channel";
    case MotionKind::kElasticWall:
      return "elastic-wall";
  }
  return "drag";
}

bool is_elastic(MotionKind kind) noexcept {
  return std::find(kElasticKinds.begin(), kElasticKinds.end(), kind) != kElasticKinds.end();
}

std::optional<ClosedMotion> motion_before(MotionKind kind, const MotionPlace& place) {
  if (kind != MotionKind::kElasticChannel && kind != MotionKind::kElasticWall) return std::nullopt;
  constexpr double kTempo_mm_per_s = 60.0;
  Random none(1);
  const Composer on_axis(place, none, 0.0);
  ClosedMotion motion({needle_pose(place.skin_P, place.axis_P).R(), place.skin_P - kOver_mm * place.inward_P}, 0.0);
  motion.go(on_axis.over(), Vec3::Zero(), kTempo_mm_per_s);
  motion.go(on_axis.along(place.deepest_mm), Vec3::Zero(), kTempo_mm_per_s);
  motion.wait(0.5);
  motion.go(on_axis.over(), Vec3::Zero(), kTempo_mm_per_s);
  motion.close(kTempo_mm_per_s);
  return motion;
}

ClosedMotion make_random_motion(MotionKind kind, const MotionPlace& place, Random& random) {
  const double share = random.uniform();
  const double pivot_mm = share < 0.4 ? 0.0 : share < 0.7 ? place.length_mm : random.uniform(0.0, place.length_mm);
  Composer composer(place, random, pivot_mm);
  switch (kind) {
    case MotionKind::kDrag:
      return drag(std::move(composer));
    case MotionKind::kSlide:
      return slide(std::move(composer));
    case MotionKind::kTap:
      return tap(std::move(composer));
    case MotionKind::kPuncture:
      return puncture(std::move(composer));
    case MotionKind::kGiveWay:
      return giving_way(std::move(composer));
    case MotionKind::kReentry:
      return reentry(std::move(composer));
    case MotionKind::kBend:
      return bend(std::move(composer));
    case MotionKind::kTurn:
      return turn(std::move(composer));
    case MotionKind::kScrew:
      return screw(std::move(composer));
    case MotionKind::kSpline:
      return spline(std::move(composer));
    case MotionKind::kElasticSkin:
      return elastic_skin(std::move(composer));
    case MotionKind::kElasticChannel:
    case MotionKind::kElasticWall:
      return elastic_channel(std::move(composer));
  }
  return drag(std::move(composer));
}

}  // namespace trocar::haptics
