#include "views/ultrasound/ultrasound_controls.h"

#include <QCheckBox>
#include <QComboBox>
#include <QFontMetricsF>
#include <QGridLayout>
#include <QLabel>
#include <QPushButton>
#include <QScrollArea>
#include <QSignalBlocker>
#include <QSlider>
#include <QStyle>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/files/folders.h"
#include "core/log.h"
#include "ui_kit/control_section.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

constexpr ultrasound::GrayMap kMaps[] = {ultrasound::GrayMap::kSoft, ultrasound::GrayMap::kLinear,
                                         ultrasound::GrayMap::kHighContrast};

/// Small enough for three side by side in the panel.
QPushButton* small_button(const char* name, const QString& text, const QString& tooltip) {
  QPushButton* button = make_button(name, text, tooltip);
  button->setStyleSheet(QStringLiteral("padding: 4px 6px;"));
  return button;
}

auto decibels(int decimals = 0) {
  return [decimals](double db) { return QStringLiteral("%L1 dB").arg(db, 0, 'f', decimals); };
}

auto centimetres() {
  return [](double mm) { return QStringLiteral("%L1 cm").arg(mm / 10.0, 0, 'f', 1); };
}

}  // namespace

UltrasoundControls::UltrasoundControls(UltrasoundView& view, QWidget* parent) : QWidget(parent), view_(view) {
  setObjectName(QStringLiteral("ultrasound-controls"));
  load_tables();
  auto* content = new QWidget;
  auto* column = new QVBoxLayout(content);
  column->setContentsMargins(12, 10, 12, 12);
  column->setSpacing(12);
  for (QWidget* part :
       {make_source(), make_freeze(), make_picture(), make_tgc(), make_measuring(), make_guide(), make_doppler()})
    column->addWidget(part);
  auto* reset = make_button("ultrasound-reset", tr("Reset image settings"),
                            tr("Reset all image settings to the transducer's defaults"));
  connect(reset, &QPushButton::clicked, this, [this] { view_.reset_settings(); });
  column->addWidget(reset);
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
  connect(&view_, &UltrasoundView::changed, this, &UltrasoundControls::show_view);
  show_view();
}

void UltrasoundControls::load_tables() {
  auto transducers = ultrasound::load_transducers(data_dir() / "transducers.toml");
  if (transducers) transducers_ = std::move(*transducers);
  if (!transducers) log_warning("{}", transducers.error().text());
  auto presets = ultrasound::load_scan_presets(data_dir() / "scan_presets.toml");
  if (presets) presets_ = std::move(*presets);
  if (!presets) log_warning("{}", presets.error().text());
}

QWidget* UltrasoundControls::make_source() {
  QWidget* widget = nullptr;
  QVBoxLayout* box = make_section(widget, {});
  auto* grid = make_control_grid();
  const auto combo = [&](int row, const char* name, const QString& label, const QString& tooltip) {
    auto* made = new QComboBox;
    made->setObjectName(QString::fromLatin1(name));
    made->setAccessibleName(label);
    made->setToolTip(tooltip);
    grid->addWidget(make_label(label), row, 0);
    grid->addWidget(made, row, 1);
    return made;
  };
  transducer_ = combo(0, "ultrasound-transducer", tr("Transducer"), tr("Ultrasound array"));
  for (const ultrasound::Transducer& t : transducers_) {
    transducer_->addItem(to_qt(t.name));
    transducer_->setItemData(transducer_->count() - 1, shown(t.description), Qt::ToolTipRole);
  }
  preset_ = combo(1, "ultrasound-preset", tr("Preset"), tr("Transducer and image settings for an examination"));
  preset_->addItem(tr("choose"));
  for (const ultrasound::ScanPreset& preset : presets_) preset_->addItem(shown(preset.title));
  engine_ = combo(2, "ultrasound-engine", tr("Engine"),
                  tr("Ray cast: from CT and labels; panorama: from the patient's stitched ultrasound volumes"));
  engine_->addItems({tr("Ray cast"), tr("Panorama")});
  box->addLayout(grid);
  connect(engine_, qOverload<int>(&QComboBox::activated), this,
          [this](int index) { view_.change_settings([&](UltrasoundSettings& s) { s.is_panorama = index == 1; }); });
  connect(transducer_, qOverload<int>(&QComboBox::activated), this, [this](int index) {
    if (index >= 0) view_.choose_transducer(transducers_[static_cast<std::size_t>(index)]);
  });
  connect(preset_, qOverload<int>(&QComboBox::activated), this, [this](int index) {
    if (index > 0) apply_preset(index - 1);
  });
  return widget;
}

