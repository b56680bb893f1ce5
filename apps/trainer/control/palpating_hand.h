#pragma once

#include <QObject>
#include <QPointF>
#include <QVariantMap>
#include <memory>
#include <optional>
#include <vector>

#include "cases/open_case.h"
#include "haptics/contact/contact.h"
#include "views/tools_shown.h"

namespace trocar::trainer {

class PalpationTag;
class PatientView;

/// A finger that presses the skin under the pointer of a 3D view and tells how hard it is there, and marks of a skin
/// marker that plan the entry. While it is active, a click sets a mark; drags still rotate the view.
class PalpatingHand : public QObject {
  Q_OBJECT

 public:
  /// `says_below`: names bone under the finger; without it only the hardness. The view must outlive it.
  PalpatingHand(std::shared_ptr<const cases::OpenCase> open, PatientView& view, bool says_below);
  ~PalpatingHand() override;

  /// Empty: a patient in whom nothing can be felt, with the reason.
  const QString& failure() const noexcept { return failure_; }
  void set_active(bool is_active);
  /// Where the patient is: finger and marks move with the skin.
  void set_motion(const motion::PatientMotion& motion) { motion_ = motion; }
  bool is_active() const noexcept { return is_active_; }
  /// Moves the finger over the skin; mm in the directions of the view.
  void glide(double right_mm, double down_mm);
  void set_mark();
  void undo_mark();
  /// Call once per frame: feels the skin where the finger has moved to.
  void advance();
  void add_to(ToolsShown& tools) const;
  void add_facts(QVariantMap& facts) const;

  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  void move_to(const Vec3& p_P);
  void show_tag();

  std::shared_ptr<const cases::OpenCase> open_;
  PatientView& view_;
  bool says_below_;
  QString failure_;
  std::shared_ptr<const haptics::HapticScene> scene_;
  PalpationTag* tag_;
  bool is_active_ = false;
  std::optional<QPointF> pointer_, pressed_at_;  ///< In the view; pointer_: not felt yet.
  motion::PatientMotion motion_;
  std::optional<Vec3> p_A_;  ///< Place of the finger on the skin, at rest, as the marks.
  haptics::Palpation felt_;
  std::vector<Vec3> marks_A_;
};

}  // namespace trocar::trainer
