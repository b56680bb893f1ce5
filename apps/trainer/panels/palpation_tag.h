#pragma once

#include <QColor>
#include <QWidget>

#include "haptics/contact/contact.h"

namespace trocar::trainer {

/// What the finger feels, beside it in the 3D view: a bar of hardness and words. Transparent for the mouse.
class PalpationTag : public QWidget {
  Q_OBJECT

 public:
  explicit PalpationTag(QWidget* parent = nullptr);

  static QColor color_of(haptics::Hardness hardness);
  /// "Hard", and with `says_below`: "Hard: bone 6 mm below the skin".
  static QString words_of(const haptics::Palpation& felt, bool says_below);

  void show_felt(const haptics::Palpation& felt, bool says_below);
  const QString& words() const noexcept { return words_; }
  QSize sizeHint() const override;

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  haptics::Palpation felt_;
  QString words_, figure_;
};

}  // namespace trocar::trainer