void UltrasoundControls::apply_preset(int index) {
  const ultrasound::ScanPreset& preset = presets_[static_cast<std::size_t>(index)];
  const auto transducer = std::find_if(transducers_.begin(), transducers_.end(),
                                       [&](const ultrasound::Transducer& t) { return t.name == preset.transducer; });
  if (transducer == transducers_.end()) return;
  view_.choose_transducer(*transducer);
  view_.change_settings([&](UltrasoundSettings& s) {
    s.acquisition = ultrasound::acquisition_of(preset, *transducer);
    s.display = preset.display;
    s.has_doppler = preset.has_doppler && view_.has_flow();
    s.doppler.scale_cm_per_s = preset.doppler_scale_cm_per_s;
  });
}

QWidget* UltrasoundControls::make_freeze() {
  QWidget* widget = nullptr;
  QVBoxLayout* box = make_section(widget, {});
  freeze_ = make_button("ultrasound-freeze", tr("Freeze"), tooltip_of(Action::kFreeze));
  freeze_->setCheckable(true);
  connect(freeze_, &QPushButton::clicked, this, [this](bool is_on) { view_.set_frozen(is_on); });
  box->addWidget(freeze_);
  cine_row_ = new QWidget;
  auto* row = new QHBoxLayout(cine_row_);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(6);
  auto* back = small_button("ultrasound-cine-back", QStringLiteral("‹"),
                            tr("Previous frame  (%1)").arg(keys_text(Action::kCineFrame)));
  auto* on = small_button("ultrasound-cine-on", QStringLiteral("›"),
                          tr("Next frame  (%1)").arg(keys_text(Action::kCineFrame)));
  play_ = small_button("ultrasound-cine-play", tr("Play"), tooltip_of(Action::kCinePlay));
  play_->setCheckable(true);
  cine_ = new QSlider(Qt::Horizontal);
  cine_->setObjectName(QStringLiteral("ultrasound-cine"));
  cine_->setAccessibleName(tr("Cine loop"));
  cine_->setToolTip(tr("Frames of the cine loop, oldest on the left"));
  row->addWidget(back);
  row->addWidget(cine_, 1);
  row->addWidget(on);
  row->addWidget(play_);
  box->addWidget(cine_row_);
  connect(back, &QPushButton::clicked, this, [this] { view_.step_cine(-1); });
  connect(on, &QPushButton::clicked, this, [this] { view_.step_cine(1); });
  connect(play_, &QPushButton::clicked, this, [this](bool is_on) { view_.play_cine(is_on); });
  connect(cine_, &QSlider::valueChanged, this, [this](int index) { view_.show_cine(index); });
  return widget;
}

void UltrasoundControls::add_control(QGridLayout& grid, const ControlSpec& spec) {
  Control control{new QSlider(Qt::Horizontal), make_label({}), spec.step, spec.number, spec.text};
  control.slider->setObjectName(QString::fromLatin1(spec.name));
  control.slider->setAccessibleName(spec.label);
  control.slider->setToolTip(spec.tooltip);
  control.slider->setRange(static_cast<int>(std::lround(spec.low / spec.step)),
                           static_cast<int>(std::lround(spec.high / spec.step)));
  control.value->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  const double widest = std::max(QFontMetricsF(font()).horizontalAdvance(spec.text(spec.low)),
                                 QFontMetricsF(font()).horizontalAdvance(spec.text(spec.high)));
  control.value->setMinimumWidth(static_cast<int>(widest) + 4);
  const int row = grid.rowCount();
  grid.addWidget(make_label(spec.label), row, 0);
  grid.addWidget(control.slider, row, 1);
  grid.addWidget(control.value, row, 2);
  std::function<void(double)> set = spec.set;
  if (!set) {
    set = [this, number = spec.number](double value) {
      view_.change_settings([&](UltrasoundSettings& s) { number(s) = value; });
    };
  }
  connect(control.slider, &QSlider::valueChanged, this,
          [set, step = spec.step](int position) { set(position * step); });
  controls_.push_back(std::move(control));
}

