#pragma once

#include <QLabel>
#include <QTimer>

namespace trocar::trainer {

enum class BannerKind { kError, kWarning, kSuccess };

/// A message on top of the pages. It takes no space in their layout and no mouse events, and avoids controls and text.
/// A state stays until it is replaced; other messages disappear after kMessage_ms.
class Banner : public QLabel {
  Q_OBJECT

 public:
  /// Lies over `area`.
  explicit Banner(QWidget& area);

  /// Empty: none.
  void set_state(const QString& text, BannerKind kind);
  /// For kMessage_ms, instead of the state; a new state ends it.
  void show_message(const QString& text, BannerKind kind);
  /// Looks for its place again: after the page has changed.
  void place();

  static constexpr int kMessage_ms = 5000;

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  struct Message {
    QString text;
    BannerKind kind = BannerKind::kWarning;
  };
  void display(const Message& message);
  QRect free_place(const QSize& size) const;

  QWidget& area_;
  Message state_;
  QTimer message_timer_, placing_;
};

}  // namespace trocar::trainer
