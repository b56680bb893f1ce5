#include "views/xray/xray_view.h"

#include <QCoreApplication>
#include <QMouseEvent>
#include <QPainter>
#include <QWheelEvent>
#include <algorithm>
#include <cmath>
#include <utility>

#include "cases/imaging.h"
#include "core/files/folders.h"
#include "core/log.h"
#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

constexpr const char* kUnit = "angiography";
constexpr double kTurn_deg_per_px = 0.3;
constexpr double kCaptionMargin_px = 10.0;
constexpr double kLeastCollimation = 0.1;
constexpr double kMostTable_mm = 150.0;

xray::CArmPreset load_unit() {
  auto unit = xray::load_c_arm(data_dir() / "carms.toml", kUnit);
  if (unit) return *std::move(unit);
  log_warning("{}", unit.error().text());
  xray::CArmPreset plain;
  plain.fields_mm = {plain.arm.field_mm};
  return plain;
}

/// With a dark edge, so that it can be read on bright parts of the image.
void draw_outlined_text(QPainter& painter, const QRectF& area, int flags, const QString& text) {
  const QPen pen = painter.pen();
  painter.setPen(Qt::black);
  for (const double x : {-1.5, 0.0, 1.5})
    for (const double y : {-1.5, 0.0, 1.5}) painter.drawText(area.translated(x, y), flags, text);
  painter.setPen(pen);
  painter.drawText(area, flags, text);
}

QString angle_text(double degrees, const QString& positive, const QString& negative) {
  return QStringLiteral("%L1 %L2°").arg(degrees < 0.0 ? negative : positive).arg(std::abs(degrees), 0, 'f', 0);
}

}  // namespace

XrayView::XrayView(QWidget* parent) : QWidget(parent), unit_(load_unit()) {
  setObjectName(QStringLiteral("xray-view"));
  setAccessibleName(tr("X-ray picture"));
  setAttribute(Qt::WA_OpaquePaintEvent);
  setFocusPolicy(Qt::StrongFocus);
  settings_.arm = unit_.arm;
  settings_.filters = {unit_.kv, unit_.aluminium_mm, unit_.copper_mm};
  QCoreApplication::instance()->installEventFilter(this);  // for the keys that are held
}

XrayView::~XrayView() = default;

void XrayView::show_patient(std::shared_ptr<const anatomy::VirtualPatient> patient, const tasks::Needle& needle,
                            std::function<Vec3()> find_middle_P) {
  needle_ = needle;
  patient_ = std::move(patient);
  find_middle_P_ = std::move(find_middle_P);
  retired_.retire(std::exchange(preparing_, {}));
  prepared_.reset();
  failure_.clear();
  fluoroscope_.reset();
  contrast_.close();
  is_contrast_open_ = false;
  shaft_P_.clear();
  clear_examination();
}

void XrayView::clear_examination() {
  end_replay();
  frame_.reset();
  image_ = {};
  set_pedal(false);
  set_injecting(false);
  opened_s_ = -1.0;
  change_settings([&](XraySettings& s) {
    s.table_mm = 0.0;
    s.arm = unit_.arm;
    if (prepared_) s.arm.isocentre_P = prepared_->middle_P;
    s.mode = xray::ImageMode::kLive;
  });
  setToolTip(tr("Left button: moves the table; right button: turns the C-arm; wheel: field"));
  update();
}

void XrayView::begin() {
  clear_examination();
  if (!prepared_) return;
  fluoroscope_->open(prepared_->volume);
  const auto agent = contrast_.states().value();
  if (!is_contrast_open_ || (agent && agent->injected_ml > 0.0)) open_contrast();
}

void XrayView::open_contrast() {
  contrast_.open(patient_, prepared_->blood);
  is_contrast_open_ = true;
}

xray::LiveFluoroscopeOptions XrayView::fluoroscope_options() const {
  xray::LiveFluoroscopeOptions options = xray::default_live_fluoroscope_options();
  options.detector.scintillator_mm = unit_.detector_mm;
  return options;
}

