#include "ui_kit/check_list.h"

#include <QPainter>
#include <QPixmap>
#include <algorithm>

#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"
#include "ui_kit/wrapped_rows.h"

namespace trocar::trainer {
namespace {

constexpr int kIconPixels = 64;  ///< Scaled down by the widget on every screen.

void paint_tick(QPainter& painter) {
  painter.drawPolyline(QPolygonF() << QPointF(16, 34) << QPointF(28, 46) << QPointF(48, 20));
}
void paint_exclamation(QPainter& painter) {
  painter.drawLine(QPointF(32, 16), QPointF(32, 36));
  painter.drawPoint(QPointF(32, 48));
}
void paint_cross(QPainter& painter) {
  painter.drawLine(QPointF(20, 20), QPointF(44, 44));
  painter.drawLine(QPointF(44, 20), QPointF(20, 44));
}

/// A long list of names is shortened; the tooltip shows all of it.
QString shortened(const QString& text) {
  constexpr int kLongest = 120;
  if (text.size() <= kLongest) return text;
  const auto comma = text.lastIndexOf(QStringLiteral(", "), kLongest);
  return comma > 0 ? text.left(comma) + QStringLiteral(" …") : text;
}

}  // namespace

QIcon level_icon(std::optional<case_builder::CheckLevel> level) {
  QPixmap pixmap(kIconPixels, kIconPixels);
  pixmap.fill(Qt::transparent);
  QPainter painter(&pixmap);
  painter.setRenderHint(QPainter::Antialiasing);
  const Theme& t = theme();
  const QColor color = !level                                         ? t.line
                       : *level == case_builder::CheckLevel::kOk      ? t.good
                       : *level == case_builder::CheckLevel::kWarning ? t.warning
                                                                      : t.bad;
  painter.setPen(QPen(color, 5));
  painter.drawEllipse(QRectF(5, 5, 54, 54));
  painter.setPen(QPen(color, 7, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  if (level == case_builder::CheckLevel::kOk) paint_tick(painter);
  if (level == case_builder::CheckLevel::kWarning) paint_exclamation(painter);
  if (level == case_builder::CheckLevel::kError) paint_cross(painter);
  painter.end();
  return QIcon(pixmap);
}

CheckList::CheckList(QWidget* parent) : QListWidget(parent) {
  setObjectName(QStringLiteral("case-checks"));
  setAccessibleName(tr("Checks of the case"));
  setToolTip(tr("Click to go to the problem  (Enter)"));
  wrap_rows(*this);
  const auto choose = [this](QListWidgetItem* item) {
    Q_EMIT check_chosen(checks_[static_cast<std::size_t>(row(item))]);
  };
  connect(this, &QListWidget::itemClicked, this, choose);
  connect(this, &QListWidget::itemActivated, this, choose);
}

void CheckList::show_checks(const std::vector<case_builder::CaseCheck>& checks) {
  std::vector<case_builder::CaseCheck> sorted = checks;
  std::stable_sort(
      sorted.begin(), sorted.end(),
      [](const case_builder::CaseCheck& a, const case_builder::CaseCheck& b) { return a.level > b.level; });
  const bool is_same = std::equal(sorted.begin(), sorted.end(), checks_.begin(), checks_.end(),
                                  [](const case_builder::CaseCheck& a, const case_builder::CaseCheck& b) {
                                    return a.level == b.level && a.text == b.text && a.where_P == b.where_P;
                                  });
  if (is_same) return;
  checks_ = std::move(sorted);
  clear();
  for (const case_builder::CaseCheck& check : checks_) {
    auto* item = new QListWidgetItem(level_icon(check.level), shortened(shown(check.text)), this);
    item->setToolTip(shown(check.text));
    const char* word = check.level == case_builder::CheckLevel::kOk        ? QT_TRANSLATE_NOOP("Table", "in order")
                       : check.level == case_builder::CheckLevel::kWarning ? QT_TRANSLATE_NOOP("Table", "doubtful")
                                                                           : QT_TRANSLATE_NOOP("Table", "wrong");
    item->setData(Qt::AccessibleTextRole, QStringLiteral("%1: %2").arg(tr(word), shown(check.text)));
  }
}

}  // namespace trocar::trainer
