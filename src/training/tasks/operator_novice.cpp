#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "tasks/detail/guided_hand.h"
#include "tasks/detail/pending_actions.h"
#include "tasks/operator.h"

namespace trocar::tasks {
namespace {

// Errors of a novice; assumed unless stated otherwise.
constexpr double kTremor_mm = 0.2;  // rms a lateral axis: PMC3032442 figure 4, 0.17 and 0.25 mm without visual feedback
constexpr double kEntryError_mm[] = {3.0, 8.0};
constexpr double kAngleError_deg[] = {2.0, 6.0};  // CT-guided with a frame: median 1.1, range 0..6.6 (doi
                                                  // 10.3109/10929088.2011.578367)
constexpr double kStopError_mm[] = {3.0, 8.0};
constexpr double kStart_mm[] = {-26.0, -18.0};
constexpr double kSpeed_mm_s[] = {20.0, 35.0};
constexpr double kUnevenness = 0.5;
constexpr double kRhythm_hz[] = {0.4, 1.2};
constexpr double kHesitation_s[] = {0.8, 2.5};
constexpr double kPullback_mm[] = {6.0, 15.0};
constexpr double kPullbackChance = 0.6;  // residents: 2.4 pullbacks a biopsy, staff 1.2 (Hakime, freehand liver biopsy)
constexpr double kPullback_mm_s = 15.0;
constexpr double kBeforeFire_s[] = {0.3, 1.5};
constexpr double kAfterFire_s = 0.5;
constexpr double kLoading_s = 6.0;  // takes the core out and loads the gun
// Share of novices who give anaesthetic, of those who look what comes back, and of those who turn the bevel.
constexpr double kRemembers = 0.7;
constexpr double kBevelError_deg = 20.0;  // of those who turn it, at most
constexpr double kWithdraw_mm_s = 50.0;
constexpr double kStuck_s = 5.0;
constexpr double kBone_s = 1.5;          // without a millimetre of progress: it is bone
constexpr int kCorrections = 2;          // after bone: out, another direction, in again; then the novice stays
constexpr double kCorrectedShare = 0.5;  // of entry and direction that a correction leaves of the error
constexpr double kStop_s = 40.0;         // in any case: fire and withdraw
constexpr double kOutOfTime_s = 58.0;

double draw(Random& random, const double (&range)[2]) noexcept {
  return random.uniform(range[0], range[1]);
}

/// The novice's actual line: entry and angle with errors in random directions.
Segment miss(const Segment& path_P, Random& random) noexcept {
  const Mat3 R_PN = needle_pose(path_P.a, path_P.direction()).R();
  const auto sideways_P = [&] {
    const double angle_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
    return Vec3(R_PN * Vec3(std::cos(angle_rad), std::sin(angle_rad), 0.0));
  };
  const Vec3 entry_P = path_P.a + draw(random, kEntryError_mm) * sideways_P();
  const double tilt_rad = draw(random, kAngleError_deg) * std::numbers::pi / 180.0;
  const Vec3 axis_P = std::cos(tilt_rad) * path_P.direction() + std::sin(tilt_rad) * sideways_P();
  return {entry_P, entry_P + path_P.length_mm() * axis_P};
}

/// Some forget the bevel: it faces anywhere.
std::optional<Vec3> aim_bevel(const OperatorCase& the_case) noexcept {
  if (!the_case.bevel_P) return std::nullopt;
  Random random(mix64(the_case.seed + 3));
  const bool forgets = random.uniform() > kRemembers;
  const double error_rad = forgets ? random.uniform(0.0, 2.0 * std::numbers::pi)
                                   : (2.0 * random.uniform() - 1.0) * kBevelError_deg * std::numbers::pi / 180.0;
  return Eigen::AngleAxisd(error_rad, the_case.path_P.direction()) * *the_case.bevel_P;
}

class Novice final : public Operator {
 public:
  explicit Novice(const OperatorCase& the_case) noexcept : Novice(the_case, Random(mix64(the_case.seed))) {}

