#include <algorithm>
#include <cmath>

#include "tasks/detail/guided_hand.h"
#include "tasks/operator.h"

namespace trocar::tasks {
namespace {

// Motion of an expert; all assumed, except the tremor.
constexpr double kExpertTremor_mm = 0.05;  // rms while holding still: Riviere, Rader, Khosla 1997, eye surgeons, 49 um
constexpr double kExpertStart_mm = -20.0;
constexpr double kApproach_mm_s = 20.0;
constexpr double kTouching_mm_s = 5.0;
constexpr double kSkinPause_s = 0.5;
constexpr double kCruise_mm_s = 18.0;
constexpr double kPressing_mm_s = 9.0;   // against a resisting layer
constexpr double kUnfelt_n = 0.3;        // resistance without an effect
constexpr double kFirm_n = 1.2;          // resistance at which the speed is reduced to pressing
constexpr double kBraced = 5.0;          // stiffness of a hand that rests on the patient: little runs on after a drop
constexpr double kAfterDrop_mm_s = 0.0;  // stops after a puncture,
constexpr double kReaction_s = 0.15;     // this long after the drop,
constexpr double kCaution_s = 0.35;      // for so long
constexpr double kFineZone_mm = 10.0;    // before the target
constexpr double kFine_mm_s = 5.0;
constexpr double kHoming_per_s = 2.0;  // the last millimetres: speed per remaining distance
constexpr double kArrived_mm = 0.3;
constexpr double kCreepBack_mm_s = 6.0;  // yields if the recoiling tissue lets the tip creep past the target
constexpr double kSettled_mm = 0.5;
constexpr double kLooked_s = 0.2;         // time to see what comes back, or that nothing does
constexpr double kPressBeyond_mm = 10.0;  // a wall that has not given way: at most so far beyond the planned end
constexpr int kPresses = 2;
constexpr double kHold_s = 0.5;
constexpr double kMostHold_s = 3.0;
constexpr double kExpertLoading_s = 3.0;  // takes the core out and loads the gun
constexpr double kExpertWithdraw_mm_s = 30.0;
constexpr double kOut_mm = -3.0;        // in front of the entry: the patient may breathe
constexpr double kExpertStuck_s = 6.0;  // without a millimetre of progress: stop
constexpr double kGiveUp_s = 45.0;

class Expert final : public Operator {
 public:
  explicit Expert(const OperatorCase& the_case) noexcept
      : hand_(the_case.path_P, the_case.bevel_P, kExpertStart_mm,
              Tremor(std::hypot(kExpertTremor_mm, the_case.tremor_mm), the_case.seed), kBraced),
        target_mm_(the_case.path_P.length_mm()),
        cores_left_(the_case.fires_biopsy ? the_case.actions.cores : 0),
        loads_inside_(the_case.actions.loads_inside),
        actions_(the_case.actions),
        breath_(the_case.actions.holds_breath),
        confirms_(the_case.actions.confirms),
        awaited_(the_case.actions.awaited) {}