void XrayView::prepare() {
  if (prepared_ || !failure_.isEmpty() || !patient_) return;
  if (!preparing_.has_work()) {
    preparing_ =
        BackgroundJob<Prepared>([patient = patient_, middle_P = find_middle_P_](const Progress&) -> Result<Prepared> {
          TROCAR_TRY(auto volume, xray::XrayVolume::make(patient));
          TROCAR_TRY(const std::filesystem::path tables, checked_data_dir());
          TROCAR_TRY(xray::ToolKind wire, xray::load_tool_kind(tables / "xray_tools.toml", "fine-wire"));
          return Prepared{std::move(volume), middle_P(), cases::contrast_blood(*patient),
                          xray::make_duct_tree(*patient), std::move(wire)};
        });
    return;
  }
  auto made = preparing_.take();
  if (!made) return;
  if (*made) {
    prepared_ = **std::move(made);
    fluoroscope_ = std::make_unique<xray::LiveFluoroscope>(fluoroscope_options());
    fluoroscope_->open(prepared_->volume);
    if (!replay_ || !replay_->moment)
      change_settings([&](XraySettings& s) { s.arm.isocentre_P = prepared_->middle_P; });
    if (!replay_) open_contrast();
  } else {
    failure_ = shown(made->error().text());
  }
  update();
}

void XrayView::advance(double now_s) {
  retired_.sweep();
  if (!isVisible() || !patient_) return;
  if (opened_s_ < 0.0) opened_s_ = now_s;
  prepare();
  if (prepared_) replay_ ? advance_replay() : advance_live(now_s - opened_s_);
}

void XrayView::advance_live(double now_s) {
  contrast_.request({shaft_P_.empty() ? Vec3(Vec3::Constant(NAN)) : motion_.to_rest(shaft_P_.back()),
                     is_injecting() && !shaft_P_.empty() ? settings_.injection_ml_per_s : 0.0});
  xray::FluoroscopyRequest request = make_request(shaft_P_, is_injecting());
  if (const auto agent = contrast_.states().value()) {
    request.iodine = agent->iodine;
    if (is_injecting() && !request.tools.empty())
      request.tools.front().filling_iodine_mg_per_ml = agent->iodine_mg_per_ml;
  }
  request.is_pedal_down = is_pedal_down_;
  request.time_s = now_s;
  fluoroscope_->request(std::move(request));
  take(fluoroscope_->frames().value(), fluoroscope_->error());
}

void XrayView::take(std::shared_ptr<const xray::FluoroscopyFrame> newest, const std::optional<Error>& error) {
  const QString failure = error ? shown(error->text()) : QString();
  const bool is_new = newest && (!frame_ || newest->number != frame_->number);
  if (is_new) {
    frame_ = std::move(newest);
    const image::GrayImage& gray = frame_->gray;
    image_ = QImage(gray.pixels.data(), gray.columns, gray.rows, gray.columns, QImage::Format_Grayscale8);
  }
  if (is_new || std::exchange(failure_, failure) != failure) update();
}

xray::FluoroscopyRequest XrayView::make_request(std::span<const Vec3> shaft_P, bool is_injecting) const {
  xray::FluoroscopyRequest request;
  request.arm = settings_.arm;
  request.motion = motion_;
  request.filters = settings_.filters;
  // At the dose of fluoroscopy a subtraction is mostly noise.
  request.dose_mode =
      settings_.mode == xray::ImageMode::kSubtraction ? xray::DoseMode::kAcquisition : settings_.dose_mode;
  request.pulses_per_s = settings_.pulses_per_s;
  if (shaft_P.size() > 1) {
    xray::ToolShape needle;
    needle.name = needle_.name;
    needle.line_P.assign(shaft_P.begin(), shaft_P.end());
    needle.outer_radius_mm = 0.5 * needle_.outer_diameter_mm;
    // Without its stylet the bore is full of bile, blood or contrast agent.
    const bool is_open = needle_.stylet_diameter_mm <= 0.0 || is_injecting;
    needle.inner_radius_mm = is_open ? 0.5 * needle_.inner_diameter_mm : 0.0;
    request.tools.push_back(std::move(needle));
  }
  if (wire_P_ && prepared_) request.tools.push_back(make_wire());
  request.mode = settings_.mode;
  request.display.is_inverted = settings_.is_inverted;
  return request;
}

/// It lies in the needle's channel and then follows the duct.
xray::ToolShape XrayView::make_wire() const {
  constexpr double kBehindTip_mm = 120.0;  // out of the skin, for all paths of the tasks
  const Vec3 axis_P = wire_P_->direction();
  std::vector<Vec3> points_P{wire_P_->a - kBehindTip_mm * axis_P};
  const Vec3 begin_A = motion_.to_rest(wire_P_->a);
  const Vec3 axis_A = motion_.line_to_rest(begin_A, axis_P).normalized();
  for (const Vec3& point_A : xray::guide_wire_way(prepared_->ducts, begin_A, axis_A, wire_P_->length_mm()))
    points_P.push_back(motion_.to_now(point_A));
  return xray::tool_along(prepared_->wire, points_P);
}