  HandCommand next(const OperatorView& view) noexcept override {
    hand_.sense(view);
    std::optional<ActionKind> gun;
    double speed_mm_s = 0.0;
    switch (step_) {
      case Step::kAdvance:
        speed_mm_s = advance_speed_mm_s();
        if (next_doubt_ < doubts_.size() && hand_.tip_mm() > doubts_[next_doubt_].depth_mm) enter(Step::kHesitate);
        if (hand_.tip_mm() > stop_mm_ || is_stuck(kStuck_s) || hand_.elapsed_s() > kStop_s) enter(Step::kAim);
        if (step_ == Step::kAdvance && corrections_left_ > 0 && is_stuck(kBone_s)) enter(Step::kBackOut);
        break;
      case Step::kBackOut:
        speed_mm_s = -kWithdraw_mm_s;
        if (hand_.tip_mm() < start_mm_ + 2.0) correct();
        break;
      case Step::kHesitate:
        if (in_step_s() > doubts_[next_doubt_].pause_s) enter(Step::kPullBack);
        break;
      case Step::kPullBack:
        speed_mm_s = -kPullback_mm_s;
        if (in_step_s() * kPullback_mm_s > doubts_[next_doubt_].pullback_mm) {
          ++next_doubt_;
          enter(Step::kAdvance);
        }
        break;
      case Step::kAim:
        if (in_step_s() > before_fire_s_) {
          if (cores_left_ > 0) gun = ActionKind::kFire;
          enter(Step::kAfterFire);
        }
        break;
      case Step::kAfterFire:
        if (in_step_s() > kAfterFire_s) {
          if (cores_left_ > 0) --cores_left_;
          enter(cores_left_ > 0 && loads_inside_ ? Step::kLoad : Step::kWithdraw);
        }
        break;
      case Step::kLoad:
        if (in_step_s() > kLoading_s) {
          gun = ActionKind::kLoad;
          enter(Step::kAim);
        }
        break;
      case Step::kWithdraw:
        speed_mm_s = hand_.wanted_mm() > start_mm_ ? -kWithdraw_mm_s : 0.0;
        if (hand_.tip_mm() < start_mm_ + 2.0 || hand_.elapsed_s() > kOutOfTime_s) enter(Step::kDone);
        break;
      case Step::kDone:
        break;
    }
    hand_.move(speed_mm_s, view.dt_s);
    HandCommand command = hand_.command();
    if (gun) command.action = ActionRequest{*gun};
    if (!gun) command.action = actions_.next(step_ == Step::kAfterFire ? std::optional(in_step_s()) : std::nullopt);
    command.is_done = step_ == Step::kDone;
    return command;
  }

 private:
  enum class Step { kAdvance, kBackOut, kHesitate, kPullBack, kAim, kAfterFire, kLoad, kWithdraw, kDone };
  struct Doubt {
    double depth_mm;
    double pause_s;
    double pullback_mm;
  };

  Novice(const OperatorCase& the_case, Random random) noexcept
      : start_mm_(draw(random, kStart_mm)),
        plan_P_(the_case.path_P),
        line_P_(miss(plan_P_, random)),
        bevel_P_(aim_bevel(the_case)),
        hand_(line_P_, bevel_P_, start_mm_,
              Tremor(std::hypot(kTremor_mm, the_case.tremor_mm), mix64(the_case.seed + 1))),
        cores_left_(the_case.fires_biopsy ? the_case.actions.cores : 0),
        loads_inside_(the_case.actions.loads_inside),
        actions_(the_case.actions) {
    Random forgets(mix64(the_case.seed + 2));
    if (forgets.uniform() > kRemembers) actions_.forget_anaesthetic();
    if (forgets.uniform() > kRemembers) actions_.forget_confirmation();
    const double length_mm = the_case.path_P.length_mm();
    stop_mm_ = length_mm + (random.uniform() < 0.5 ? -1.0 : 1.0) * draw(random, kStopError_mm);
    speed_mm_s_ = draw(random, kSpeed_mm_s);
    rhythm_rad_s_ = 2.0 * std::numbers::pi * draw(random, kRhythm_hz);
    before_fire_s_ = draw(random, kBeforeFire_s);
    double depth = 0.0;
    for (Doubt& doubt : doubts_) {
      depth += random.uniform(0.15, 0.45);
      doubt = {depth * length_mm, draw(random, kHesitation_s),
               random.uniform() < kPullbackChance ? draw(random, kPullback_mm) : 0.0};
    }
  }

  void enter(Step step) noexcept {
    step_ = step;
    step_start_s_ = hand_.elapsed_s();
  }
  double in_step_s() const noexcept { return hand_.elapsed_s() - step_start_s_; }

  double advance_speed_mm_s() const noexcept {
    return speed_mm_s_ * (1.0 + kUnevenness * std::sin(rhythm_rad_s_ * hand_.elapsed_s()));
  }

  bool is_stuck(double longest_s) noexcept { return stall_.stalled_s(hand_, step_start_s_) > longest_s; }

  /// Outside of the body: nearer to the right entry and direction, and in again.
  void correct() noexcept {
    --corrections_left_;
    line_P_ = {plan_P_.a + kCorrectedShare * (line_P_.a - plan_P_.a),
               plan_P_.b + kCorrectedShare * (line_P_.b - plan_P_.b)};
    hand_.turn_to(line_P_, bevel_P_);
    stall_ = {};
    enter(Step::kAdvance);
  }

  double start_mm_;
  Segment plan_P_, line_P_;  ///< The right one, and the novice's.
  std::optional<Vec3> bevel_P_;
  GuidedHand hand_;
  std::size_t cores_left_;
  bool loads_inside_;
  PendingActions actions_;
  double stop_mm_ = 0.0;
  double speed_mm_s_ = 0.0;
  double rhythm_rad_s_ = 0.0;
  double before_fire_s_ = 0.0;
  std::array<Doubt, 3> doubts_{};
  std::size_t next_doubt_ = 0;
  int corrections_left_ = kCorrections;
  Step step_ = Step::kAdvance;
  double step_start_s_ = 0.0;
  StallWatch stall_;
};

}  // namespace

std::unique_ptr<Operator> make_novice(const OperatorCase& the_case) {
  return std::make_unique<Novice>(the_case);
}

}  // namespace trocar::tasks
