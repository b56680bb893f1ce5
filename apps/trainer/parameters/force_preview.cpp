#include "parameters/force_preview.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QSignalBlocker>
#include <QVBoxLayout>
#include <algorithm>
#include <cmath>
#include <utility>

#include "anatomy/structure_words.h"
#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"
#include "views/plots/force_plot.h"

namespace trocar::trainer {
namespace {

constexpr std::size_t kMostAtWork = 2;  ///< Cancelled predictions that have not ended yet.

/// Points of force against tip depth, thinned to the resolution of the plot. While the tip moves back slightly at a
/// puncture, the largest depth is used.
std::vector<QPointF> shown_points(const std::vector<cases::CurvePoint>& curve) {
  constexpr double kStep_mm = 0.1, kStep_n = 0.02;
  std::vector<QPointF> points;
  for (const cases::CurvePoint& point : curve) {
    const QPointF next(points.empty() ? point.tip_mm : std::max(points.back().x(), point.tip_mm), point.force_n);
    if (!points.empty() && next.x() - points.back().x() < kStep_mm && std::abs(next.y() - points.back().y()) < kStep_n)
      continue;
    points.push_back(next);
  }
  return points;
}

QColor color_of(const anatomy::VirtualPatient& patient, const cases::PathPiece& piece) {
  for (const anatomy::Label& label : patient.label_table.labels)
    if (label.name == piece.name) return {label.color[0], label.color[1], label.color[2]};
  return {0xe0, 0xac, 0x8c};  // the skin's shell has no label
}

}  // namespace

ForcePreview::ForcePreview(QWidget* parent)
    : QWidget(parent),
      model_(new QComboBox),
      plot_(new ForcePlot),
      caption_(make_label({}, "dim")),
      refusal_(make_label({})) {
  model_->setObjectName(QStringLiteral("parameter-model"));
  model_->setAccessibleName(tr("Force model"));
  model_->setToolTip(tr("Force model of the prediction and of the hand  (Up, Down)"));
  model_->addItem(tr("Insertion (layers)"), QStringLiteral("insertion"));
  model_->addItem(tr("Proxy (CT and walls)"), QStringLiteral("proxy"));
  model_->addItem(tr("Combined"), QStringLiteral("combined"));
  connect(model_, QOverload<int>::of(&QComboBox::activated), this, [this] {
    request();
    Q_EMIT model_changed(model());
  });
  refusal_->setObjectName(QStringLiteral("parameter-preview-error"));
  refusal_->setWordWrap(true);
  refusal_->setStyleSheet(QStringLiteral("color: %1").arg(theme().bad.name()));
  refusal_->hide();
  show_busy(true);
  const int wide = caption_->sizeHint().width();
  show_busy(false);
  caption_->setMinimumWidth(std::max(wide, caption_->sizeHint().width()));
  plot_->set_curve_names(tr("default"), tr("as set"));
  plot_->setFixedHeight(184);
  plot_->setToolTip(tr("Predicted force along the planned path at 10 mm/s: dashed: default; solid: changed"));

  auto* row = new QHBoxLayout;
  row->addWidget(caption_);
  row->addWidget(model_, 1);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  layout->addLayout(row);
  layout->addWidget(plot_);
  layout->addWidget(refusal_);
}

ForcePreview::~ForcePreview() = default;

QString ForcePreview::model() const {
  return model_->currentData().toString();
}

const std::vector<cases::CurvePoint>& ForcePreview::default_curve() const {
  static const std::vector<cases::CurvePoint> none;
  const auto found = defaults_.find(to_std(model()));
  return found != defaults_.end() ? found->second : none;
}

void ForcePreview::show_case(std::shared_ptr<const cases::OpenCase> open_case) {
  case_ = std::move(open_case);
  retired_.retire(std::exchange(job_, {}));
  retired_.retire(std::exchange(default_job_, {}));
  settings_.clear();
  defaults_.clear();
  changed_.clear();
  is_wanted_ = false;
  if (case_) {
    const QSignalBlocker silent(model_);
    model_->setCurrentIndex(std::max(0, model_->findData(to_qt(case_->force_model))));
    defaults_[case_->force_model] = case_->predicted;
  }
  show_bands();
  request();
}

void ForcePreview::show_settings(std::vector<std::string> settings) {
  if (settings == settings_) return;
  settings_ = std::move(settings);
  request();
}

bool ForcePreview::offers(const QString& model) const {
  return model_->findData(model) >= 0;
}

void ForcePreview::choose_model(const QString& model) {
  const QSignalBlocker silent(model_);
  model_->setCurrentIndex(std::max(0, model_->findData(model)));
  request();
}

/// Discards the running prediction and requests a new one.
void ForcePreview::request() {
  retired_.retire(std::exchange(job_, {}));
  changed_.clear();
  is_wanted_ = case_ != nullptr;
  show_error({});
  show_busy(is_wanted_);
  if (case_ && settings_.empty() && !default_curve().empty()) {
    changed_ = default_curve();
    is_wanted_ = false;
    show_busy(false);
  }
  // The old curve is shown until the new one is ready.
  if (!case_ || !changed_.empty()) show_curves();
}

void ForcePreview::advance() {
  const std::size_t at_work = retired_.sweep();
  take_work();
  if (is_wanted_ && at_work < kMostAtWork) start_work();
}

void ForcePreview::start_work() {
  const std::string model = to_std(this->model());
  if (default_curve().empty()) {
    if (default_job_.has_work() && default_model_ == model) return;
    retired_.retire(std::exchange(default_job_, cases::predict_force_in_background(case_, {}, model)));
    default_model_ = model;
    return;  // the changed curve follows: two at once would delay both
  }
  is_wanted_ = false;
  if (settings_.empty()) {
    changed_ = default_curve();
    show_busy(false);
    show_curves();
    return;
  }
  job_ = cases::predict_force_in_background(case_, settings_, model);
}

void ForcePreview::take_work() {
  if (auto result = default_job_.take()) {
    default_job_ = {};
    if (*result) {
      defaults_[default_model_] = std::move(**result);
    } else if (default_model_ == to_std(model())) {
      is_wanted_ = false;
      show_curves();
      show_busy(false);
      show_error(shown(result->error().text()));
    }
  }
  if (auto result = job_.take()) {
    job_ = {};
    if (*result) changed_ = std::move(**result);
    show_curves();
    show_busy(false);
    show_error(*result ? QString() : shown(result->error().text()));
  }
}

void ForcePreview::show_curves() {
  const bool differs = !settings_.empty();
  plot_->set_predicted(differs ? shown_points(default_curve()) : std::vector<QPointF>());
  plot_->set_reference(shown_points(changed_));
}

void ForcePreview::show_bands() {
  std::vector<ForcePlot::Band> bands;
  if (case_)
    for (const cases::PathPiece& piece : case_->pieces)
      bands.push_back({piece.from_mm, piece.to_mm, shown(anatomy::structure_words(piece.name)),
                       color_of(*case_->the_case.patient, piece)});
  plot_->set_bands(std::move(bands));
}

void ForcePreview::show_busy(bool is_busy) {
  caption_->setText(is_busy ? tr("Predicting …") : tr("Force model"));
}

void ForcePreview::show_error(const QString& text) {
  refusal_->setText(text);
  refusal_->setVisible(!text.isEmpty());
}

}  // namespace trocar::trainer
