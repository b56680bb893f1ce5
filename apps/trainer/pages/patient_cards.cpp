#include "pages/patient_cards.h"

#include <QEvent>
#include <QFile>
#include <QImageReader>
#include <QPainter>
#include <QPainterPath>
#include <QScrollBar>
#include <QStyledItemDelegate>
#include <algorithm>
#include <cmath>

#include "ui_kit/theme.h"

namespace trocar::trainer {
namespace {

constexpr int kTask = Qt::UserRole, kDescription = Qt::UserRole + 1, kDifficulty = Qt::UserRole + 2;

constexpr int kLeastWidth = 178, kGreatestWidth = 300;  ///< Of a card, px.
constexpr int kPatientCardGap = 10;                     ///< Between cards.
constexpr int kPad = 8;
constexpr double kShape = 0.625;  ///< Height over width of a picture.
constexpr int kDots = 5;
constexpr int kCorner = 6;

constexpr qint64 kMostBytes = 1 << 20;  ///< Of a thumbnail: folders may come from elsewhere.
constexpr int kMostPixels = 2048;       ///< Along a side.

/// Empty if there is no picture, or none of a reasonable size.
QPixmap load_picture(const QString& file) {
  if (file.isEmpty() || QFile(file).size() > kMostBytes) return {};
  QImageReader reader(file);
  const QSize size = reader.size();
  if (!size.isValid() || std::max(size.width(), size.height()) > kMostPixels) return {};
  return QPixmap::fromImage(reader.read());
}

/// Head and shoulders: a patient without a picture.
void paint_neutral_picture(QPainter& painter, const QRectF& rect) {
  painter.fillRect(rect, theme().view);
  painter.setPen(Qt::NoPen);
  painter.setBrush(theme().raised);
  const double unit = rect.height() / 10.0;
  const QPointF middle(rect.center().x(), rect.top());
  painter.drawEllipse(middle + QPointF(0.0, 3.6 * unit), 1.7 * unit, 2.0 * unit);
  QPainterPath shoulders;
  shoulders.moveTo(middle + QPointF(-4.4 * unit, 10.0 * unit));
  shoulders.cubicTo(middle + QPointF(-4.2 * unit, 5.6 * unit), middle + QPointF(4.2 * unit, 5.6 * unit),
                    middle + QPointF(4.4 * unit, 10.0 * unit));
  painter.drawPath(shoulders);
}

void paint_picture(QPainter& painter, const QRectF& rect, const QPixmap& picture) {
  if (picture.isNull()) return paint_neutral_picture(painter, rect);
  // The middle of a picture of another shape.
  const double height_px = std::min<double>(picture.height(), picture.width() * kShape);
  const QSizeF part(height_px / kShape, height_px);
  const QRectF source(QPointF(0.5 * (picture.width() - part.width()), 0.5 * (picture.height() - part.height())), part);
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  painter.drawPixmap(rect, picture, source);
}

/// Returns the right end of the dots.
double paint_dots(QPainter& painter, const QPointF& left_middle, double diameter, int difficulty) {
  const double step = 1.5 * diameter;
  for (int dot = 0; dot < kDots; ++dot) {
    const QPointF centre = left_middle + QPointF(0.5 * diameter + dot * step, 0.0);
    painter.setPen(QPen(dot < difficulty ? theme().accent : theme().dim, 1.2));
    painter.setBrush(dot < difficulty ? QBrush(theme().accent) : Qt::NoBrush);
    painter.drawEllipse(centre, 0.5 * diameter - 0.6, 0.5 * diameter - 0.6);
  }
  return left_middle.x() + kDots * step;
}

class CardDelegate final : public QStyledItemDelegate {
 public:
  using QStyledItemDelegate::QStyledItemDelegate;

  static int height_of(int width) {
    const QFontMetrics name(scaled_font(1.0, true)), text(scaled_font(0.9));
    return kPad + qRound(kShape * (width - 2 * kPad)) + kPad + name.height() + 2 * text.lineSpacing() + kPad;
  }

  QSize sizeHint(const QStyleOptionViewItem&, const QModelIndex& index) const override {
    return index.data(Qt::SizeHintRole).toSize();
  }

  void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    painter->save();
    painter->setRenderHint(QPainter::Antialiasing);
    const QRectF card =
        QRectF(option.rect)
            .adjusted(0.5 * kPatientCardGap, 0.5 * kPatientCardGap, -0.5 * kPatientCardGap, -0.5 * kPatientCardGap);
    paint_card(*painter, card, option.state);
    const QRectF inner = card.adjusted(kPad, kPad, -kPad, -kPad);
    const QRectF picture(inner.topLeft(), QSizeF(inner.width(), kShape * inner.width()));
    paint_picture(*painter, picture, index.data(Qt::DecorationRole).value<QPixmap>());
    paint_texts(*painter, QRectF(QPointF(inner.left(), picture.bottom() + kPad), inner.bottomRight()), index);
    painter->restore();
  }

