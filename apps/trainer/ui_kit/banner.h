#pragma once

#include <QLabel>
#include <QTimer>

namespace trocar::trainer {

enum class BannerKind { kError, kWarning, kSuccess };

/// A message over the pages. It takes no place in their layout and no mouse events, and lies where it covers no control
/// and as little text as possible. A state is shown until it is replaced; a message told goes by itself.
class Banner : public QLabel {
  Q_OBJECT

 public:
  /// Lies over `area`.
  explicit Banner(QWidget& area);

  /// Empty: none.
  void set_state(const QString& text, BannerKind kind);
  /// For kTold_ms, instead of the state; a new state ends it.
  void tell(const QString& text, BannerKind kind);
  /// Looks for its place again: after the page has changed.
  void place();

  static constexpr int kTold_ms = 5000;

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

 private:
  struct Message {
    QString text;
    BannerKind kind = BannerKind::kWarning;
  };
  void show_message(const Message& message);
  QRect free_place(const QSize& size) const;

  QWidget& area_;
  Message state_;
  QTimer told_, placing_;
};

}  // namespace trocar::trainer
