#pragma once

#include <QImage>
#include <QOpenGLContext>
#include <QWindow>

namespace trocar::trainer {

/// A surface with one image per eye, for a screen and glasses that alternate them (quad-buffer stereo). It covers a
/// widget, which receives its mouse, wheel and key events. Without such a screen both eyes see the left image.
class StereoOutput : public QWindow {
  Q_OBJECT

 public:
  explicit StereoOutput(QWidget& beneath);
  ~StereoOutput() override;

  /// True if the screen has buffers for two eyes. Queried from OpenGL once.
  static bool is_offered();

  /// Images of the same size, scaled to the surface.
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