 private:
  static void paint_card(QPainter& painter, const QRectF& card, QStyle::State state) {
    const bool is_selected = (state & QStyle::State_Selected) != 0;
    const bool is_hovered = (state & QStyle::State_MouseOver) != 0;
    painter.setBrush(is_selected || is_hovered ? theme().raised : theme().panel);
    painter.setPen(is_selected ? QPen(theme().accent, 2.0) : QPen(theme().line, 1.0));
    painter.drawRoundedRect(card, kCorner, kCorner);
    if (!is_selected || (state & QStyle::State_HasFocus) == 0) return;
    painter.setBrush(Qt::NoBrush);
    painter.setPen(QPen(theme().text, 1.0, Qt::DotLine));
    painter.drawRoundedRect(card.adjusted(3, 3, -3, -3), kCorner, kCorner);
  }

  /// Name; difficulty and task; description.
  static void paint_texts(QPainter& painter, const QRectF& area, const QModelIndex& index) {
    double top = area.top();
    const auto line = [&](const QString& text, const QFont& font, const QColor& color, double left) {
      painter.setFont(font);
      painter.setPen(color);
      const QFontMetricsF metrics(font);
      const QRectF place(left, top, area.right() - left, metrics.lineSpacing());
      painter.drawText(place, Qt::AlignLeft | Qt::AlignVCenter,
                       metrics.elidedText(text, Qt::ElideRight, place.width()));
      return metrics.lineSpacing();
    };
    const QFont small = scaled_font(0.9);
    top += line(index.data(Qt::DisplayRole).toString(), scaled_font(1.0, true), theme().text, area.left());
    const QFontMetricsF metrics(small);
    double left = area.left();
    const int difficulty = index.data(kDifficulty).toInt();
    if (difficulty > 0) {
      const double diameter = 0.62 * metrics.ascent();
      left = paint_dots(painter, {left, top + 0.5 * metrics.lineSpacing()}, diameter, difficulty) + 0.5 * diameter;
    }
    top += line(index.data(kTask).toString(), small, theme().dim, left);
    line(index.data(kDescription).toString(), small, theme().dim, area.left());
  }
};

}  // namespace

PatientCards::PatientCards(QWidget* parent) : QListWidget(parent) {
  setViewMode(QListView::IconMode);
  setMovement(QListView::Static);
  setResizeMode(QListView::Adjust);
  setUniformItemSizes(true);
  setWordWrap(false);
  setSelectionMode(QAbstractItemView::SingleSelection);
  setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
  setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  setMouseTracking(true);
  setItemDelegate(new CardDelegate(this));
}

void PatientCards::show_patients(const std::vector<PatientEntry>& entries) {
  const PatientEntry* before = chosen();
  const QString source = before == nullptr ? QString() : before->source;
  clear();
  entries_.clear();
  for (const PatientEntry& entry : entries) add_patient(entry);
  if (!choose(source) && count() > 0) setCurrentRow(0);
}

void PatientCards::add_patient(const PatientEntry& entry) {
  entries_.push_back(entry);
  auto* item = new QListWidgetItem(entry.name);
  item->setData(kTask, entry.task);
  item->setData(kDescription, entry.description);
  item->setData(kDifficulty, entry.difficulty);
  item->setData(Qt::DecorationRole, load_picture(entry.thumbnail));
  item->setData(Qt::AccessibleTextRole, spoken_text(entry));
  QStringList lines{entry.description, difficulty_text(entry.difficulty), entry.details};
  lines.removeAll(QString());
  item->setToolTip(lines.join(QLatin1Char('\n')));
  item->setSizeHint(gridSize());
  addItem(item);
}

bool PatientCards::choose(const QString& source) {
  const auto found =
      std::find_if(entries_.begin(), entries_.end(), [&](const PatientEntry& entry) { return entry.source == source; });
  if (found == entries_.end()) return false;
  setCurrentRow(static_cast<int>(found - entries_.begin()));
  scrollToItem(currentItem());
  return true;
}

const PatientEntry* PatientCards::chosen() const {
  const int row = currentRow();
  return row >= 0 && static_cast<std::size_t>(row) < entries_.size() ? &entries_[static_cast<std::size_t>(row)]
                                                                     : nullptr;
}

void PatientCards::fit_cards() {
  // Always beside a scroll bar: with cards that depend on it, it could appear and vanish in turn.
  constexpr int kRim = 4;  // the view wraps a row that fills it exactly
  const int width = contentsRect().width() - verticalScrollBar()->sizeHint().width() - kRim;
  const int columns = std::max(1, width / (kLeastWidth + kPatientCardGap));
  const int cell = std::min(width / columns, kGreatestWidth + kPatientCardGap);
  const QSize size(cell, CardDelegate::height_of(cell - kPatientCardGap) + kPatientCardGap);
  if (size == gridSize()) return;
  setGridSize(size);
  for (int row = 0; row < count(); ++row) item(row)->setSizeHint(size);
}

void PatientCards::resizeEvent(QResizeEvent* event) {
  QListWidget::resizeEvent(event);
  fit_cards();
  executeDelayedItemsLayout();  // the selected card has its new place
  scrollToItem(currentItem());
}

void PatientCards::changeEvent(QEvent* event) {
  QListWidget::changeEvent(event);
  if (event->type() == QEvent::FontChange || event->type() == QEvent::StyleChange) fit_cards();
}

}  // namespace trocar::trainer
