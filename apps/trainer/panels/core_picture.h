#pragma once

#include <QWidget>
#include <vector>

#include "attempt/guide/gun_shot.h"

namespace trocar::trainer {

/// The core of a biopsy shot, to scale: target tissue, organ, vessel and other tissue by colour, with their lengths.
class CorePicture : public QWidget {
  Q_OBJECT

 public:
  explicit CorePicture(QWidget* parent = nullptr);
  void set_shot(const attempt::GunShot& shot);

  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return sizeHint(); }

  static QColor color_of(scoring::CorePart part);

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  struct Entry {
    scoring::CorePart part;
    QString text;
  };
  int bar_height() const;

  std::vector<attempt::ShotPiece> pieces_;
  std::vector<Entry> legend_;  ///< Entries of the parts in the core.
};

}  // namespace trocar::trainer
