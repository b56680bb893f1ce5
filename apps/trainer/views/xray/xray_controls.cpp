#include "views/xray/xray_controls.h"

#include <QCheckBox>
#include <QComboBox>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QScrollArea>
#include <QSignalBlocker>
#include <QSlider>
#include <array>
#include <cmath>

#include "ui_kit/control_section.h"
#include "ui_kit/parts.h"
#include "views/xray/xray_view.h"

namespace trocar::trainer {
namespace {

struct Projection {
  const char* name;
  const char* text;
  double lao_deg, cranial_deg;
};
constexpr std::array<Projection, 4> kProjections{{{"xray-ap", QT_TRANSLATE_NOOP("Table", "AP"), 0.0, 0.0},
                                                  {"xray-rao30", QT_TRANSLATE_NOOP("Table", "RAO 30"), -30.0, 0.0},
                                                  {"xray-lao30", QT_TRANSLATE_NOOP("Table", "LAO 30"), 30.0, 0.0},
                                                  {"xray-lateral", QT_TRANSLATE_NOOP("Table", "Lateral"), 90.0, 0.0}}};

}  // namespace

XrayControls::XrayControls(XrayView& view, QWidget* parent) : QWidget(parent), view_(view) {
  setObjectName(QStringLiteral("xray-controls"));
  auto* content = new QWidget;
  auto* column = new QVBoxLayout(content);
  column->setContentsMargins(12, 10, 12, 12);
  column->setSpacing(12);
  live_ = {make_pedals(), make_c_arm(), make_exposure()};
  for (QWidget* part : live_) column->addWidget(part);
  column->addWidget(make_image());
  live_.push_back(mode_);
  column->addStretch(1);
  auto* scroll = new QScrollArea(this);
  scroll->setWidget(content);
  scroll->setWidgetResizable(true);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll->setFocusPolicy(Qt::NoFocus);
  auto* all = new QVBoxLayout(this);
  all->setContentsMargins(0, 0, 0, 0);
  all->addWidget(scroll);
  setMinimumWidth(content->minimumSizeHint().width() + 12);
  connect(&view_, &XrayView::changed, this, &XrayControls::show_view);
  show_view();
}

QWidget* XrayControls::make_pedals() {
  QWidget* widget = nullptr;
  QVBoxLayout* box = make_section(widget, {});
  pedal_ = make_button("xray-pedal", tr("Fluoroscopy (hold)"), tr("X-rays while it is held, with the key Z held, too"));
  inject_ = make_button("xray-inject", tr("Inject contrast (hold)"),
                        tr("Contrast agent through the needle while it is held, with the key J held, too"));
  connect(pedal_, &QPushButton::pressed, &view_, [this] { view_.set_pedal(true); });
  connect(pedal_, &QPushButton::released, &view_, [this] { view_.set_pedal(false); });
  connect(inject_, &QPushButton::pressed, &view_, [this] { view_.set_injecting(true); });
  connect(inject_, &QPushButton::released, &view_, [this] { view_.set_injecting(false); });
  box->addWidget(pedal_);
  box->addWidget(inject_);
  return widget;
}

QSlider* XrayControls::add_slider(QGridLayout& grid, const char* name, const QString& label, const QString& tooltip,
                                  int low, int high, QLabel*& value) {
  const int row = grid.rowCount();
  auto* slider = new QSlider(Qt::Horizontal);
  slider->setObjectName(QString::fromLatin1(name));
  slider->setAccessibleName(label);
  slider->setToolTip(tooltip);
  slider->setRange(low, high);
  value = make_label(QString());
  grid.addWidget(make_label(label), row, 0);
  grid.addWidget(slider, row, 1);
  grid.addWidget(value, row, 2);
  return slider;
}

QComboBox* XrayControls::add_choice(QGridLayout& grid, const char* name, const QString& label, const QString& tooltip) {
  const int row = grid.rowCount();
  auto* choice = new QComboBox;
  choice->setObjectName(QString::fromLatin1(name));
  choice->setAccessibleName(label);
  choice->setToolTip(tooltip);
  grid.addWidget(make_label(label), row, 0);
  grid.addWidget(choice, row, 1, 1, 2);
  return choice;
}

QWidget* XrayControls::make_c_arm() {
  QWidget* widget = nullptr;
  QVBoxLayout* box = make_section(widget, tr("C-arm"));
  auto* buttons = new QGridLayout;
  for (std::size_t n = 0; n < kProjections.size(); ++n) {
    const Projection& p = kProjections[n];
    auto* button = make_button(p.name, tr(p.text), tr("Turns the C-arm to this projection"));
    button->setStyleSheet(QStringLiteral("padding: 4px 6px;"));
    connect(button, &QPushButton::clicked, this, [this, &p] {
      view_.change_settings([&](XraySettings& s) {
        s.arm.lao_deg = p.lao_deg;
        s.arm.cranial_deg = p.cranial_deg;
      });
    });
    buttons->addWidget(button, static_cast<int>(n) / 2, static_cast<int>(n) % 2);
  }
  box->addLayout(buttons);
  auto* grid = make_control_grid();
  const auto reach = [](double degrees) { return static_cast<int>(std::lround(degrees)); };
  const int side = reach(view_.unit().largest_lao_deg), head = reach(view_.unit().largest_cranial_deg);
  lao_ = add_slider(*grid, "xray-lao", tr("RAO–LAO"), tr("Detector to the patient's right or left"), -side, side,
                    lao_value_);
  cranial_ = add_slider(*grid, "xray-cranial", tr("CAUD–CRAN"), tr("Detector towards feet or head"), -head, head,
                        cranial_value_);
  connect(lao_, &QSlider::valueChanged, this,
          [this](int v) { view_.change_settings([=](XraySettings& s) { s.arm.lao_deg = v; }); });
  connect(cranial_, &QSlider::valueChanged, this,
          [this](int v) { view_.change_settings([=](XraySettings& s) { s.arm.cranial_deg = v; }); });
  table_ = add_slider(*grid, "xray-table", tr("Table"), tr("Height of the table: nearer to the detector is smaller"),
                      -150, 150, table_value_);
  connect(table_, &QSlider::valueChanged, this,
          [this](int v) { view_.change_settings([=](XraySettings& s) { s.table_mm = v; }); });
  field_ = add_choice(*grid, "xray-field", tr("Field"), tr("Edge of the field: a smaller one magnifies"));
  for (const double field_mm : view_.unit().fields_mm)
    field_->addItem(tr("%1 cm").arg(field_mm / 10.0, 0, 'f', 0), field_mm);
  connect(field_, qOverload<int>(&QComboBox::activated), this, [this] {
    view_.change_settings([this](XraySettings& s) { s.arm.field_mm = field_->currentData().toDouble(); });
  });
  across_ = add_slider(*grid, "xray-collimate-across", tr("Width"), tr("Collimator: irradiated share of the field"), 10,
                       100, across_value_);
  along_ = add_slider(*grid, "xray-collimate-along", tr("Height"), tr("Collimator: irradiated share of the field"), 10,
                      100, along_value_);
  connect(across_, &QSlider::valueChanged, this,
          [this](int v) { view_.change_settings([=](XraySettings& s) { s.arm.collimation[0] = 0.01 * v; }); });
  connect(along_, &QSlider::valueChanged, this,
          [this](int v) { view_.change_settings([=](XraySettings& s) { s.arm.collimation[1] = 0.01 * v; }); });
  box->addLayout(grid);
  return widget;
}

QWidget* XrayControls::make_exposure() {
  QWidget* widget = nullptr;
  QVBoxLayout* box = make_section(widget, tr("Exposure"));
  auto* grid = make_control_grid();
  pulses_ = add_choice(*grid, "xray-pulses", tr("Pulses"), tr("Pulses a second: fewer give less dose"));
  for (const double rate : xray::kPulseRates_per_s) pulses_->addItem(tr("%1 per s").arg(rate), rate);
  connect(pulses_, qOverload<int>(&QComboBox::activated), this, [this] {
    view_.change_settings([this](XraySettings& s) { s.pulses_per_s = pulses_->currentData().toDouble(); });
  });
  dose_ = add_choice(*grid, "xray-dose", tr("Dose"), tr("Dose at the detector: half, normal or double"));
  dose_->addItems({tr("low"), tr("normal"), tr("high")});
  connect(dose_, qOverload<int>(&QComboBox::activated), this, [this](int index) {
    view_.change_settings([=](XraySettings& s) { s.dose_mode = static_cast<xray::DoseMode>(index); });
  });
  box->addLayout(grid);
  return widget;
}

QWidget* XrayControls::make_image() {
  QWidget* widget = nullptr;
  QVBoxLayout* box = make_section(widget, tr("Image"));
  auto* grid = make_control_grid();
  mode_ = add_choice(
      *grid, "xray-mode", tr("Mode"),
      tr("Subtraction: the first images are the mask, later ones show what was added. Road map: live, with the "
         "filled ducts or vessels of the last subtraction"));
  mode_->addItems({tr("live"), tr("subtraction"), tr("road map")});
  connect(mode_, qOverload<int>(&QComboBox::activated), this, [this](int index) {
    view_.change_settings([=](XraySettings& s) { s.mode = static_cast<xray::ImageMode>(index); });
  });
  box->addLayout(grid);
  inverted_ = new QCheckBox(tr("Bones white"));
  inverted_->setObjectName(QStringLiteral("xray-inverted"));
  connect(inverted_, &QCheckBox::toggled, this,
          [this](bool is_on) { view_.change_settings([=](XraySettings& s) { s.is_inverted = is_on; }); });
  box->addWidget(inverted_);
  return widget;
}

void XrayControls::show_view() {
  const XraySettings& s = view_.settings();
  const auto show = [](QSlider& slider, QLabel& value, double number, const QString& unit) {
    const QSignalBlocker blocker(slider);
    slider.setValue(static_cast<int>(std::lround(number)));
    value.setText(QString::number(std::lround(number)) + unit);
  };
  show(*lao_, *lao_value_, s.arm.lao_deg, QStringLiteral("°"));
  show(*cranial_, *cranial_value_, s.arm.cranial_deg, QStringLiteral("°"));
  show(*table_, *table_value_, s.table_mm, QStringLiteral(" mm"));
  if (view_.is_replay()) table_value_->setText(QStringLiteral("–"));  // only the isocentre is recorded
  show(*across_, *across_value_, 100.0 * s.arm.collimation[0], QStringLiteral(" %"));
  show(*along_, *along_value_, 100.0 * s.arm.collimation[1], QStringLiteral(" %"));
  field_->setCurrentIndex(field_->findData(s.arm.field_mm));
  pulses_->setCurrentIndex(pulses_->findData(s.pulses_per_s));
  dose_->setCurrentIndex(static_cast<int>(s.dose_mode));
  mode_->setCurrentIndex(static_cast<int>(s.mode));
  for (QWidget* part : live_) part->setEnabled(!view_.is_replay());
  const QSignalBlocker blocker(*inverted_);
  inverted_->setChecked(s.is_inverted);
  set_style(*pedal_, "is_on", view_.is_pedal_down());
  set_style(*inject_, "is_on", view_.is_injecting());
}

}  // namespace trocar::trainer