QCheckBox* UltrasoundControls::add_check(QBoxLayout& box, const char* name, const QString& text, const QString& tooltip,
                                         std::function<bool&(UltrasoundSettings&)> flag) {
  auto* check = new QCheckBox(text);
  check->setObjectName(QString::fromLatin1(name));
  check->setAccessibleName(text);
  check->setToolTip(tooltip);
  box.addWidget(check);
  connect(check, &QCheckBox::clicked, this,
          [this, flag](bool is_on) { view_.change_settings([&](UltrasoundSettings& s) { flag(s) = is_on; }); });
  checks_.push_back({check, std::move(flag)});
  return check;
}

QWidget* UltrasoundControls::make_picture() {
  QWidget* widget = nullptr;
  QVBoxLayout* box = make_section(widget, tr("Picture"));
  auto* grid = make_control_grid();
  using S = UltrasoundSettings;
  add_control(*grid,
              {"ultrasound-gain", tr("Gain"),
               tr("Gain of all echoes  (%1, %2)").arg(keys_text(Action::kMoreGain), keys_text(Action::kLessGain)), -40,
               40, 1, [](S& s) -> double& { return s.display.gain_db; }, decibels(),
               [this](double gain_db) { view_.set_gain(gain_db); }});
  add_control(*grid, {"ultrasound-depth", tr("Depth"),
                      tr("Imaging depth  (%1, %2)").arg(keys_text(Action::kDeeper), keys_text(Action::kShallower)), 20,
                      300, 5, [](S& s) -> double& { return s.acquisition.depth_mm; }, centimetres()});
  add_control(*grid, {"ultrasound-frequency", tr("Frequency"), tr("Higher: better resolution; lower: more penetration"),
                      1, 20, 0.1, [](S& s) -> double& { return s.acquisition.frequency_mhz; },
                      [](double mhz) { return QStringLiteral("%L1 MHz").arg(mhz, 0, 'f', 1); }});
  add_control(*grid, {"ultrasound-focus", tr("Focus"), tr("Depth of the transmit focus"), 5, 300, 5,
                      [](S& s) -> double& { return s.acquisition.focus_mm; }, centimetres()});
  add_control(*grid, {"ultrasound-dynamic-range", tr("Dynamic range"), tr("Smaller: higher contrast"), 20, 100, 1,
                      [](S& s) -> double& { return s.display.dynamic_range_db; }, decibels()});
  add_control(*grid, {"ultrasound-persistence", tr("Persistence"), tr("Weight of the previous frame"), 0, 0.95, 0.05,
                      [](S& s) -> double& { return s.display.persistence; },
                      [](double part) { return QStringLiteral("%L1 %").arg(100.0 * part, 0, 'f', 0); }});
  automatic_ = small_button("ultrasound-automatic-gain", tr("Automatic gain"), tooltip_of(Action::kAutomaticGain));
  automatic_->setCheckable(true);
  connect(automatic_, &QPushButton::clicked, this, [this] { view_.set_gain_automatically(); });
  grid->addWidget(automatic_, grid->rowCount(), 1, 1, 2);
  gray_map_ = new QComboBox;
  gray_map_->setObjectName(QStringLiteral("ultrasound-gray-map"));
  gray_map_->setAccessibleName(tr("Gray map"));
  gray_map_->setToolTip(tr("Gray map"));
  for (const ultrasound::GrayMap map : kMaps) gray_map_->addItem(shown(ultrasound::name_of(map)));
  connect(gray_map_, qOverload<int>(&QComboBox::activated), this,
          [this](int index) { view_.change_settings([&](S& s) { s.display.gray_map = kMaps[index]; }); });
  const int row = grid->rowCount();
  grid->addWidget(make_label(tr("Gray map")), row, 0);
  grid->addWidget(gray_map_, row, 1, 1, 2);
  const int zoom_row = grid->rowCount();
  auto* zoom = new QHBoxLayout;
  zoom->setSpacing(6);
  const auto zoom_button = [&](const char* name, const QString& text, const QString& tooltip, auto act) {
    QPushButton* button = small_button(name, text, tooltip);
    connect(button, &QPushButton::clicked, this, act);
    zoom->addWidget(button);
    return button;
  };
  zoom_out_ =
      zoom_button("ultrasound-zoom-out", QStringLiteral("−"),
                  tr("Smaller  (%1)").arg(keys_text(Action::kZoomUltrasound)), [this] { view_.zoom_by_steps(-1); });
  zoom_button("ultrasound-zoom-in", QStringLiteral("+"),
              tr("Larger  (%1); the middle button moves the image").arg(keys_text(Action::kZoomUltrasound)),
              [this] { view_.zoom_by_steps(1); });
  zoom_reset_ = zoom_button("ultrasound-zoom-reset", tr("Whole"), tooltip_of(Action::kWholeUltrasound),
                            [this] { view_.reset_zoom(); });
  grid->addWidget(make_label(tr("Zoom")), zoom_row, 0);
  grid->addLayout(zoom, zoom_row, 1, 1, 2);
  box->addLayout(grid);
  harmonic_ = new QCheckBox(tr("Harmonic imaging (THI)"));
  harmonic_->setObjectName(QStringLiteral("ultrasound-harmonic"));
  harmonic_->setToolTip(tooltip_of(
      Action::kHarmonic, tr("Receives the second harmonic: less haze and fewer side lobes, less penetration")));
  connect(harmonic_, &QCheckBox::clicked, this, [this](bool is_on) { view_.set_harmonic(is_on); });
  box->addWidget(harmonic_);
  add_check(*box, "ultrasound-mirror", tr("Marker on the left"),
            tr("Off: the image is mirrored; the green dot moves to the other side"),
            [](S& s) -> bool& { return s.display.is_mirrored; });
  add_check(*box, "ultrasound-rolling", tr("Rolling frame update"),
            tr("While you move, each image renews a quarter of the scanlines, as in a scanner; off: whole frames"),
            [](S& s) -> bool& { return s.is_rolling; });
  return widget;
}