void XrayView::change_settings(const std::function<void(XraySettings&)>& change) {
  const double table_mm = settings_.table_mm;
  change(settings_);
  settings_.table_mm = std::clamp(settings_.table_mm, -kMostTable_mm, kMostTable_mm);
  // The patient goes up with the table: the isocentre goes towards what is below in him.
  settings_.arm.isocentre_P +=
      (settings_.table_mm - table_mm) * (patient_ ? anatomy::gravity_P(patient_->posture) : Vec3(Vec3::UnitY()));
  xray::CArm& arm = settings_.arm;
  arm.lao_deg = std::clamp(arm.lao_deg, -unit_.largest_lao_deg, unit_.largest_lao_deg);
  arm.cranial_deg = std::clamp(arm.cranial_deg, -unit_.largest_cranial_deg, unit_.largest_cranial_deg);
  for (double& share : arm.collimation) share = std::clamp(share, kLeastCollimation, 1.0);
  update();
  Q_EMIT changed();
}

void XrayView::set_pedal(bool is_down) {
  is_down = is_down && !replay_;
  if (std::exchange(is_pedal_down_, is_down) != is_down) Q_EMIT changed();
  update();
}

void XrayView::set_injection_hindrance(const QString& reason) {
  injection_hindrance_ = reason;
  if (!reason.isEmpty()) set_injecting(false);
}

void XrayView::set_injecting(bool is_injecting) {
  is_injecting = is_injecting && !replay_;
  if (is_injecting && !injection_hindrance_.isEmpty()) {
    Q_EMIT injection_refused(injection_hindrance_);
    return;
  }
  if (std::exchange(is_injecting_, is_injecting) != is_injecting) Q_EMIT changed();
}

tasks::XrayUse XrayView::use() const {
  if (replay_) return replay_->moment ? replay_->moment->use : tasks::XrayUse{};
  tasks::XrayUse use;
  const xray::CArm& arm = settings_.arm;
  use.lao_deg = arm.lao_deg;
  use.cranial_deg = arm.cranial_deg;
  use.isocentre_P = arm.isocentre_P;
  use.field_mm = arm.field_mm;
  use.is_beam_on = frame_ != nullptr && !frame_->is_held;
  if (const auto state = contrast_.states().value()) use.contrast_ml = state->injected_ml;
  if (!frame_) return use;
  use.beam_s = frame_->dose.beam_on_s;
  use.air_kerma_mgy = frame_->dose.air_kerma_mgy;
  use.dose_area_gycm2 = 1e-3 * frame_->dose.area_product_mgy_cm2;
  return use;
}

QRectF XrayView::image_rect() const {
  const double edge = std::min(width(), height());
  return {0.5 * (width() - edge), 0.5 * (height() - edge), edge, edge};
}

QString XrayView::message() const {
  if (!failure_.isEmpty()) return failure_;
  if (!patient_) return tr("No patient");
  if (!prepared_) return tr("Preparing the X-ray");
  if (replay_) return replay_message();
  return frame_ ? QString() : tr("Hold Z or the pedal for fluoroscopy");
}

void XrayView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), Qt::black);
  painter.setRenderHint(QPainter::SmoothPixmapTransform);
  if (!image_.isNull() && frame_) painter.drawImage(image_rect(), image_);
  draw_texts(painter);
}

