#include "parameters/parameter_row.h"

#include <QGridLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QPainter>
#include <QSignalBlocker>
#include <QToolButton>
#include <QWheelEvent>

#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

constexpr int kHandle = 14;  ///< Width of the theme's slider handle.
constexpr int kFieldWidth = 76, kUnitWidth = 52;

}  // namespace

MarkedSlider::MarkedSlider(QWidget* parent) : QSlider(Qt::Horizontal, parent) {
  setRange(0, ParameterScale::kSteps);
  setPageStep(ParameterScale::kSteps / 20);
  setSingleStep(ParameterScale::kSteps / 100);
  setFocusPolicy(Qt::StrongFocus);
  setMinimumHeight(24);
}

void MarkedSlider::set_marks(int default_position, int low, int high) {
  default_ = default_position;
  low_ = low;
  high_ = high;
  update();
}

double MarkedSlider::x_of(int position) const {
  return 0.5 * kHandle + static_cast<double>(position) / ParameterScale::kSteps * (width() - kHandle);
}

void MarkedSlider::paintEvent(QPaintEvent* event) {
  {
    QPainter painter(this);
    const double middle = 0.5 * height();
    if (high_ > low_) {
      QColor band = theme().path;
      band.setAlphaF(0.35F);
      painter.fillRect(QRectF(x_of(low_), middle + 7.0, x_of(high_) - x_of(low_), 3.0), band);
    }
    painter.fillRect(QRectF(x_of(default_) - 1.0, middle + 4.0, 2.0, 8.0), theme().text);
  }
  QSlider::paintEvent(event);
}

void MarkedSlider::wheelEvent(QWheelEvent* event) {
  if (hasFocus()) {
    QSlider::wheelEvent(event);
  } else {
    event->ignore();
  }
}

void NumberField::show_number(const QString& text) {
  shown_ = text;
  if (this->text() == text && !isModified()) return;
  setText(text);
  setCursorPosition(0);
}

bool NumberField::event(QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride && !isModified()) {
    const auto* key = static_cast<QKeyEvent*>(event);
    if (key->matches(QKeySequence::Undo) || key->matches(QKeySequence::Redo)) {
      event->ignore();
      return false;
    }
  }
  return QLineEdit::event(event);
}

void NumberField::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape && isModified()) {
    setText(shown_);
    selectAll();
    Q_EMIT textEdited(shown_);
    return;
  }
  QLineEdit::keyPressEvent(event);
}

ParameterRow::ParameterRow(const anatomy::TissueParameter& parameter, const QString& name, QWidget* parent)
    : QWidget(parent), parameter_(parameter), scale_(parameter), value_(parameter.value) {
  setObjectName(name + QStringLiteral("-row"));
  make_parts(name);
  connect(field_, &QLineEdit::editingFinished, this, &ParameterRow::take_text);
  connect(field_, &QLineEdit::textEdited, this, [this] { show_refusal({}); });
  connect(slider_, &QSlider::valueChanged, this, &ParameterRow::take_slider);
  connect(slider_, &QSlider::sliderReleased, this, [this] { is_held_ = false; });
  connect(reset_, &QToolButton::clicked, this, &ParameterRow::reset_asked);
  show_value(value_);
}

