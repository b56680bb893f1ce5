#pragma once

#include <QImage>
#include <QOpenGLContext>
#include <QWindow>

namespace trocar::trainer {

/// A surface with a picture for each eye, for a screen and glasses that show them in turns (quad-buffer stereo). It
/// lies over a widget, which gets its mouse, wheel and key events. Without such a screen both eyes see the left
/// picture.
class StereoOutput : public QWindow {
  Q_OBJECT

 public:
  explicit StereoOutput(QWidget& beneath);
  ~StereoOutput() override;

  /// Whether the screen has buffers for two eyes. Asked of OpenGL once.
  static bool is_offered();

  /// Pictures of the same size, stretched over the surface.
  void show_eyes(const QImage& left, const QImage& right);

 protected:
  bool event(QEvent* event) override;
  void exposeEvent(QExposeEvent* event) override;

 private:
  void draw();
  void put(const QImage& picture, unsigned buffer);

  QWidget& beneath_;
  QOpenGLContext context_;
  bool has_failed_ = false;
  QImage left_;
  QImage right_;
};

}  // namespace trocar::trainer
