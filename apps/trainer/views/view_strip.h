#pragma once

#include <QString>
#include <QWidget>
#include <functional>

namespace trocar::trainer {

/// The line above a view with its name and numbers. It is at the top of the view, or in the title of its dock.
class ViewStrip : public QWidget {
 public:
  /// Paints in the space beside the buttons.
  using Paint = std::function<void(QPainter& painter, const QRectF& room)>;
  ViewStrip(QWidget& view, Paint paint);

  /// Adds a button at the right end.
  void add_button(QWidget& button);
  /// Height that the view must leave free at its top: 0 if the strip is elsewhere.
  double height_in_view() const;
  /// Call after the view was resized.
  void follow_view();
  /// Paints again if `shown`, the text of all its inputs, has changed.
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