  HandCommand next(const OperatorView& view) noexcept override {
    hand_.sense(view);
    std::optional<ActionKind> action;
    double speed_mm_s = 0.0;
    switch (step_) {
      case Step::kAsk:
        if (breath_.waits(view, hand_.elapsed_s())) break;
        enter(Step::kApproach);
        [[fallthrough]];
      case Step::kApproach:
        speed_mm_s = hand_.wanted_mm() < -kTouching_mm_s ? kApproach_mm_s : kTouching_mm_s;
        if (hand_.is_touching() || target_left_mm() < kFineZone_mm) enter(Step::kPause);
        break;
      case Step::kPause:
        if (in_step_s() > kSkinPause_s) enter(Step::kInsert);
        break;
      case Step::kInsert:
        speed_mm_s = breath_.waits(view, hand_.elapsed_s()) ? 0.0 : insertion_speed_mm_s();
        if (target_left_mm() < kArrived_mm) enter(Step::kHold);
        if (is_stuck()) enter(Step::kWithdraw);
        break;
      case Step::kHold:
        speed_mm_s = holding_speed_mm_s();
        if ((in_step_s() > kHold_s && target_left_mm() > -kSettled_mm) || in_step_s() > kMostHold_s) {
          if (cores_left_ > 0) action = ActionKind::kFire;
          enter(Step::kAfterFire);
        }
        break;
      case Step::kAfterFire:
        speed_mm_s = holding_speed_mm_s();
        if (is_wrong_place(view) && presses_left_ > 0) {
          --presses_left_;
          actions_.look_again(*confirms_);
          if (confirms_ == ActionKind::kDrawStylet) action = ActionKind::kReplaceStylet;
          enter(Step::kPress);
        } else if (in_step_s() > kAfterFire_s) {
          if (cores_left_ > 0) --cores_left_;
          enter(cores_left_ > 0 && loads_inside_ ? Step::kLoad : Step::kWithdraw);
        }
        break;
      case Step::kPress:
        speed_mm_s = kFine_mm_s;
        if (hand_.has_felt_drop() || target_left_mm() < -kPressBeyond_mm || is_stuck()) enter(Step::kHold);
        break;
      case Step::kLoad:
        speed_mm_s = loads_inside_ ? holding_speed_mm_s() : 0.0;
        if (in_step_s() > kExpertLoading_s) {
          action = ActionKind::kLoad;
          stall_ = {};  // another insertion
          enter(loads_inside_ ? Step::kHold : Step::kAsk);
        }
        break;
      case Step::kWithdraw:
        speed_mm_s = hand_.wanted_mm() > kExpertStart_mm ? -kExpertWithdraw_mm_s : 0.0;
        if (hand_.tip_mm() < kOut_mm) breath_.release();
        if (hand_.tip_mm() < kExpertStart_mm + 2.0) enter(cores_left_ > 0 && !is_late() ? Step::kLoad : Step::kDone);
        if (hand_.elapsed_s() > kOutOfTime_s) enter(Step::kDone);
        break;
      case Step::kDone:
        break;
    }
    if (is_late() && step_ < Step::kWithdraw) enter(Step::kWithdraw);
    hand_.move(speed_mm_s, view.dt_s);
    HandCommand command = hand_.command();
    if (!action) action = breath_.take();
    if (action) command.action = ActionRequest{*action};
    if (!action)
      command.action =
          actions_.next(hand_.tip_mm(), step_ == Step::kAfterFire ? std::optional(in_step_s()) : std::nullopt);
    command.is_done = step_ == Step::kDone;
    return command;
  }

 private:
  enum class Step { kAsk, kApproach, kPause, kInsert, kHold, kAfterFire, kPress, kLoad, kWithdraw, kDone };

  void enter(Step step) noexcept {
    step_ = step;
    step_start_s_ = hand_.elapsed_s();
  }
  double in_step_s() const noexcept { return hand_.elapsed_s() - step_start_s_; }
  double target_left_mm() const noexcept { return target_mm_ - hand_.tip_mm(); }

  /// Slower with more resistance, for some time after a puncture, and towards the target.
  double insertion_speed_mm_s() noexcept {
    if (hand_.has_felt_drop()) drop_s_ = hand_.elapsed_s();
    const double since_drop_s = hand_.elapsed_s() - drop_s_;
    const double firmness = std::clamp((hand_.push_n() - kUnfelt_n) / (kFirm_n - kUnfelt_n), 0.0, 1.0);
    double speed_mm_s = std::lerp(kCruise_mm_s, kPressing_mm_s, firmness);
    if (since_drop_s > kReaction_s && since_drop_s < kReaction_s + kCaution_s) speed_mm_s = kAfterDrop_mm_s;
    const double braking_mm_s = kFine_mm_s + std::max(0.0, target_left_mm() - kFineZone_mm);
    return std::min({speed_mm_s, braking_mm_s, kHoming_per_s * std::max(0.0, target_left_mm())});
  }

  /// The operator has looked, and what came back does not confirm the target: a wall was pushed along and has not
  /// given way.
  bool is_wrong_place(const OperatorView& view) const noexcept {
    return confirms_ && in_step_s() > kLooked_s && view.returned && view.returned->substance != awaited_;
  }

  double holding_speed_mm_s() const noexcept {
    return target_left_mm() < -kArrived_mm ? std::max(-kCreepBack_mm_s, kHoming_per_s * target_left_mm()) : 0.0;
  }

  bool is_late() const noexcept { return hand_.elapsed_s() > kGiveUp_s; }
  bool is_stuck() noexcept { return stall_.stalled_s(hand_, step_start_s_) > kExpertStuck_s; }

  GuidedHand hand_;
  double target_mm_;
  std::size_t cores_left_;
  bool loads_inside_;
  PendingActions actions_;
  BreathCommand breath_;
  std::optional<ActionKind> confirms_;
  Substance awaited_;
  int presses_left_ = kPresses;
  Step step_ = Step::kAsk;
  double step_start_s_ = 0.0;
  double drop_s_ = -10.0;
  StallWatch stall_;
};

}  // namespace

std::unique_ptr<Operator> make_expert(const OperatorCase& the_case) {
  return std::make_unique<Expert>(the_case);
}

}  // namespace trocar::tasks
