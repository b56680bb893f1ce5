#pragma once

#include <QWidget>

#include "geometry/vec.h"

namespace trocar::trainer {

/// Position of a device's grip and direction of its stylus, from above and from the front, as seen by its user.
class PosePicture : public QWidget {
  Q_OBJECT

 public:
  explicit PosePicture(QWidget* parent = nullptr);
  /// In D: x to the right, y away, z up; mm.
  void show_pose(const Vec3& p_D, const Vec3& axis_D, bool is_known);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  Vec3 p_D_ = Vec3::Zero(), axis_D_ = Vec3::UnitZ();
  bool is_known_ = false;
};

}  // namespace trocar::trainer
