#include "views/gl_view.h"

#include <QOpenGLContext>
#include <QOpenGLExtraFunctions>
#include <QOpenGLFramebufferObject>

namespace trocar::trainer {

void GlView::set_mirrored(bool left_right, bool up_down) {
  if (left_right == is_left_right_ && up_down == is_up_down_) return;
  is_left_right_ = left_right;
  is_up_down_ = up_down;
  update();
}

QPointF GlView::unmirrored(const QPointF& place) const {
  return {is_left_right_ ? width() - place.x() : place.x(), is_up_down_ ? height() - place.y() : place.y()};
}

void GlView::paintGL() {
  QVTKOpenGLNativeWidget::paintGL();
  if (!is_left_right_ && !is_up_down_) return;
  const int wide = qRound(width() * devicePixelRatioF());
  const int high = qRound(height() * devicePixelRatioF());
  // A frame buffer cannot be copied onto itself turned: by way of another.
  QOpenGLFramebufferObject copy(wide, high);
  QOpenGLExtraFunctions* gl = QOpenGLContext::currentContext()->extraFunctions();
  gl->glDisable(GL_SCISSOR_TEST);
  gl->glBindFramebuffer(GL_READ_FRAMEBUFFER, defaultFramebufferObject());
  gl->glBindFramebuffer(GL_DRAW_FRAMEBUFFER, copy.handle());
  gl->glBlitFramebuffer(0, 0, wide, high, 0, 0, wide, high, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  gl->glBindFramebuffer(GL_READ_FRAMEBUFFER, copy.handle());
  gl->glBindFramebuffer(GL_DRAW_FRAMEBUFFER, defaultFramebufferObject());
  const int x0 = is_left_right_ ? wide : 0;
  const int y0 = is_up_down_ ? high : 0;
  gl->glBlitFramebuffer(0, 0, wide, high, x0, y0, wide - x0, high - y0, GL_COLOR_BUFFER_BIT, GL_NEAREST);
  gl->glBindFramebuffer(GL_FRAMEBUFFER, defaultFramebufferObject());
}

}  // namespace trocar::trainer
