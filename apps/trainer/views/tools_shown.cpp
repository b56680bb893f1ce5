#include "views/tools_shown.h"

#include <algorithm>
#include <utility>

#include "attempt/guide/needle_view.h"

namespace trocar::trainer {
namespace {

/// Invisible motion: a tool at rest moves with the noise of the servo, and each change costs a frame.
constexpr double kUnseen_mm = 0.03, kUnseen_rad = 5e-4;

bool are_near(const Pose& a, const Pose& b) {
  return (a.p() - b.p()).norm() < kUnseen_mm && (a.R() - b.R()).norm() < kUnseen_rad;
}

bool are_near(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(),
                                            [](const Vec3& p, const Vec3& q) { return (p - q).norm() < kUnseen_mm; });
}

bool are_same(const std::optional<Segment>& s, const std::optional<Segment>& t) {
  if (!s || !t) return !s && !t;
  return (s->a - t->a).norm() < kUnseen_mm && (s->b - t->b).norm() < kUnseen_mm;
}

bool are_same(const std::optional<scene::Fingertip>& a, const std::optional<scene::Fingertip>& b) {
  if (!a || !b) return !a && !b;
  return (a->p_P - b->p_P).norm() < kUnseen_mm && a->color == b->color;
}

}  // namespace

bool look_same(const ToolsShown& a, const ToolsShown& b) {
  return a.motion.is_same_place(b.motion) && are_same(a.finger, b.finger) && are_near(a.skin_marks_P, b.skin_marks_P) &&
         are_near(a.shaft_P, b.shaft_P) && are_near(a.X_PN, b.X_PN) && a.X_PT.has_value() == b.X_PT.has_value() &&
         (!a.X_PT || are_near(*a.X_PT, *b.X_PT)) && are_same(a.goal_P, b.goal_P) && are_same(a.stylet_P, b.stylet_P) &&
         are_same(a.core_P, b.core_P) && are_same(a.throw_P, b.throw_P) && are_same(a.notch_P, b.notch_P) &&
         are_same(a.wire_P, b.wire_P) && a.focus_P.has_value() == b.focus_P.has_value() &&
         (!a.focus_P || (*a.focus_P - *b.focus_P).norm() < kUnseen_mm);
}

ToolsShown seen_from_outside(ToolsShown tools) {
  tools.shaft_P = attempt::shaft_outside(std::move(tools.shaft_P), tools.inside_mm);
  if (!tools.shaft_P.empty()) tools.X_PN = Pose(tools.X_PN.R(), tools.shaft_P.back());
  if (tools.inside_mm > 0.0) tools.goal_P.reset();
  tools.stylet_P.reset();
  tools.core_P.reset();
  tools.throw_P.reset();
  tools.notch_P.reset();
  tools.wire_P.reset();
  tools.focus_P.reset();
  return tools;
}

}  // namespace trocar::trainer
