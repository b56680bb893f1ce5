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
  /// Creates a banner on top of `area`.
  explicit Banner(QWidget& area);

  /// An empty text removes the state.
  void set_state(const QString& text, BannerKind kind);
  /// Shows the message instead of the state for kMessage_ms; a new state ends it.
  void show_message(const QString& text, BannerKind kind);
  /// Recomputes its position; call it after a change of page.
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
