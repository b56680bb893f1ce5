#pragma once

#include <QWidget>
#include <span>
#include <vector>

#include "attempt/guide/needle_view.h"

class QPainter;

namespace trocar::trainer {

/// The cores of biopsy shots, to scale, one bar each: target tissue, organ, vessel and other tissue by colour, with
/// their lengths in all cores.
class CorePicture : public QWidget {
  Q_OBJECT

 public:
  explicit CorePicture(QWidget* parent = nullptr);
  void set_shots(std::span<const attempt::GunShot> shots);

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
  void paint_bar(QPainter& painter, const std::vector<attempt::ShotPiece>& pieces, int top) const;

  std::vector<std::vector<attempt::ShotPiece>> cores_;
  std::vector<Entry> legend_;  ///< Entries of the parts in the core.
};

}  // namespace trocar::trainer