QWidget* UltrasoundControls::make_tgc() {
  QWidget* widget = nullptr;
  QVBoxLayout* box = make_section(widget, tr("Gain over depth (TGC)"));
  auto* grid = make_control_grid();
  grid->setVerticalSpacing(2);
  for (std::size_t n = 0; n < ultrasound::kTgcSliders; ++n) {
    const QByteArray name = QStringLiteral("ultrasound-tgc-%1").arg(n + 1).toLatin1();
    const QString label = n == 0 ? tr("near") : n + 1 == ultrasound::kTgcSliders ? tr("far") : QString();
    add_control(*grid, {name.constData(), label, tr("TGC slider %1 of 8, from near to far").arg(n + 1), -20, 20, 1,
                        [n](UltrasoundSettings& s) -> double& { return s.display.tgc_db[n]; }, decibels()});
  }
  box->addLayout(grid);
  return widget;
}

QWidget* UltrasoundControls::make_measuring() {
  QWidget* widget = nullptr;
  QVBoxLayout* box = make_section(widget, tr("Measure"));
  auto* grid = new QGridLayout;
  grid->setSpacing(6);
  const auto add = [&](int row, int column, const char* name, const QString& text, const QString& tooltip, auto act) {
    QPushButton* button = small_button(name, text, tooltip);
    connect(button, &QPushButton::clicked, this, act);
    grid->addWidget(button, row, column);
    return button;
  };
  const auto tool = [&](int column, const char* name, const QString& text, const QString& tooltip, MeasuringTool kind) {
    QPushButton* button = add(0, column, name, text, tooltip,
                              [this, kind](bool is_on) { view_.start_measuring(is_on ? kind : MeasuringTool::kNone); });
    button->setCheckable(true);
    tools_.push_back(button);
  };
  tool(0, "ultrasound-distance", tr("Distance"), tr("Click two points, or drag  (M)"), MeasuringTool::kDistance);
  tool(1, "ultrasound-ellipse", tr("Ellipse"), tr("Ends of one axis, then the width"), MeasuringTool::kEllipse);
  tool(2, "ultrasound-angle", tr("Angle"), tr("Vertex, then both arms"), MeasuringTool::kAngle);
  undo_ = add(1, 0, "ultrasound-undo", tr("Undo"), tr("Undo the last change  (Ctrl+Z, redo Ctrl+Shift+Z)"),
              [this] { view_.undo_measurement(); });
  remove_ =
      add(1, 1, "ultrasound-delete", tr("Delete"), tr("Delete the selected measurement, otherwise the last  (Delete)"),
          [this] { view_.remove_measurement(); });
  clear_ =
      add(1, 2, "ultrasound-clear", tr("Clear"), tr("Delete all measurements"), [this] { view_.clear_measurements(); });
  box->addLayout(grid);
  return widget;
}