void XrayView::draw_texts(QPainter& painter) const {
  const QRectF area =
      QRectF(rect()).marginsRemoved({kCaptionMargin_px, kCaptionMargin_px, kCaptionMargin_px, kCaptionMargin_px});
  painter.setPen(QColor(214, 222, 230));
  if (const QString text = message(); !text.isEmpty())
    draw_outlined_text(painter, area, static_cast<int>(Qt::AlignCenter) | Qt::TextWordWrap, text);
  const xray::CArm& arm = settings_.arm;
  const QString position = angle_text(arm.lao_deg, tr("LAO"), tr("RAO")) + QLatin1Char('\n') +
                           angle_text(arm.cranial_deg, tr("CRAN"), tr("CAUD")) + QLatin1Char('\n') +
                           tr("Field %1 cm").arg(arm.field_mm / 10.0, 0, 'f', 0);
  draw_outlined_text(painter, area, Qt::AlignLeft | Qt::AlignBottom, position);
  if (!frame_ || (replay_ && !replay_->moment)) return;
  const tasks::XrayUse shown = use();
  const xray::Exposure& exposure = frame_->exposure;
  draw_outlined_text(painter, area, Qt::AlignLeft | Qt::AlignTop,
                     tr("%1 kV\n%2 mAs\n%3 pulses/s")
                         .arg(exposure.tube.kv, 0, 'f', 0)
                         .arg(exposure.mas, 0, 'f', 2)
                         .arg(settings_.pulses_per_s));
  QString use_text = tr("%1 s\n%2 mGy\n%3 Gy cm²")
                         .arg(shown.beam_s, 0, 'f', 1)
                         .arg(shown.air_kerma_mgy, 0, 'f', 2)
                         .arg(shown.dose_area_gycm2, 0, 'f', 2);
  if (shown.contrast_ml > 0.0) use_text.prepend(tr("Contrast %1 ml\n").arg(shown.contrast_ml, 0, 'f', 1));
  draw_outlined_text(painter, area, Qt::AlignRight | Qt::AlignBottom, use_text);
  draw_sides(painter);
  painter.setPen(is_held() ? QColor(150, 160, 172) : QColor(255, 196, 60));
  draw_outlined_text(painter, area, Qt::AlignRight | Qt::AlignTop, is_held() ? tr("Last image") : tr("● X-rays on"));
}

/// R and L, or A and P, at the image's edges: towards which side of the patient they lie.
void XrayView::draw_sides(QPainter& painter) const {
  const Vec3 right_P = xray::rays_of(settings_.arm).column_P.normalized();
  const bool is_lateral = std::abs(right_P.y()) > std::abs(right_P.x());
  const bool is_forward = is_lateral ? right_P.y() > 0.0 : right_P.x() > 0.0;  // LPS: +x left, +y posterior
  QString left = is_lateral ? tr("A", "anterior side of an X-ray image") : tr("R", "right side of the patient");
  QString right = is_lateral ? tr("P", "posterior side of an X-ray image") : tr("L", "left side of the patient");
  if (!is_forward) left.swap(right);
  const QRectF area = image_rect().marginsRemoved({kCaptionMargin_px, 0, kCaptionMargin_px, 0});
  QFont font = painter.font();
  font.setBold(true);
  painter.setFont(font);
  draw_outlined_text(painter, area, Qt::AlignLeft | Qt::AlignVCenter, left);
  draw_outlined_text(painter, area, Qt::AlignRight | Qt::AlignVCenter, right);
  font.setBold(false);
  painter.setFont(font);
}

void XrayView::mousePressEvent(QMouseEvent* event) {
  dragged_from_ = event->localPos();
}

void XrayView::mouseMoveEvent(QMouseEvent* event) {
  const QPointF by = event->localPos() - std::exchange(dragged_from_, event->localPos());
  if (replay_) return;
  if (event->buttons() & Qt::RightButton) {
    change_settings([&](XraySettings& s) {
      s.arm.lao_deg += kTurn_deg_per_px * by.x();
      s.arm.cranial_deg -= kTurn_deg_per_px * by.y();
    });
  } else if (event->buttons() & Qt::LeftButton) {
    const xray::CArm& arm = settings_.arm;
    const xray::XrayRays rays = xray::rays_of(arm);
    // The patient follows the pointer: the isocentre moves the other way.
    const double mm_per_px = arm.field_mm / xray::magnification(arm) / image_rect().width();
    const Vec3 shift_P = mm_per_px * (by.x() * rays.column_P.normalized() + by.y() * rays.row_P.normalized());
    change_settings([&](XraySettings& s) { s.arm.isocentre_P -= shift_P; });
  }
}

void XrayView::wheelEvent(QWheelEvent* event) {
  if (replay_) return event->ignore();
  const auto& fields = unit_.fields_mm;  // falling
  const auto at = std::min_element(fields.begin(), fields.end(), [&](double a, double b) {
    return std::abs(a - settings_.arm.field_mm) < std::abs(b - settings_.arm.field_mm);
  });
  const auto next = std::clamp<std::ptrdiff_t>(at - fields.begin() + (event->angleDelta().y() > 0 ? 1 : -1), 0,
                                               static_cast<std::ptrdiff_t>(fields.size()) - 1);
  change_settings([&](XraySettings& s) { s.arm.field_mm = fields[static_cast<std::size_t>(next)]; });
  event->accept();
}

void XrayView::hideEvent(QHideEvent* event) {
  QWidget::hideEvent(event);
  set_pedal(false);
  set_injecting(false);
}

}  // namespace trocar::trainer
