#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/random.h"
#include "tasks/detail/guided_hand.h"
#include "tasks/operator.h"

namespace trocar::tasks {
namespace {

// Errors of a novice; assumed unless stated otherwise.
constexpr double kNoviceTremor_mm =
    0.2;  // rms a lateral axis: PMC3032442 figure 4, 0.17 and 0.25 mm without visual feedback
constexpr double kEntryError_mm[] = {3.0, 8.0};
constexpr double kFeltThrough_mm = 10.0;          // fat over a landmark; more of it hides the landmark, in proportion
constexpr double kAngleError_deg[] = {2.0, 6.0};  // CT-guided with a frame: median 1.1, range 0..6.6 (doi
                                                  // 10.3109/10929088.2011.578367)
constexpr double kStopError_mm[] = {3.0, 8.0};  // on a path of kUsualPath_mm; depth is judged relatively (Weber's law)
constexpr double kUsualPath_mm = 60.0;
constexpr double kClumsiness[] = {0.25, 1.0};  // of one novice: share of the errors of entry, angle and depth
constexpr double kNoviceStart_mm[] = {-26.0, -18.0};
constexpr double kSpeed_mm_s[] = {20.0, 35.0};
constexpr double kUnevenness = 0.5;
constexpr double kRhythm_hz[] = {0.4, 1.2};
constexpr double kHesitation_s[] = {0.8, 2.5};
constexpr double kPullback_mm[] = {6.0, 15.0};
constexpr double kPullbackChance = 0.6;  // residents: 2.4 pullbacks a biopsy, staff 1.2 (Hakime, freehand liver biopsy)
constexpr double kPullback_mm_s = 15.0;
constexpr double kBeforeFire_s[] = {0.3, 1.5};
constexpr double kNoviceLoading_s = 6.0;  // takes the core out and loads the gun
// Share of novices who give anaesthetic, and of those who turn the bevel.
constexpr double kRemembers = 0.7;
// Looking what comes back: first short of the depth that the novice expects, then deeper and deeper until the right
// fluid comes or the needle is clearly beyond.
constexpr double kFirstLookShare = 0.85;
constexpr double kLastLookShare = 1.2;
constexpr double kLookEvery_mm = 2.0;  // as the lumbar task advises
constexpr double kSettle_s = 0.4;
constexpr double kLooking_s = 0.7;
constexpr double kBetweenLooks_mm_s = 5.0;
constexpr double kForgetsLook = 0.1;      // share of novices who never look and stop by depth
constexpr double kBevelError_deg = 20.0;  // of those who turn it, at most
constexpr double kNoviceWithdraw_mm_s = 50.0;
constexpr double kBeforeStart_s[] = {1.0, 5.0};  // of those who ask the patient to hold the breath, until they begin
constexpr double kPatient_s = 8.0;               // until the breath is held
constexpr double kOutside_mm = -3.0;
constexpr double kNoviceStuck_s = 5.0;
constexpr double kBone_s = 1.5;          // without a millimetre of progress: it is bone
constexpr int kCorrections = 2;          // after bone or without the fluid: out, another direction, in again
constexpr double kCorrectedShare = 0.7;  // of entry and direction that a correction leaves of the error
constexpr double kStop_s = 40.0;         // in any case: fire and withdraw
// Without any error.
constexpr double kSteadyTremor_mm = 0.05;   // as the expert
constexpr double kSteadySpeed_mm_s = 10.0;  // mean of the expert's speeds inside the body
constexpr double kSteadyWithdraw_mm_s = 30.0;

double draw(Random& random, const double (&range)[2]) noexcept {
  return random.uniform(range[0], range[1]);
}

/// Share of the errors of entry, angle and depth.
double clumsiness(const OperatorCase& the_case) noexcept {
  if (the_case.error_share) return *the_case.error_share;
  Random random(mix64(the_case.seed + 4));
  return draw(random, kClumsiness);
}

/// Share of all other errors.
double carelessness(const OperatorCase& the_case) noexcept {
  return the_case.error_share.value_or(1.0);
}

/// Share of novices who do not forget something.
double remembering(const OperatorCase& the_case) noexcept {
  return std::lerp(1.0, kRemembers, carelessness(the_case));
}

/// The novice's actual line: entry and angle with errors in random directions; `share` of them.
Segment miss(const OperatorCase& the_case, double share, Random& random) noexcept {
  const Segment& path_P = the_case.path_P;
  const double hidden = std::max(1.0, the_case.cover_mm / kFeltThrough_mm);
  const Mat3 R_PN = needle_pose(path_P.a, path_P.direction()).R();
  const auto sideways_P = [&] {
    const double angle_rad = random.uniform(0.0, 2.0 * std::numbers::pi);
    return Vec3(R_PN * Vec3(std::cos(angle_rad), std::sin(angle_rad), 0.0));
  };
  const Vec3 entry_P = path_P.a + share * hidden * draw(random, kEntryError_mm) * sideways_P();
  const double tilt_rad = radians(share * draw(random, kAngleError_deg));
  const Vec3 axis_P = std::cos(tilt_rad) * path_P.direction() + std::sin(tilt_rad) * sideways_P();
  return {entry_P, entry_P + path_P.length_mm() * axis_P};
}

/// Some forget the bevel: it faces anywhere.
std::optional<Vec3> aim_bevel(const OperatorCase& the_case) noexcept {
  if (!the_case.bevel_P) return std::nullopt;
  Random random(mix64(the_case.seed + 3));
  const bool forgets = random.uniform() > remembering(the_case);
  const double error_rad = forgets ? random.uniform(0.0, 2.0 * std::numbers::pi)
                                   : radians((2.0 * random.uniform() - 1.0) * kBevelError_deg) * carelessness(the_case);
  return Eigen::AngleAxisd(error_rad, the_case.path_P.direction()) * *the_case.bevel_P;
}

bool forgets_breath(const OperatorCase& the_case) noexcept {
  Random random(mix64(the_case.seed + 5));
  return random.uniform() > remembering(the_case);
}

double draw_wait_s(const OperatorCase& the_case) noexcept {
  Random random(mix64(the_case.seed + 6));
  return draw(random, kBeforeStart_s);
}

class Novice final : public Operator {
 public:
  explicit Novice(const OperatorCase& the_case) noexcept : Novice(the_case, Random(mix64(the_case.seed))) {}