QWidget* UltrasoundControls::make_guide() {
  QWidget* widget = nullptr;
  QVBoxLayout* box = make_section(widget, tr("Needle"));
  axis_ = new QCheckBox(tr("Show the needle's path"));
  axis_->setObjectName(QStringLiteral("ultrasound-axis"));
  axis_->setAccessibleName(axis_->text());
  axis_->setToolTip(tr("The needle axis near the image plane, and a cross at its intersection"));
  connect(axis_, &QCheckBox::clicked, this, [this](bool is_on) { view_.set_guide_visible(is_on); });
  box->addWidget(axis_);
  using S = UltrasoundSettings;
  auto* bracket = add_check(*box, "ultrasound-guide", tr("Needle guide line"),
                            tr("A bracket that guides the needle into the image plane"),
                            [](S& s) -> bool& { return s.guide.is_shown; });
  connect(bracket, &QCheckBox::clicked, this, [this](bool is_on) {
    if (is_on) view_.set_guide_visible(true);
  });
  add_check(*box, "ultrasound-guide-side", tr("Guide on the marked side"), tr("The side of the green dot"),
            [](S& s) -> bool& { return s.guide.is_on_marked_side; });
  auto* grid = make_control_grid();
  add_control(
      *grid, {"ultrasound-guide-angle", tr("Angle"), tr("Angle between the guide and the central axis of the beam"), 10,
              80, 1, [](S& s) -> double& { return s.guide.angle_deg; },
              [](double deg) { return QStringLiteral("%L1°").arg(deg, 0, 'f', 0); }});
  box->addLayout(grid);
  guide_ = widget;
  return widget;
}

QWidget* UltrasoundControls::make_doppler() {
  QWidget* widget = nullptr;
  QVBoxLayout* box = make_section(widget, tr("Colour Doppler"));
  using S = UltrasoundSettings;
  doppler_ = add_check(*box, "ultrasound-doppler", tr("Show flow"), tr("Colour Doppler  (C); drag the box"),
                       [](S& s) -> bool& { return s.has_doppler; });
  doppler_controls_ = new QWidget;
  auto* controls = new QVBoxLayout(doppler_controls_);
  controls->setContentsMargins(0, 0, 0, 0);
  controls->setSpacing(6);
  auto* grid = make_control_grid();
  add_control(*grid, {"ultrasound-doppler-scale", tr("Scale"), tr("Velocity limit before aliasing (PRF)"), 2, 200, 1,
                      [](S& s) -> double& { return s.doppler.scale_cm_per_s; },
                      [](double cm_per_s) { return QStringLiteral("%L1 cm/s").arg(cm_per_s, 0, 'f', 0); }});
  add_control(*grid, {"ultrasound-doppler-baseline", tr("Baseline"), tr("Baseline shift"), -0.9, 0.9, 0.05,
                      [](S& s) -> double& { return s.doppler.baseline; },
                      [](double b) { return QStringLiteral("%L1 %").arg(100.0 * b, 0, 'f', 0); }});
  add_control(*grid, {"ultrasound-doppler-gain", tr("Gain"), tr("Colour gain: higher shows weaker flow, then noise"),
                      -40, 40, 1, [](S& s) -> double& { return s.doppler.gain_db; }, decibels()});
  controls->addLayout(grid);
  add_check(*controls, "ultrasound-doppler-invert", tr("Invert colours"), tr("Blue towards the transducer"),
            [](S& s) -> bool& { return s.doppler.is_inverted; });
  box->addWidget(doppler_controls_);
  return widget;
}

