#pragma once

#include <QVTKOpenGLNativeWidget.h>

namespace trocar::trainer {

/// The surface that VTK draws on, shown mirrored where asked: for a monitor that is seen in a mirror.
class GlView : public QVTKOpenGLNativeWidget {
 public:
  using QVTKOpenGLNativeWidget::QVTKOpenGLNativeWidget;
  void set_mirrored(bool left_right, bool up_down);
  /// A place of the widget as the unmirrored picture has it.
  QPointF unmirrored(const QPointF& place) const;

 protected:
  void paintGL() override;

 private:
  bool is_left_right_ = false;
  bool is_up_down_ = false;
};

}  // namespace trocar::trainer
