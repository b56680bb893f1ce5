#include "views/patient/stereo_output.h"

#include <QCoreApplication>
#include <QOpenGLExtraFunctions>
#include <QWidget>

namespace trocar::trainer {
namespace {

// OpenGL names that OpenGL ES, whose header Qt may include, does not define.
constexpr unsigned kBackLeft = 0x0402;
constexpr unsigned kBackRight = 0x0403;
constexpr unsigned kBack = 0x0405;

QSurfaceFormat two_eyes() {
  QSurfaceFormat format;
  format.setRenderableType(QSurfaceFormat::OpenGL);
  format.setVersion(3, 2);
  format.setProfile(QSurfaceFormat::CoreProfile);
  format.setStereo(true);
  return format;
}

}  // namespace

StereoOutput::StereoOutput(QWidget& beneath) : beneath_(beneath) {
  setSurfaceType(QSurface::OpenGLSurface);
  setFormat(two_eyes());
}

StereoOutput::~StereoOutput() = default;

bool StereoOutput::is_offered() {
  static const bool the_answer = [] {
    QOpenGLContext context;
    context.setFormat(two_eyes());
    return context.create() && context.format().stereo();
  }();
  return the_answer;
}

void StereoOutput::show_eyes(const QImage& left, const QImage& right) {
  left_ = left.convertToFormat(QImage::Format_RGBA8888);
  right_ = right.convertToFormat(QImage::Format_RGBA8888);
  draw();
}

bool StereoOutput::event(QEvent* event) {
  switch (event->type()) {
    case QEvent::MouseButtonPress:
    case QEvent::MouseButtonRelease:
    case QEvent::MouseButtonDblClick:
    case QEvent::MouseMove:
    case QEvent::Wheel:
    case QEvent::KeyPress:
    case QEvent::KeyRelease:
      return QCoreApplication::sendEvent(&beneath_, event);
    default:
      return QWindow::event(event);
  }
}

void StereoOutput::exposeEvent(QExposeEvent* /*event*/) {
  draw();
}

void StereoOutput::draw() {
  if (!isExposed() || left_.isNull() || has_failed_) return;
  if (!context_.isValid()) {
    context_.setFormat(requestedFormat());
    has_failed_ = !context_.create();
    if (has_failed_) return;
  }
  if (!context_.makeCurrent(this)) return;
  if (context_.format().stereo()) {
    put(left_, kBackLeft);
    put(right_, kBackRight);
  } else {
    put(left_, kBack);
  }
  context_.swapBuffers(this);
  context_.doneCurrent();
}

void StereoOutput::put(const QImage& picture, unsigned buffer) {
  QOpenGLExtraFunctions& gl = *context_.extraFunctions();
  GLuint texture = 0;
  gl.glGenTextures(1, &texture);
  gl.glBindTexture(GL_TEXTURE_2D, texture);
  gl.glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, picture.width(), picture.height(), 0, GL_RGBA, GL_UNSIGNED_BYTE,
                  picture.constBits());
  GLuint source = 0;
  gl.glGenFramebuffers(1, &source);
  gl.glBindFramebuffer(GL_READ_FRAMEBUFFER, source);
  gl.glFramebufferTexture2D(GL_READ_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
  gl.glBindFramebuffer(GL_DRAW_FRAMEBUFFER, context_.defaultFramebufferObject());
  const GLenum target = buffer;
  gl.glDrawBuffers(1, &target);
  const int wide = qRound(width() * devicePixelRatio());
  const int high = qRound(height() * devicePixelRatio());
  // Images start at the top, OpenGL windows at the bottom.
  gl.glBlitFramebuffer(0, 0, picture.width(), picture.height(), 0, high, wide, 0, GL_COLOR_BUFFER_BIT, GL_LINEAR);
  gl.glDeleteFramebuffers(1, &source);
  gl.glDeleteTextures(1, &texture);
}

}  // namespace trocar::trainer