void UltrasoundControls::set_ranges() {
  const ultrasound::Transducer& t = view_.transducer();
  const auto set = [this](const char* name, double low, double high) {
    for (Control& control : controls_) {
      if (control.slider->objectName() != QLatin1String(name)) continue;
      const QSignalBlocker quiet(control.slider);
      control.slider->setRange(static_cast<int>(std::ceil(low / control.step - 1e-9)),
                               static_cast<int>(std::floor(high / control.step + 1e-9)));
    }
  };
  set("ultrasound-depth", 20.0, t.greatest_depth_mm);
  set("ultrasound-focus", 5.0, view_.settings().acquisition.depth_mm);
  set("ultrasound-frequency", t.lowest_mhz, t.highest_mhz);
}

void UltrasoundControls::show_view() {
  set_ranges();
  UltrasoundSettings settings = view_.settings();
  for (Control& control : controls_) {
    const double value = control.number(settings);
    const QSignalBlocker quiet(control.slider);
    control.slider->setValue(static_cast<int>(std::lround(value / control.step)));
    control.value->setText(control.text(value));
  }
  for (Check& check : checks_) check.box->setChecked(check.flag(settings));
  gray_map_->setCurrentIndex(gray_map_->findText(shown(ultrasound::name_of(settings.display.gray_map))));
  transducer_->setCurrentIndex(transducer_->findText(to_qt(view_.transducer().name)));
  engine_->setEnabled(view_.has_panorama());
  engine_->setCurrentIndex(settings.is_panorama && view_.has_panorama() ? 1 : 0);
  // A preset belongs to one transducer.
  const int preset = preset_->currentIndex();
  if (preset > 0 && presets_[static_cast<std::size_t>(preset - 1)].transducer != view_.transducer().name)
    preset_->setCurrentIndex(0);
  for (QPushButton* button : {zoom_out_, zoom_reset_}) button->setEnabled(view_.zoom().factor > 1.0);
  const ultrasound::CineState cine = view_.cine();
  automatic_->setChecked(settings.is_gain_automatic);
  freeze_->setChecked(cine.is_frozen);
  freeze_->setText(cine.is_frozen ? tr("Frozen") : tr("Freeze"));
  cine_row_->setVisible(cine.is_frozen);
  play_->setChecked(cine.is_playing);
  {
    const QSignalBlocker quiet(cine_);
    cine_->setRange(0, std::max(0, cine.size - 1));
    if (!cine_->isSliderDown()) cine_->setValue(std::max(0, cine.position));
  }
  constexpr MeasuringTool kTools[] = {MeasuringTool::kDistance, MeasuringTool::kEllipse, MeasuringTool::kAngle};
  for (std::size_t n = 0; n < tools_.size(); ++n) tools_[n]->setChecked(view_.measuring_tool() == kTools[n]);
  undo_->setEnabled(view_.measurements().can_undo());
  remove_->setEnabled(!view_.measurements().items().empty());
  clear_->setEnabled(!view_.measurements().items().empty());
  guide_->setEnabled(view_.is_guide_offered());
  axis_->setChecked(view_.is_guide_visible() && view_.is_guide_offered());
  doppler_->setEnabled(view_.has_flow());
  harmonic_->setEnabled(view_.has_harmonic());
  harmonic_->setChecked(settings.acquisition.is_harmonic);
  doppler_controls_->setVisible(settings.has_doppler);
}

}  // namespace trocar::trainer
