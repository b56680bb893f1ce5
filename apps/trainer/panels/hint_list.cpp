#include "panels/hint_list.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QVBoxLayout>

#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

/// A button whose text wraps; an ordinary button has one line.
class HintRow final : public QPushButton {
 public:
  HintRow(const QString& text, const QString& moment) {
    auto* line = new QHBoxLayout(this);
    line->setContentsMargins(9, 7, 9, 7);
    line->setSpacing(8);
    auto* words = make_label(text);
    words->setWordWrap(true);
    auto* place = make_label(moment, "dim");
    for (QLabel* label : {words, place}) label->setAttribute(Qt::WA_TransparentForMouseEvents);
    line->addWidget(words, 1);
    line->addWidget(place, 0, Qt::AlignTop);
    setCheckable(true);
    setSizePolicy(QSizePolicy::Preferred, QSizePolicy::Minimum);  // a button's own is as wide as its text
    setStyleSheet(QStringLiteral("QPushButton { padding: 0; text-align: left; }"));
  }
  QSize sizeHint() const override { return layout()->sizeHint(); }
  QSize minimumSizeHint() const override { return layout()->minimumSize(); }
};

}  // namespace

HintList::HintList(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("hints"));
  rows_ = new QVBoxLayout(this);
  rows_->setContentsMargins(0, 0, 0, 0);
  rows_->setSpacing(6);
}

void HintList::show_hints(const std::vector<scoring::Hint>& hints) {
  clear_layout(*rows_);
  moments_.clear();
  chosen_.reset();
  for (std::size_t h = 0; h < hints.size(); ++h) add_row(static_cast<int>(h + 1), hints[h]);
  if (hints.empty()) rows_->addWidget(make_label(tr("Nothing to improve.")));
}

void HintList::add_row(int number, const scoring::Hint& hint) {
  const QString text = shown(hint.text), name = QStringLiteral("hint-%1").arg(number);
  if (!hint.at_s) {
    auto* label = make_label(text);
    label->setObjectName(name);
    label->setWordWrap(true);
    label->setContentsMargins(9, 3, 9, 3);
    rows_->addWidget(label);
    return;
  }
  auto* row = new HintRow(text, tr("%1 s \u25b8").arg(*hint.at_s, 0, 'f', 1));
  row->setObjectName(name);
  row->setToolTip(tr("Show this moment in the replay; H: the next one"));
  row->setAccessibleName(tr("%1 At %2 seconds: show in the replay.").arg(text).arg(*hint.at_s, 0, 'f', 1));
  rows_->addWidget(row);
  const std::size_t moment = moments_.size();
  moments_.push_back({*hint.at_s, row});
  connect(row, &QPushButton::clicked, this, [this, moment] { choose(moment); });
}

void HintList::choose(std::size_t moment) {
  chosen_ = moment;
  for (std::size_t m = 0; m < moments_.size(); ++m) moments_[m].row->setChecked(m == moment);
  Q_EMIT moment_chosen(moments_[moment].time_s);
}

void HintList::choose_next() {
  if (!moments_.empty()) choose(chosen_ ? (*chosen_ + 1) % moments_.size() : 0);
}

}  // namespace trocar::trainer
