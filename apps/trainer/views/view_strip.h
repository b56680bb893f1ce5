#pragma once

#include <QString>
#include <QWidget>
#include <functional>

namespace trocar::trainer {

/// The line above a view with its name and numbers. It is at the top of the view, or in the title of its dock.
class ViewStrip : public QWidget {
 public:
  /// Paints into the room that buttons leave.
  using Paint = std::function<void(QPainter& painter, const QRectF& room)>;
  ViewStrip(QWidget& view, Paint paint);

  /// At the right end.
  void add_button(QWidget& button);
  /// What the view has to leave free at its top: nothing once the strip is elsewhere.
  double height_in_view() const;
  /// The view has another size.
  void follow_view();
  /// Paints again if `shown`, all that it depends on, is not what it was.
  void refresh(const QString& shown);

  QSize sizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  QWidget& view_;
  Paint paint_;
  QWidget* button_ = nullptr;
  QString shown_;
};

}  // namespace trocar::trainer
