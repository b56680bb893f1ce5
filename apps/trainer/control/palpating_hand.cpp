#include "control/palpating_hand.h"

#include <QMouseEvent>
#include <algorithm>
#include <cmath>

#include "anatomy/skin_now.h"
#include "cases/scene_request.h"
#include "panels/palpation_tag.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"
#include "views/patient/patient_view.h"
#include "volume/sampling.h"

namespace trocar::trainer {
namespace {

constexpr double kClick_px = 4.0;  ///< A longer way between press and release is a drag.
constexpr int kBesideFinger_px = 18;

/// First point of the skin along a ray from outside, by steps of the distance to it.
std::optional<Vec3> find_skin(const anatomy::VirtualPatient& patient, const motion::PatientMotion& motion,
                              const Vec3& from_P, const Vec3& along_P) {
  constexpr double kFarthest_mm = 3000.0, kLeast_mm = 0.3, kMost_mm = 6.0;
  const volume::GridGeometry& grid = patient.skin_distance_mm.geometry;
  for (double gone_mm = 0.0; gone_mm < kFarthest_mm;) {
    const Vec3 p_P = from_P + gone_mm * along_P;
    const Vec3 index = grid.to_index(p_P);
    const bool is_inside = (index.array() >= 0.0).all() && index.x() <= static_cast<double>(grid.size[0] - 1) &&
                           index.y() <= static_cast<double>(grid.size[1] - 1) &&
                           index.z() <= static_cast<double>(grid.size[2] - 1);
    if (!is_inside) {
      gone_mm += kMost_mm;
      continue;
    }
    const double distance_mm = volume::sample_linear(patient.skin_distance_mm, motion.to_rest(p_P));
    if (distance_mm < kLeast_mm) return distance_mm > -kMost_mm ? std::optional(p_P) : std::nullopt;
    gone_mm += std::clamp(distance_mm, kLeast_mm, kMost_mm);
  }
  return std::nullopt;
}

QPointF pointer_place_of(const QMouseEvent& event) {
  return event.localPos();
}

}  // namespace

PalpatingHand::PalpatingHand(std::shared_ptr<const cases::OpenCase> open, PatientView& view, bool says_below)
    : open_(std::move(open)), view_(view), says_below_(says_below), tag_(new PalpationTag(&view)) {
  haptics::HapticOptions options;
  options.tool = haptics::Tool::kFinger;
  const cases::Case& the_case = open_->the_case;
  auto scene = haptics::make_haptic_scene(the_case.patient, the_case.tissues, cases::needle_geometry(the_case.needle),
                                          {}, options);
  if (scene) scene_ = *std::move(scene);
  if (!scene) failure_ = shown(scene.error().text());
  view_.installEventFilter(this);
}

PalpatingHand::~PalpatingHand() {
  set_active(false);
  view_.removeEventFilter(this);
  delete tag_;
}

void PalpatingHand::set_active(bool is_active) {
  is_active_ = is_active && scene_ != nullptr;
  view_.setMouseTracking(is_active_);
  pressed_at_.reset();
  tag_->setVisible(is_active_ && p_A_.has_value());
}

bool PalpatingHand::eventFilter(QObject* /*watched*/, QEvent* event) {
  if (!is_active_) return false;
  const auto& mouse = static_cast<const QMouseEvent&>(*event);
  switch (event->type()) {
    case QEvent::ToolTip:
      return true;  // it would cover the tag beside the finger
    case QEvent::MouseMove:
      pointer_ = pointer_place_of(mouse);
      break;
    case QEvent::MouseButtonPress:
      if (mouse.button() == Qt::LeftButton) pressed_at_ = pointer_place_of(mouse);
      break;
    case QEvent::MouseButtonRelease:
      if (pressed_at_ && QLineF(*pressed_at_, pointer_place_of(mouse)).length() < kClick_px) {
        pointer_ = pointer_place_of(mouse);
        advance();
        set_mark();
      }
      pressed_at_.reset();
      break;
    default:
      break;
  }
  return false;  // the view rotates with a drag
}

void PalpatingHand::advance() {
  if (!is_active_ || !pointer_) return;
  const auto [eye_P, along_P] = view_.ray_at(*pointer_);
  pointer_.reset();
  if (const auto p_P = find_skin(*open_->the_case.patient, motion_, eye_P, along_P)) move_to(*p_P);
}

void PalpatingHand::move_to(const Vec3& p_P) {
  const anatomy::SkinNow skin(*open_->the_case.patient, motion_);
  const Vec3 skin_P = skin.nearest(p_P);
  p_A_ = motion_.to_rest(skin_P);
  felt_ = haptics::palpate({*scene_, motion_}, skin_P, skin.inward(skin_P));
  show_tag();
}

void PalpatingHand::show_tag() {
  tag_->show_felt(felt_, says_below_);
  const QPointF at = view_.position_of(motion_.to_now(*p_A_));
  const int left = static_cast<int>(at.x()) + kBesideFinger_px, top = static_cast<int>(at.y()) + kBesideFinger_px;
  tag_->move(std::clamp(left, 0, std::max(0, view_.width() - tag_->width())),
             std::clamp(top, 0, std::max(0, view_.height() - tag_->height())));
}

void PalpatingHand::glide(double right_mm, double down_mm) {
  if (!is_active_ || !p_A_) return;
  const scene::CameraView& camera = view_.view();
  const Vec3 shift_P = right_mm * camera.right_P() - down_mm * camera.up_P;
  const Vec3 p_P = motion_.to_now(*p_A_), inward_P = anatomy::SkinNow(*open_->the_case.patient, motion_).inward(p_P);
  move_to(p_P + shift_P - inward_P.dot(shift_P) * inward_P);
}

void PalpatingHand::set_mark() {
  if (is_active_ && p_A_) marks_A_.push_back(*p_A_);
}

void PalpatingHand::undo_mark() {
  if (!marks_A_.empty()) marks_A_.pop_back();
}

void PalpatingHand::add_to(ToolsShown& tools) const {
  tools.skin_marks_P.clear();
  for (const Vec3& mark_A : marks_A_) tools.skin_marks_P.push_back(motion_.to_now(mark_A));
  if (!is_active_ || !p_A_) return;
  const QColor color = PalpationTag::color_of(haptics::hardness_of(felt_));
  const Vec3 p_P = motion_.to_now(*p_A_);
  tools.finger = scene::Fingertip{p_P,
                                  anatomy::SkinNow(*open_->the_case.patient, motion_).inward(p_P),
                                  {static_cast<std::uint8_t>(color.red()), static_cast<std::uint8_t>(color.green()),
                                   static_cast<std::uint8_t>(color.blue())}};
}

void PalpatingHand::add_facts(QVariantMap& facts) const {
  facts[QStringLiteral("palpation")] = is_active_ && p_A_ ? PalpationTag::words_of(felt_, says_below_) : QString();
  facts[QStringLiteral("palpation_mm")] = felt_.pressed_mm;
  facts[QStringLiteral("palpation_n_per_mm")] = felt_.stiffness_n_per_mm;
  facts[QStringLiteral("skin_marks")] = static_cast<int>(marks_A_.size());
}

}  // namespace trocar::trainer