  HandCommand next(const OperatorView& view) noexcept override {
    hand_.sense(view);
    wanted_.reset();
    hand_.move(step(view), view.dt_s);
    HandCommand command = hand_.command();
    if (!wanted_) wanted_ = breath_.take();
    if (wanted_) command.action = ActionRequest{*wanted_};
    if (!wanted_)
      command.action =
          actions_.next(hand_.tip_mm(), step_ == Step::kAfterFire ? std::optional(in_step_s()) : std::nullopt);
    command.is_done = step_ == Step::kDone;
    return command;
  }

 private:
  enum class Step {
    kAsk,
    kAdvance,
    kBackOut,
    kHesitate,
    kPullBack,
    kSettle,
    kLook,
    kAim,
    kAfterFire,
    kLoad,
    kWithdraw,
    kDone
  };
  struct Hesitation {
    double depth_mm;
    double pause_s;
    double pullback_mm;
  };

  Novice(const OperatorCase& the_case, Random random) noexcept
      : share_(carelessness(the_case)),
        start_mm_(draw(random, kNoviceStart_mm)),
        plan_P_(the_case.path_P),
        line_P_(miss(the_case, clumsiness(the_case), random)),
        bevel_P_(aim_bevel(the_case)),
        hand_(line_P_, bevel_P_, start_mm_,
              Tremor(std::hypot(std::lerp(kSteadyTremor_mm, kNoviceTremor_mm, share_), the_case.tremor_mm),
                     mix64(the_case.seed + 1))),
        cores_left_(the_case.fires_biopsy ? the_case.actions.cores : 0),
        loads_inside_(the_case.actions.loads_inside),
        actions_(the_case.actions),
        breath_(the_case.actions.holds_breath && !forgets_breath(the_case)),
        before_start_s_(std::lerp(kPatient_s, draw_wait_s(the_case), share_)) {
    Random forgets(mix64(the_case.seed + 2));
    if (forgets.uniform() > remembering(the_case)) actions_.forget_anaesthetic();
    if (the_case.actions.confirms && forgets.uniform() > kForgetsLook * share_) looks_ = the_case.actions;
    actions_.forget_confirmation();
    const double length_mm = the_case.path_P.length_mm();
    const double stop_share = clumsiness(the_case) * length_mm / kUsualPath_mm;
    stop_mm_ = length_mm + (random.uniform() < 0.5 ? -1.0 : 1.0) * stop_share * draw(random, kStopError_mm);
    next_look_mm_ = looks_ ? kFirstLookShare * stop_mm_ : std::numeric_limits<double>::infinity();
    speed_mm_s_ = std::lerp(kSteadySpeed_mm_s, draw(random, kSpeed_mm_s), share_);
    rhythm_rad_s_ = 2.0 * std::numbers::pi * draw(random, kRhythm_hz);
    before_fire_s_ = draw(random, kBeforeFire_s);
    double depth = 0.0;
    for (Hesitation& hesitation : hesitations_) {
      depth += random.uniform(0.15, 0.45);
      const double pause_s = share_ * draw(random, kHesitation_s);
      hesitation = {depth * length_mm, pause_s,
                    random.uniform() < kPullbackChance * share_ ? draw(random, kPullback_mm) : 0.0};
    }
  }

