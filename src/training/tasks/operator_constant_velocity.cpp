#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "tasks/operator.h"

namespace trocar::tasks {
namespace {

constexpr double kStart_mm = -10.0;

class ConstantVelocity final : public Operator {
 public:
  ConstantVelocity(const OperatorCase& the_case, double speed_mm_per_s) noexcept
      : path_P_(the_case.path_P),
        R_PN_(needle_pose(path_P_.a, path_P_.direction()).R()),
        speed_mm_s_(speed_mm_per_s),
        one_way_s_((path_P_.length_mm() - kStart_mm) / speed_mm_per_s),
        fires_biopsy_(the_case.fires_biopsy) {}

  HandCommand next(const OperatorView& view) noexcept override {
    if (start_s_ > view.time_s) start_s_ = view.time_s;
    const double time_s = view.time_s - start_s_;
    const bool is_going_out = time_s >= one_way_s_;
    const double travelled_mm = speed_mm_s_ * std::max(0.0, std::min(time_s, 2.0 * one_way_s_ - time_s));

    HandCommand command;
    command.is_rigid = true;
    command.is_done = time_s >= 2.0 * one_way_s_;
    if (fires_biopsy_ && is_going_out && !has_turned_) command.action = ActionRequest{ActionKind::kFire};
    has_turned_ = is_going_out;
    const Vec3 axis_P = path_P_.direction();
    command.X_PN = Pose(R_PN_, path_P_.a + (kStart_mm + travelled_mm) * axis_P);
    if (!command.is_done) command.v_P = (is_going_out ? -speed_mm_s_ : speed_mm_s_) * axis_P;
    return command;
  }

 private:
  Segment path_P_;
  Mat3 R_PN_;
  double speed_mm_s_;
  double one_way_s_;
  bool fires_biopsy_;
  bool has_turned_ = false;
  double start_s_ = HUGE_VAL;
};

}  // namespace

std::unique_ptr<Operator> make_constant_velocity(const OperatorCase& the_case, double speed_mm_per_s) {
  TROCAR_CHECK(speed_mm_per_s >= 0.1 && speed_mm_per_s <= 500.0);
  return std::make_unique<ConstantVelocity>(the_case, speed_mm_per_s);
}

}  // namespace trocar::tasks
