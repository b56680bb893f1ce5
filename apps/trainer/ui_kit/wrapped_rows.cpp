#include "ui_kit/wrapped_rows.h"

#include <QListView>
#include <QScrollBar>
#include <QStyledItemDelegate>

namespace trocar::trainer {
namespace {

class WrappedRow final : public QStyledItemDelegate {
 public:
  explicit WrappedRow(QListView& list) : QStyledItemDelegate(&list), list_(list) {}

  QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    return QStyledItemDelegate::sizeHint(narrowed(option), index);
  }
  void paint(QPainter* painter, const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    QStyledItemDelegate::paint(painter, narrowed(option), index);
  }

 private:
  QStyleOptionViewItem narrowed(const QStyleOptionViewItem& option) const {
    QStyleOptionViewItem narrow = option;
    narrow.rect.setWidth(list_.maximumViewportSize().width() - list_.verticalScrollBar()->sizeHint().width());
    return narrow;
  }

  QListView& list_;
};

}  // namespace

void wrap_rows(QListView& list) {
  list.setWordWrap(true);
  list.setResizeMode(QListView::Adjust);
  list.setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  list.setItemDelegate(new WrappedRow(list));
}

}  // namespace trocar::trainer