  /// Decides what to do; returns the wanted speed inward, mm/s.
  double step(const OperatorView& view) noexcept {
    switch (step_) {
      case Step::kAsk:
        if (breath_.waits(view, hand_.elapsed_s()) && in_step_s() <= before_start_s_) return 0.0;
        enter(Step::kAdvance);
        return advance();
      case Step::kAdvance:
        return advance();
      case Step::kBackOut:
        if (hand_.tip_mm() < start_mm_ + 2.0) correct();
        return -withdraw_mm_s();
      case Step::kHesitate:
        if (in_step_s() > hesitations_[next_hesitation_].pause_s) enter(Step::kPullBack);
        return 0.0;
      case Step::kPullBack:
        if (in_step_s() * kPullback_mm_s > hesitations_[next_hesitation_].pullback_mm) {
          ++next_hesitation_;
          enter(Step::kAdvance);
        }
        return -kPullback_mm_s;
      case Step::kSettle:
        if (in_step_s() > kSettle_s) {
          wanted_ = looks_->confirms;
          enter(Step::kLook);
        }
        return 0.0;
      case Step::kLook:
        look(view);
        return 0.0;
      case Step::kAim:
        if (in_step_s() > before_fire_s_) {
          if (cores_left_ > 0) wanted_ = ActionKind::kFire;
          enter(Step::kAfterFire);
        }
        return 0.0;
      case Step::kAfterFire:
        if (in_step_s() > kAfterFire_s) {
          if (cores_left_ > 0) --cores_left_;
          enter(cores_left_ > 0 && loads_inside_ ? Step::kLoad : Step::kWithdraw);
        }
        return 0.0;
      case Step::kLoad:
        if (in_step_s() > kNoviceLoading_s) {
          wanted_ = ActionKind::kLoad;
          enter(Step::kAim);
        }
        return 0.0;
      case Step::kWithdraw:
        if (hand_.tip_mm() < start_mm_ + 2.0 || hand_.elapsed_s() > kOutOfTime_s) enter(Step::kDone);
        if (hand_.tip_mm() < kOutside_mm) breath_.release();
        return hand_.wanted_mm() > start_mm_ ? -withdraw_mm_s() : 0.0;
      case Step::kDone:
        return 0.0;
    }
    return 0.0;
  }