void ParameterRow::make_parts(const QString& name) {
  const QString plain = shown(parameter_.name);
  caption_ = make_label(QStringLiteral("<b>%1</b>  %2").arg(to_qt(parameter_.symbol), plain));
  QString symbol = to_qt(parameter_.symbol);
  if (const auto at = symbol.indexOf(QLatin1Char('_')); at > 0)  // F_p as printed in the papers
    symbol = symbol.left(at) + QStringLiteral("<sub>") + symbol.mid(at + 1) + QStringLiteral("</sub>");
  caption_->setText(QStringLiteral("<b>%1</b>&nbsp; %2").arg(symbol, plain));
  field_ = new NumberField;
  field_->setObjectName(name);
  field_->setAccessibleName(plain);
  field_->setAlignment(Qt::AlignRight);
  field_->setFixedWidth(kFieldWidth);
  auto* unit = make_label(shown(parameter_.unit), "dim");
  unit->setFixedWidth(kUnitWidth);
  reset_ = new QToolButton;
  reset_->setObjectName(name + QStringLiteral("-reset"));
  reset_->setText(QStringLiteral("↺"));
  reset_->setStyleSheet(QStringLiteral("padding: 2px 6px"));  // not higher than the field next to it
  reset_->setAccessibleName(tr("Reset %1").arg(plain));
  reset_->setToolTip(tr("Reset to the default, %1").arg(number_text(parameter_.value)));
  slider_ = new MarkedSlider;
  slider_->setObjectName(name + QStringLiteral("-slider"));
  slider_->setAccessibleName(plain);
  const anatomy::Provenance& source = parameter_.provenance;
  const bool is_relative = to_qt(parameter_.setting).endsWith(QStringLiteral("_factor"));
  const bool has_range = source.low && source.high && (is_relative || !(*source.high < parameter_.low));
  slider_->set_marks(scale_.position_of(parameter_.value), has_range ? scale_.position_of(*source.low) : 0,
                     has_range ? scale_.position_of(*source.high) : 0);
  refusal_ = make_label({});
  refusal_->setObjectName(name + QStringLiteral("-refused"));
  refusal_->setWordWrap(true);
  refusal_->setStyleSheet(QStringLiteral("color: %1").arg(theme().bad.name()));
  refusal_->hide();
  for (QWidget* part : {static_cast<QWidget*>(caption_), static_cast<QWidget*>(field_), static_cast<QWidget*>(slider_)})
    part->setToolTip(tooltip());

  auto* grid = new QGridLayout(this);
  grid->setContentsMargins(0, 2, 0, 2);
  grid->setHorizontalSpacing(6);
  grid->setVerticalSpacing(0);
  grid->addWidget(caption_, 0, 0, 1, 3);
  grid->addWidget(slider_, 1, 0);
  grid->addWidget(field_, 1, 1);
  grid->addWidget(unit, 1, 2);
  grid->addWidget(reset_, 1, 3);
  grid->addWidget(refusal_, 2, 0, 1, 4);
  grid->setColumnStretch(0, 1);
}

QString ParameterRow::tooltip() const {
  const anatomy::Provenance& source = parameter_.provenance;
  const QString unit = parameter_.unit.empty() ? QString() : QStringLiteral(" ") + shown(parameter_.unit);
  QStringList lines{
      tr("Default %1%2").arg(number_text(parameter_.value), unit),
      // A citation keeps its language.
      tr("Source: %1").arg(QStringLiteral("<span lang=\"en\">%1</span>").arg(to_qt(source.source).toHtmlEscaped()))};
  if (source.low && source.high)
    lines << tr("Plausible range: %1 to %2%3").arg(number_text(*source.low), number_text(*source.high), unit);
  lines << tr("Taken: %1").arg(range_text(parameter_));
  if (!parameter_.owner.empty()) lines << tr("Same parameter as that of %1").arg(shown(parameter_.owner));
  QStringList models;
  if (parameter_.is_insertion) models << tr("insertion");
  if (parameter_.is_proxy) models << tr("proxy");
  if (parameter_.is_combined) models << tr("combined");
  lines << tr("Used by: %1").arg(models.join(QStringLiteral(", ")));
  lines << tr("Press Enter to apply; arrow keys move the slider");
  return lines.join(QStringLiteral("<br>"));
}

void ParameterRow::show_value(double value) {
  value_ = value;
  const QSignalBlocker silent(slider_);
  if (!slider_->isSliderDown()) slider_->setValue(scale_.position_of(value));
  field_->show_number(number_text(value));
  show_refusal({});
  reset_->setEnabled(value != parameter_.value);
  QFont font = field_->font();
  font.setBold(value != parameter_.value);
  field_->setFont(font);
}

void ParameterRow::set_felt(bool is_felt) {
  set_style(*caption_, "role", is_felt ? QString() : QStringLiteral("dim"));
}

void ParameterRow::show_refusal(const QString& text) {
  refusal_->setText(text);
  refusal_->setVisible(!text.isEmpty());
  field_->setStyleSheet(text.isEmpty() ? QString() : QStringLiteral("border-color: %1").arg(theme().bad.name()));
}

void ParameterRow::take_text() {
  if (field_->text() == number_text(value_)) return;
  double value = 0.0;
  if (!read_number(field_->text(), parameter_, value)) {
    show_refusal(tr("\"%1\" is not valid: %2").arg(field_->text().left(20), range_text(parameter_)));
    return;
  }
  if (value == value_) {
    show_value(value_);
  } else {
    Q_EMIT edited(value, false);
  }
}

void ParameterRow::take_slider(int position) {
  const bool is_down = slider_->isSliderDown();
  const bool joins = is_down && is_held_;
  is_held_ = is_down;
  // At the mark, the value is the exact default.
  const double value = position == scale_.position_of(parameter_.value) ? parameter_.value : scale_.value_at(position);
  if (value != value_) Q_EMIT edited(value, joins);
}

}  // namespace trocar::trainer
