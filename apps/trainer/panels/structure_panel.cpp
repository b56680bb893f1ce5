#include "panels/structure_panel.h"

#include <QActionGroup>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QGridLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QMenu>
#include <QPainter>
#include <QScrollArea>
#include <QSignalBlocker>
#include <QSlider>
#include <QToolButton>
#include <QVBoxLayout>
#include <QWidgetAction>

#include "anatomy/structure_words.h"
#include "ui_kit/decimal_field.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"
#include "views/patient/patient_view.h"

namespace trocar::trainer {
namespace {

constexpr int kControlGap = 8;
constexpr int kSwatch = 12;
// Smaller padding than elsewhere, because many small controls are side by side.
constexpr const char* kSlim = "padding: 5px 3px;";
constexpr const char* kFlat = "background: transparent; border: none; padding: 3px;";

QString widget_name(const char* prefix, const std::string& structure) {
  return QString::fromLatin1(prefix) + to_qt(structure).replace(QLatin1Char('_'), QLatin1Char('-'));
}

/// Display text of "kidney_left".
QString shown_name(const std::string& structure) {
  QString name = shown(anatomy::structure_words(structure));
  if (!name.isEmpty()) name[0] = name[0].toUpper();
  return name;
}

/// A disc in the structure's colour; a ring if it is hidden.
QIcon swatch_icon(const image::Rgb& color, double ratio) {
  QIcon icon;
  for (const bool is_shown : {true, false}) {
    QPixmap pixmap(qRound(kSwatch * ratio), qRound(kSwatch * ratio));
    pixmap.setDevicePixelRatio(ratio);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    painter.setRenderHint(QPainter::Antialiasing);
    const QColor ink(color[0], color[1], color[2]);
    painter.setPen(QPen(ink, 1.5));
    painter.setBrush(is_shown ? QBrush(ink) : QBrush(Qt::NoBrush));
    painter.drawEllipse(QRectF(1, 1, kSwatch - 2, kSwatch - 2));
    painter.end();
    icon.addPixmap(pixmap, QIcon::Normal, is_shown ? QIcon::On : QIcon::Off);
  }
  return icon;
}

QToolButton* make_toggle(const char* name, const QString& text, const QString& tooltip, bool is_on) {
  QToolButton* button = make_tool_button(name, text, tooltip);
  button->setCheckable(true);
  button->setChecked(is_on);
  return button;
}

}  // namespace

StructurePanel::StructurePanel(PatientView& view, QWidget* parent) : QWidget(parent), view_(view) {
  setObjectName(QStringLiteral("structure-panel"));
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(kControlGap, kControlGap, kControlGap, kControlGap);
  layout->setSpacing(kControlGap);
  add_presets(*layout);
  auto* scroll = new QScrollArea(this);
  scroll->setObjectName(QStringLiteral("structure-list"));
  scroll->setWidgetResizable(true);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  auto* rows = new QWidget(scroll);
  list_ = new QVBoxLayout(rows);
  list_->setContentsMargins(0, 0, kControlGap, 0);
  list_->setSpacing(2);
  scroll->setWidget(rows);
  layout->addWidget(scroll, 1);
  add_volume(*layout);
  add_toggles(*layout);
  add_menus(*layout);
  connect(&view_, &PatientView::changed, this, &StructurePanel::refresh);
  rebuild();
}

void StructurePanel::add_presets(QBoxLayout& layout) {
  struct Choice {
    const char* name;
    QString text;
    QString tooltip;
    scene::StructurePreset preset;
  };
  const Choice choices[] = {
      {"preset-all", tr("All"), tr("Default visibility of all structures"), scene::StructurePreset::kAll},
      {"preset-skin", tr("Skin"), tr("Skin only"), scene::StructurePreset::kSkinOnly},
      {"preset-bones", tr("Bones"), tr("Bones and cartilage"), scene::StructurePreset::kBones},
      {"preset-vessels", tr("Vessels"), tr("Vessels and target, bones translucent"), scene::StructurePreset::kVessels},
      {"preset-target", tr("Target"), tr("The target and the organ around it"), scene::StructurePreset::kTarget},
  };
  auto* rows = new QGridLayout;
  rows->setSpacing(kControlGap / 2);
  constexpr int kInRow = 3;
  int place = 0;
  for (const Choice& choice : choices) {
    QToolButton* button = make_tool_button(choice.name, choice.text, choice.tooltip);
    button->setAccessibleName(choice.tooltip);
    connect(button, &QToolButton::clicked, this, [this, preset = choice.preset] {
      view_.apply_preset(preset);
      note_change();
    });
    button->setStyleSheet(QString::fromLatin1(kSlim));
    button->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
    rows->addWidget(button, place / kInRow, place % kInRow);
    ++place;
  }
  auto* steps = new QHBoxLayout;
  steps->setSpacing(kControlGap / 2);
  const auto walk = [this](void (StepHistory<Opacities>::*way)()) {
    (steps_.*way)();
    show_step();
  };
  undo_buttons_.emplace(
      "structure", *this, [=] { walk(&StepHistory<Opacities>::undo); }, [=] { walk(&StepHistory<Opacities>::redo); });
  undo_buttons_->add_to(*steps);
  rows->addLayout(steps, place / kInRow, place % kInRow);
  layout.addLayout(rows);
}

void StructurePanel::rebuild() {
  clear_layout(*list_);
  rows_.clear();
  for (const scene::StructureInfo& info : view_.structures()) add_row(info);
  list_->addStretch(1);
  dragged_ = nullptr;
  steps_.begin(opacities());
  refresh();
}

bool StructurePanel::is_outdated() const {
  return view_.structures().size() != rows_.size();
}

StructurePanel::Opacities StructurePanel::opacities() const {
  Opacities all;
  for (const scene::StructureInfo& info : view_.structures()) all[info.name] = info.opacity;
  return all;
}

void StructurePanel::note_change(const QSlider* slider) {
  Opacities next = opacities();
  const bool is_held = slider != nullptr && slider->isSliderDown();
  if (next != steps_.now()) {
    steps_.step_to(std::move(next), is_held && slider == dragged_);
    dragged_ = is_held ? slider : nullptr;
  }
  refresh();
}

void StructurePanel::show_step() {
  dragged_ = nullptr;
  for (const auto& [name, opacity] : steps_.now()) view_.set_opacity(name, opacity);
  refresh();
}

void StructurePanel::add_row(const scene::StructureInfo& info) {
  auto* line = new QWidget(list_->parentWidget());
  auto* layout = new QHBoxLayout(line);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(kControlGap);
  Row row{info, line, new QToolButton(line), new QSlider(Qt::Horizontal, line)};
  const QString name = shown_name(info.name);
  row.eye->setObjectName(widget_name("structure-eye-", info.name));
  row.eye->setCheckable(true);
  row.eye->setStyleSheet(QString::fromLatin1(kFlat));
  row.eye->setIcon(swatch_icon(info.color, devicePixelRatioF()));
  row.eye->setIconSize({kSwatch, kSwatch});
  row.eye->setChecked(info.opacity > 0.0);
  row.eye->setToolTip(tr("Show or hide %1 (Space)").arg(name));
  row.eye->setAccessibleName(tr("Show %1").arg(name));
  auto* label = make_label(info.is_derived ? tr("%1 (derived)").arg(name) : name, "", line);
  label->setToolTip(info.is_derived ? tr("%1: made by the program, not in the segmentation").arg(name) : name);
  label->setMinimumWidth(60);
  label->setWordWrap(true);
  row.slider->setObjectName(widget_name("structure-opacity-", info.name));
  row.slider->setRange(0, 100);
  row.slider->setValue(qRound(100.0 * info.opacity));
  row.slider->setFixedWidth(fontMetrics().averageCharWidth() * 10);
  row.slider->setToolTip(tr("Opacity of %1 (arrow keys)").arg(name));
  row.slider->setAccessibleName(tr("Opacity of %1").arg(name));
  layout->addWidget(row.eye);
  layout->addWidget(label, 1);
  layout->addWidget(row.slider);
  connect(row.slider, &QSlider::valueChanged, this, [this, structure = info.name, slider = row.slider](int percent) {
    view_.set_opacity(structure, percent / 100.0);
    note_change(slider);
  });
  connect(row.slider, &QSlider::sliderReleased, this, [this] { dragged_ = nullptr; });
  connect(row.eye, &QToolButton::toggled, this, [this, info](bool is_on) {
    view_.set_opacity(info.name, !is_on ? 0.0 : info.default_opacity > 0.0 ? info.default_opacity : 1.0);
    note_change();
  });
  list_->addWidget(line);
  rows_.push_back(row);
}

void StructurePanel::refresh() {
  const std::vector<scene::StructureInfo> structures = view_.structures();
  for (std::size_t i = 0; i < rows_.size() && !is_outdated(); ++i) {
    const QSignalBlocker quiet_slider(rows_[i].slider);
    const QSignalBlocker quiet_eye(rows_[i].eye);
    rows_[i].slider->setValue(qRound(100.0 * structures[i].opacity));
    rows_[i].eye->setChecked(structures[i].opacity > 0.0);
    if (rows_[i].line->isHidden() != structures[i].is_withheld) rows_[i].line->setVisible(!structures[i].is_withheld);
  }
  undo_buttons_->show(steps_.can_undo(), steps_.can_redo());
  const QSignalBlocker quiet_guidance(guidance_);
  const QSignalBlocker quiet_landmarks(landmarks_);
  // Without guidance in the scene, there is nothing to show.
  guidance_->setEnabled(view_.scene().guidance() != scene::Guidance::kNone);
  guidance_->setChecked(guidance_->isEnabled() && view_.is_guidance_visible());
  landmarks_->setChecked(view_.are_landmarks_visible());
}

void StructurePanel::add_volume(QBoxLayout& layout) {
  volume_ = new QComboBox(this);
  volume_->setObjectName(QStringLiteral("volume-preset"));
  volume_->setToolTip(tr("CT volume rendering (Up, Down)"));
  volume_->setAccessibleName(tr("CT volume"));
  volume_->addItems(
      {tr("Surfaces"), tr("CT: bone"), tr("CT: soft tissue"), tr("CT: vessels"), tr("CT: skin and bone")});
  connect(volume_, qOverload<int>(&QComboBox::currentIndexChanged), this,
          [this](int index) { view_.set_volume_preset(static_cast<scene::VolumePreset>(index)); });
  layout.addWidget(volume_);
}

void StructurePanel::add_toggles(QBoxLayout& layout) {
  const auto add_plane = [this](QBoxLayout& row, const char* name, const QString& text, const QString& tooltip,
                                bool scene::MprOptions::*plane) {
    QToolButton* button = make_toggle(name, text, tooltip, view_.mpr().*plane);
    button->setAccessibleName(tooltip);
    button->setStyleSheet(QString::fromLatin1(kSlim));
    connect(button, &QToolButton::toggled, this, [this, plane](bool is_on) {
      scene::MprOptions options = view_.mpr();
      options.*plane = is_on;
      view_.set_mpr(options);
    });
    row.addWidget(button);
  };
  layout.addWidget(make_label(tr("CT planes"), "dim", this));
  auto* planes = new QHBoxLayout;
  planes->setSpacing(kControlGap / 2);
  add_plane(*planes, "plane-long", tr("Along"), tr("CT plane along the needle"), &scene::MprOptions::has_long_plane);
  add_plane(*planes, "plane-cross", tr("Turned"), tr("CT plane along the needle, turned by 90°"),
            &scene::MprOptions::has_cross_plane);
  add_plane(*planes, "plane-tip", tr("Across"), tr("CT plane across the needle at its tip"),
            &scene::MprOptions::has_tip_plane);
  layout.addLayout(planes);

  auto* marks = new QHBoxLayout;
  marks->setSpacing(kControlGap / 2);
  guidance_ = make_toggle("show-guidance", tr("Guidance"),
                          tr("Path, entry zone and target, as permitted by the level of help (O)"),
                          view_.is_guidance_visible());
  landmarks_ =
      make_toggle("show-landmarks", tr("Landmarks"), tr("Landmarks with names (I)"), view_.are_landmarks_visible());
  connect(guidance_, &QToolButton::toggled, this, [this](bool is_on) { view_.set_guidance_visible(is_on); });
  connect(landmarks_, &QToolButton::toggled, this, [this](bool is_on) { view_.set_landmarks_visible(is_on); });
  for (QToolButton* button : {guidance_, landmarks_}) {
    button->setAccessibleName(button->text());
    marks->addWidget(button);
  }
  marks->addStretch(1);
  layout.addLayout(marks);
}

void StructurePanel::add_menus(QBoxLayout& layout) {
  auto* row = new QHBoxLayout;
  row->setSpacing(kControlGap / 2);
  const auto add = [&](const char* name, const QString& text, const QString& tooltip) {
    QToolButton* button = make_tool_button(name, text, tooltip);
    button->setAccessibleName(tooltip);
    button->setPopupMode(QToolButton::InstantPopup);
    auto* menu = new QMenu(button);
    button->setMenu(menu);
    row->addWidget(button);
    return menu;
  };
  fill_camera_menu(*add("camera-menu", tr("Camera ▾"), tr("Camera position")));
  fill_stereo_menu(*add("stereo-menu", tr("Stereo ▾"), tr("Stereo and mirror modes")));
  row->addStretch(1);
  layout.addLayout(row);
}

void StructurePanel::fill_camera_menu(QMenu& menu) {
  const std::tuple<QString, const char*, scene::CameraPreset> presets[] = {
      {tr("Anterior\t1"), "camera-anterior", scene::CameraPreset::kAnterior},
      {tr("Right oblique\t2"), "camera-oblique", scene::CameraPreset::kRightAnteriorOblique},
      {tr("Right\t3"), "camera-right", scene::CameraPreset::kRight},
      {tr("Left\t4"), "camera-left", scene::CameraPreset::kLeft},
      {tr("Posterior\t5"), "camera-posterior", scene::CameraPreset::kPosterior},
      {tr("Cranial\t6"), "camera-cranial", scene::CameraPreset::kCranial},
  };
  for (const auto& [text, name, preset] : presets) {
    QAction* action = menu.addAction(text, this, [this, p = preset] { view_.set_camera(p); });
    action->setObjectName(QString::fromLatin1(name));
  }
  menu.addSeparator();
  const std::tuple<QString, const char*, scene::FollowMode> modes[] = {
      {tr("Stay\tHome"), "follow-free", scene::FollowMode::kFree},
      {tr("Follow the tip\tT"), "follow-tip", scene::FollowMode::kTip},
      {tr("Look along the needle\tL"), "follow-along", scene::FollowMode::kAlongNeedle},
      {tr("Side view at the tip\tB"), "follow-side", scene::FollowMode::kSide},
  };
  for (const auto& [text, name, mode] : modes) {
    QAction* action = menu.addAction(text, this, [this, m = mode] {
      view_.set_follow(m);
      if (m == scene::FollowMode::kFree) view_.reset_camera();
    });
    action->setObjectName(QString::fromLatin1(name));
  }
}

void StructurePanel::fill_stereo_menu(QMenu& menu) {
  const auto change = [this](auto&& edit) {
    scene::StereoOptions options = view_.stereo();
    edit(options);
    view_.set_stereo(options);
  };
  auto* modes = new QActionGroup(&menu);
  const auto add_mode = [&](const QString& text, const char* name, scene::StereoMode mode) {
    QAction* action = menu.addAction(text, this, [=] { change([=](scene::StereoOptions& o) { o.mode = mode; }); });
    action->setObjectName(QString::fromLatin1(name));
    action->setCheckable(true);
    action->setChecked(view_.stereo().mode == mode);
    modes->addAction(action);
  };
  add_mode(tr("Mono"), "stereo-off", scene::StereoMode::kOff);
  add_mode(tr("Red-cyan glasses"), "stereo-anaglyph", scene::StereoMode::kAnaglyph);
  add_mode(tr("Side by side"), "stereo-side-by-side", scene::StereoMode::kSideBySide);
  add_mode(tr("Interlaced rows"), "stereo-interlaced", scene::StereoMode::kInterlaced);
  if (view_.has_quad_buffer()) add_mode(tr("Shutter glasses"), "stereo-shutter", scene::StereoMode::kQuadBuffer);
  menu.addSeparator();
  const auto add_switch = [&](const QString& text, const char* name, bool scene::StereoOptions::*field) {
    QAction* action = menu.addAction(text);
    action->setObjectName(QString::fromLatin1(name));
    action->setCheckable(true);
    action->setChecked(view_.stereo().*field);
    connect(action, &QAction::toggled, this,
            [=](bool is_on) { change([=](scene::StereoOptions& o) { o.*field = is_on; }); });
  };
  add_switch(tr("Swap eyes"), "stereo-swap", &scene::StereoOptions::swaps_eyes);
  add_switch(tr("Mirror left-right"), "mirror-left-right", &scene::StereoOptions::is_mirrored_left_right);
  add_switch(tr("Mirror up-down"), "mirror-up-down", &scene::StereoOptions::is_mirrored_up_down);
  const auto add_number = [&](const QString& prefix, const char* name, double low, double high, double step,
                              double scene::StereoOptions::*field) {
    auto* box = new DecimalField(&menu);
    box->setObjectName(QString::fromLatin1(name));
    box->setAccessibleName(prefix);
    box->setToolTip(prefix + tr(" (Up, Down)"));
    box->setPrefix(prefix + QStringLiteral("  "));
    box->setRange(low, high);
    box->setSingleStep(step);
    box->setValue(view_.stereo().*field);
    connect(box, qOverload<double>(&QDoubleSpinBox::valueChanged), this,
            [=](double value) { change([=](scene::StereoOptions& o) { o.*field = value; }); });
    auto* action = new QWidgetAction(&menu);
    action->setDefaultWidget(box);
    menu.addAction(action);
  };
  add_number(tr("Eye angle, degrees"), "stereo-angle", 0.0, 10.0, 0.5, &scene::StereoOptions::eye_angle_deg);
  add_number(tr("Focus shift"), "stereo-focus", -0.5, 1.0, 0.05, &scene::StereoOptions::focus_shift);
}

}  // namespace trocar::trainer