  double advance() noexcept {
    const double last_mm = looks_ ? kLastLookShare * stop_mm_ : stop_mm_;
    if (next_hesitation_ < hesitations_.size() && hand_.tip_mm() > hesitations_[next_hesitation_].depth_mm) {
      enter(Step::kHesitate);
    } else if (is_stuck(kNoviceStuck_s) || hand_.elapsed_s() > kStop_s) {
      enter(Step::kAim);
    } else if (is_stuck(kBone_s) && corrections_left_ > 0) {
      enter(Step::kBackOut);
    } else if (hand_.tip_mm() > last_mm) {
      enter(looks_ && corrections_left_ > 0 ? Step::kBackOut : Step::kAim);
    } else if (hand_.tip_mm() > next_look_mm_) {
      enter(Step::kSettle);
    }
    if (has_looked_) return step_ == Step::kAdvance ? kBetweenLooks_mm_s : 0.0;
    return step_ == Step::kAdvance
               ? speed_mm_s_ * (1.0 + kUnevenness * share_ * std::sin(rhythm_rad_s_ * hand_.elapsed_s()))
               : 0.0;
  }

  /// What comes back? The right fluid: here it is. Another or none: deeper.
  void look(const OperatorView& view) noexcept {
    has_looked_ = true;
    if (in_step_s() < kLooking_s) return;
    if (view.returned && view.returned->substance == looks_->awaited) return enter(Step::kAim);
    if (looks_->confirms == ActionKind::kDrawStylet) wanted_ = ActionKind::kReplaceStylet;
    next_look_mm_ = hand_.tip_mm() + kLookEvery_mm;
    enter(Step::kAdvance);
  }

  void enter(Step step) noexcept {
    step_ = step;
    step_start_s_ = hand_.elapsed_s();
  }
  double withdraw_mm_s() const noexcept { return std::lerp(kSteadyWithdraw_mm_s, kNoviceWithdraw_mm_s, share_); }
  double in_step_s() const noexcept { return hand_.elapsed_s() - step_start_s_; }

  bool is_stuck(double longest_s) noexcept { return stall_.stalled_s(hand_, step_start_s_) > longest_s; }

  /// Outside of the body: nearer to the right entry and direction, and in again.
  void correct() noexcept {
    --corrections_left_;
    line_P_ = {plan_P_.a + kCorrectedShare * (line_P_.a - plan_P_.a),
               plan_P_.b + kCorrectedShare * (line_P_.b - plan_P_.b)};
    hand_.turn_to(line_P_, bevel_P_);
    stall_ = {};
    if (looks_) next_look_mm_ = kFirstLookShare * stop_mm_;
    has_looked_ = false;
    enter(Step::kAdvance);
  }

  double share_;  ///< Of the errors other than entry, angle and depth.
  double start_mm_;
  Segment plan_P_, line_P_;  ///< The right one, and the novice's.
  std::optional<Vec3> bevel_P_;
  GuidedHand hand_;
  std::size_t cores_left_;
  bool loads_inside_;
  PendingActions actions_;
  BreathCommand breath_;
  double before_start_s_;                 ///< After asking for it, a novice waits no longer for the breath to be held.
  std::optional<OperatorActions> looks_;  ///< Of those who look what comes back.
  std::optional<ActionKind> wanted_;      ///< With this tick.
  double stop_mm_ = 0.0;                  ///< Where the novice expects the target.
  double next_look_mm_ = 0.0;
  bool has_looked_ = false;  ///< During this insertion.
  double speed_mm_s_ = 0.0;
  double rhythm_rad_s_ = 0.0;
  double before_fire_s_ = 0.0;
  std::array<Hesitation, 3> hesitations_{};
  std::size_t next_hesitation_ = 0;
  int corrections_left_ = kCorrections;
  Step step_ = Step::kAsk;
  double step_start_s_ = 0.0;
  StallWatch stall_;
};

}  // namespace

std::unique_ptr<Operator> make_novice(const OperatorCase& the_case) {
  return std::make_unique<Novice>(the_case);
}

}  // namespace trocar::tasks
