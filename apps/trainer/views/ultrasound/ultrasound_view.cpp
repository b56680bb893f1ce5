#include "views/ultrasound/ultrasound_view.h"

#include <QPaintEvent>
#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/files/folders.h"
#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "views/ultrasound/needle_marks.h"
#include "views/ultrasound/ultrasound_painter.h"

namespace trocar::trainer {
namespace {

/// Larger images are drawn scaled: speckle has no finer detail, and the servers need processor time.
constexpr double kMostPixels_px = 1280.0;
constexpr double kSmallHeight_px = 300.0, kSmallWidth_px = 340.0;
constexpr double kCountFor_s = 0.7;
constexpr double kSaveAfter_s = 1.0;
/// Distance from the face at which a needle in the bracket enters the skin.
constexpr double kBracket_mm = 8.0;
constexpr double kGuideStep_mm = 1.0;
constexpr int kEdgePoints = 48;

bool is_same(const ultrasound::ScanGeometry& a, const ultrasound::ScanGeometry& b) noexcept {
  return a.is_fan == b.is_fan && a.radius_mm == b.radius_mm && a.line_step == b.line_step && a.lines == b.lines &&
         a.depth_mm == b.depth_mm;
}

bool is_same(const ultrasound::CineState& a, const ultrasound::CineState& b) noexcept {
  return a.is_frozen == b.is_frozen && a.is_playing == b.is_playing && a.position == b.position && a.size == b.size;
}

/// Outline of the scan in the view.
QPainterPath outline_of(const ultrasound::ScanGeometry& scan, const PictureMap& map) {
  QPolygonF edge;
  const double last = scan.lines - 1;
  for (int n = 0; n <= kEdgePoints; ++n) edge << map.to_view(scan.to_cartesian({last * n / kEdgePoints, 0.0}));
  for (int n = kEdgePoints; n >= 0; --n)
    edge << map.to_view(scan.to_cartesian({last * n / kEdgePoints, scan.depth_mm}));
  QPainterPath path;
  path.addPolygon(edge);
  path.closeSubpath();
  return path;
}

/// Hatches the image plane outside a polygon, where there are no CT data.
void hatch_unscanned(QPainter& painter, const PictureMap& map, const std::vector<ultrasound::Vec2>& scanned_T) {
  QPolygonF scanned;
  for (const ultrasound::Vec2& corner_T : scanned_T) scanned << map.to_view(corner_T);
  QPainterPath hatched, seen;
  hatched.addRect(map.rect());
  seen.addPolygon(scanned);
  seen.closeSubpath();
  painter.fillPath(hatched.subtracted(seen), QBrush(QColor(58, 66, 78), Qt::BDiagPattern));
}

}  // namespace

UltrasoundView::UltrasoundView(QWidget* parent) : QWidget(parent) {
  setObjectName(QStringLiteral("ultrasound-view"));
  setAccessibleName(tr("Ultrasound picture"));
  setToolTip(QString());
  setFocusPolicy(Qt::StrongFocus);
  setMouseTracking(true);
  setAttribute(Qt::WA_OpaquePaintEvent);
  settings_ = default_settings(transducer_);
  make_shortcuts();
}

UltrasoundView::~UltrasoundView() {
  save_now();
}

void UltrasoundView::show_patient(std::shared_ptr<const ultrasound::AcousticScene> scene,
                                  std::shared_ptr<ultrasound::FlowOnDemand> flow,
                                  const ultrasound::Transducer& transducer,
                                  std::shared_ptr<ultrasound::PanoramaOnDemand> panorama) {
  save_now();
  scene_ = std::move(scene);
  flow_ = std::move(flow);
  panorama_ = std::move(panorama);
  transducer_ = transducer;
  output_.reset();
  if (auto output = ultrasound::load_acoustic_output(data_dir() / "transducers.toml", transducer_.name))
    output_ = *output;
  zoom_ = {};
  panned_from_.reset();
  settings_ = load_settings(transducer_);
  is_gain_wanted_ = settings_.is_gain_automatic;
  picture_.reset();
  image_ = QImage();
  measurements_ = {};
  forget_choice();
  marks_T_.clear();
  tool_ = MeasuringTool::kNone;
  frames_per_s_ = 0.0;
  counting_since_s_ = -1.0;
  if (scene_) scanner_.open(scene_, transducer_);
  update();
  Q_EMIT changed();
}

void UltrasoundView::set_scene(std::shared_ptr<const ultrasound::AcousticScene> scene) {
  if (!scene) return;
  scene_ = std::move(scene);
  scanner_.open(scene_, transducer_);
  update();
}

void UltrasoundView::choose_transducer(const ultrasound::Transducer& transducer) {
  if (!scene_ || transducer.name == transducer_.name) return;
  const bool is_panorama = settings_.is_panorama;
  show_patient(scene_, flow_, transducer, panorama_);
  change_settings([&](UltrasoundSettings& s) { s.is_panorama = is_panorama; });
}

void UltrasoundView::set_transducer_pose(const Pose& X_PT) {
  X_PT_ = X_PT;
}

void UltrasoundView::set_needle(std::span<const Vec3> shaft_P, double diameter_mm, double bore_share,
                                double tip_shift_mm) {
  const bool is_moved = !std::equal(shaft_P.begin(), shaft_P.end(), needle_shaft_P_.begin(), needle_shaft_P_.end());
  if (is_moved) needle_shaft_P_.assign(shaft_P.begin(), shaft_P.end());
  if (is_moved && is_guide_visible_) update();
  needle_diameter_mm_ = diameter_mm;
  needle_bore_share_ = bore_share;
  tip_shift_mm_ = tip_shift_mm;
}

void UltrasoundView::set_throw(const std::optional<Segment>& throw_P, const std::optional<Segment>& notch_P) {
  if (throw_P || throw_P_) update();
  throw_P_ = throw_P;
  notch_P_ = notch_P;
}

void UltrasoundView::advance(double now_s) {
  now_s_ = now_s;
  if (is_saving_wanted_ && now_s - changed_s_ > kSaveAfter_s) save_now();
  if (!scene_) return;
  take_picture(now_s);
  if (X_PT_) scanner_.request(make_request(now_s));
}

ultrasound::ScanRequest UltrasoundView::make_request(double now_s) {
  ultrasound::ScanRequest request;
  request.X_PT = *X_PT_;
  request.needle_shaft_P = needle_shaft_P_;
  request.needle_diameter_mm = needle_diameter_mm_;
  request.needle_bore_share = needle_bore_share_;
  request.tip_shift_mm = tip_shift_mm_;
  request.acquisition = settings_.acquisition;
  constexpr double kRollingShare = 0.25;
  request.renewed_share = settings_.is_rolling ? kRollingShare : 1.0;
  request.display = settings_.display;
  if (settings_.has_doppler) request.flow = poll_flow();
  if (settings_.is_panorama) request.panorama = poll_panorama();
  request.doppler = settings_.doppler;
  request.time_s = now_s;
  // A patient without a motion model breathes all the same: its blood flow shows that.
  request.motion = motion_.is_rest() ? motion::MotionClock{}.at(now_s) : motion_;
  const QSizeF size = layout_for(picture_ && is_frozen() ? picture_->scan : requested_scan()).picture.size();
  const double wanted_px = std::max(size.width(), size.height()) * devicePixelRatioF();
  const double scale = devicePixelRatioF() * std::min(1.0, kMostPixels_px / std::max(wanted_px, 1.0));
  request.columns = static_cast<int>(std::lround(size.width() * scale));
  request.rows = static_cast<int>(std::lround(size.height() * scale));
  return request;
}

/// Null while it is computed.
std::shared_ptr<const ultrasound::VesselFlow> UltrasoundView::poll_flow() {
  if (!has_flow()) return nullptr;
  std::shared_ptr<const ultrasound::VesselFlow> flow = flow_->poll();
  if (flow_->is_computing() && !std::exchange(is_flow_awaited_, true)) update();
  if (!has_flow()) {
    update();
    Q_EMIT changed();
  }
  return flow;
}

/// Null while it is loaded, and if that has failed: the image is ray cast then.
std::shared_ptr<const ultrasound::Panorama> UltrasoundView::poll_panorama() {
  if (!has_panorama()) return nullptr;
  std::shared_ptr<const ultrasound::Panorama> panorama = panorama_->poll();
  if (!has_panorama()) Q_EMIT changed();
  return panorama;
}

/// Why there is no colour although it is switched on; empty: there is.
QString UltrasoundView::flow_message() const {
  if (!settings_.has_doppler) return {};
  if (!has_flow()) return tr("No blood flow in this patient's vessels");
  return is_flow_awaited_ ? tr("Computing the blood flow") : QString();
}

void UltrasoundView::take_picture(double now_s) {
  std::shared_ptr<const ultrasound::ScanPicture> newest = scanner_.pictures().value();
  const ultrasound::CineState cine = scanner_.cine();
  const bool is_state_new = !is_same(cine, shown_cine_);
  const bool is_freezing_new = cine.is_frozen != shown_cine_.is_frozen || cine.is_playing != shown_cine_.is_playing;
  shown_cine_ = cine;
  if (newest && newest != picture_) {
    count_picture(now_s, !newest->is_frozen);
    picture_ = std::move(newest);
    const ultrasound::ScanPicture& p = *picture_;
    if (!p.colour.pixels.empty()) is_flow_awaited_ = false;
    if (p.colour.pixels.empty()) {
      image_ = QImage(p.gray.pixels.data(), p.gray.columns, p.gray.rows, p.gray.columns, QImage::Format_Grayscale8);
    } else {
      image_ = QImage(p.colour.pixels.front().data(), p.colour.columns, p.colour.rows, 3 * p.colour.columns,
                      QImage::Format_RGB888);
    }
    adjust_gain();
    update();
  } else if (picture_) {
    count_picture(now_s, false);
  }
  if (is_state_new && cine.is_frozen) update();
  if (is_freezing_new || (is_state_new && cine.is_frozen)) Q_EMIT changed();
}

void UltrasoundView::count_picture(double now_s, bool is_live) {
  if (counting_since_s_ < 0.0) counting_since_s_ = now_s;
  counted_ += is_live ? 1 : 0;
  const double counted_s = now_s - counting_since_s_;
  if (counted_s < kCountFor_s) return;
  frames_per_s_ = counted_ / counted_s;
  counted_ = 0;
  counting_since_s_ = now_s;
}

void UltrasoundView::set_guide_offered(bool is_offered) {
  if (std::exchange(is_guide_offered_, is_offered) == is_offered) return;
  update();
  Q_EMIT changed();
}

void UltrasoundView::set_guide_visible(bool is_visible) {
  if (std::exchange(is_guide_visible_, is_visible) == is_visible) return;
  update();
  Q_EMIT changed();
}

void UltrasoundView::set_settings(const UltrasoundSettings& settings) {
  UltrasoundSettings held = within_ranges(settings, transducer_);
  if (held == settings_) return;
  settings_ = std::move(held);
  is_saving_wanted_ = true;
  changed_s_ = now_s_;
  update();
  Q_EMIT changed();
}

void UltrasoundView::change_settings(const std::function<void(UltrasoundSettings&)>& change) {
  UltrasoundSettings settings = settings_;
  change(settings);
  set_settings(settings);
}

void UltrasoundView::reset_settings() {
  UltrasoundSettings settings = default_settings(transducer_);
  settings.is_panorama = settings_.is_panorama;
  set_settings(settings);
}

void UltrasoundView::save_now() {
  if (std::exchange(is_saving_wanted_, false)) save_settings(transducer_, settings_);
}

void UltrasoundView::set_frozen(bool is_frozen) {
  scanner_.set_frozen(is_frozen);
  // Measurements belong to the previous image.
  if (!is_frozen) {
    measurements_.clear();
    forget_choice();
  }
  update();
  Q_EMIT changed();
}

void UltrasoundView::step_cine(int frames) {
  scanner_.step_cine(frames);
}

void UltrasoundView::show_cine(int index) {
  scanner_.show_cine(index);
}

void UltrasoundView::play_cine(bool is_playing) {
  scanner_.play_cine(is_playing);
}

ultrasound::ScanGeometry UltrasoundView::requested_scan() const {
  const ultrasound::Acquisition& a = settings_.acquisition;
  return ultrasound::make_scan_geometry(transducer_, a.depth_mm, a.lines, a.samples);
}

std::optional<PictureMap> UltrasoundView::picture_map() const {
  if (!picture_) return std::nullopt;
  return PictureMap(layout_for(picture_->scan).picture, picture_->raster, zoom_);
}

void UltrasoundView::set_zoom(const PictureZoom& zoom) {
  const PictureZoom held = zoom.factor > 1.0 ? zoom : PictureZoom{};
  if (zoom_ == held) return;
  zoom_ = held;
  update();
  Q_EMIT changed();
}

void UltrasoundView::zoom_at(const QPointF& place, double factor) {
  if (const auto map = picture_map()) set_zoom(map->zoomed_at(place, factor));
}

void UltrasoundView::zoom_by_steps(int by) {
  constexpr double kStep = 1.25;
  if (const auto map = picture_map()) zoom_at(map->area().center(), zoom_.factor * std::pow(kStep, by));
}

void UltrasoundView::reset_zoom() {
  set_zoom({});
}

MarginSpace UltrasoundView::room() const {
  MarginSpace room;
  const bool is_small = height() < kSmallHeight_px || width() < kSmallWidth_px;
  const QFont font = caption_font(is_small);
  room.scale_width = QFontMetricsF(font).horizontalAdvance(QStringLiteral("20")) + 12.0;
  if (picture_) {
    const CaptionFacts facts{to_qt(transducer_.name), 88.0, {}, measurements_.items(), is_small, output_};
    std::vector<CaptionLine> lines = caption_of(*picture_, facts);
    // Space for optional texts, so that the image does not move.
    std::erase_if(lines, [](const CaptionLine& line) {
      return line.kind == CaptionLine::Kind::kWarning || line.kind == CaptionLine::Kind::kFrozen;
    });
    lines.push_back({tr("Poor contact"), CaptionLine::Kind::kWarning});
    lines.push_back({tr("Outside CT"), CaptionLine::Kind::kWarning});
    if (!is_small && picture_->is_frozen) lines.push_back({QStringLiteral("8"), CaptionLine::Kind::kPlain});
    room.caption = caption_size(lines, font);
  }
  if (!is_small) room.bars = bars_size(font, height(), picture_ && picture_->doppler_scale_cm_per_s > 0.0);
  return room;
}

const UltrasoundLayout& UltrasoundView::layout_for(const ultrasound::ScanGeometry& scan) const {
  const MarginSpace wanted = room();
  const LayoutKey key{QSizeF(size()), wanted.caption, wanted.bars, scan};
  const bool is_known = layout_key_ && layout_key_->view == key.view && layout_key_->caption == key.caption &&
                        layout_key_->bars == key.bars && is_same(layout_key_->scan, scan);
  if (!is_known) {
    layout_ = lay_out(key.view, scan, wanted);
    layout_key_ = key;
  }
  return layout_;
}

/// The bracket's line through the scan, clipped to the scan.
std::vector<ultrasound::Vec2> UltrasoundView::guide_line_T() const {
  const NeedleGuide& guide = settings_.guide;
  const ultrasound::ScanGeometry& scan = picture_->scan;
  const double side = guide.is_on_marked_side ? 1.0 : -1.0;
  const ultrasound::Vec2 end_T = scan.line_origin(guide.is_on_marked_side ? scan.lines - 1 : 0);
  const double angle = radians(guide.angle_deg);
  const ultrasound::Vec2 start_T = end_T + ultrasound::Vec2(side * kBracket_mm, 0.0);
  const ultrasound::Vec2 along_T(-side * std::sin(angle), std::cos(angle));
  std::vector<ultrasound::Vec2> line_T;
  for (double s = 0.0; s <= 2.0 * scan.depth_mm; s += kGuideStep_mm) {
    const ultrasound::Vec2 p_T = start_T + s * along_T;
    line_T.push_back(ultrasound::shown_place_T(*picture_, picture_->X_PT * Vec3(p_T.x(), p_T.y(), 0.0)));
  }
  return line_T;
}

QString UltrasoundView::waiting_text() const {
  if (scene_) return tr("Waiting for the first image");
  return transducer_.name.empty() ? tr("No patient") : tr("Preparing the ultrasound");
}

void UltrasoundView::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.fillRect(rect(), Qt::black);
  painter.setRenderHint(QPainter::Antialiasing);
  const bool is_small = height() < kSmallHeight_px || width() < kSmallWidth_px;
  if (!picture_) {
    painter.setFont(caption_font(is_small));
    painter.setPen(theme().dim);
    painter.drawText(rect(), Qt::AlignCenter, waiting_text());
    return;
  }
  const UltrasoundLayout& layout = layout_for(picture_->scan);
  const PictureMap map(layout.picture, picture_->raster, zoom_);
  const bool is_exact = std::abs(map.rect().width() * devicePixelRatioF() - picture_->raster.columns) < 1.0;
  painter.setRenderHint(QPainter::SmoothPixmapTransform, !is_exact);
  painter.save();
  painter.setClipRect(map.area());
  painter.drawImage(map.rect(), image_);
  painter.restore();

  ultrasound::ScanCaption caption;
  caption.focus_mm = picture_->acquisition.focus_mm;
  caption.settings = picture_->display;
  const ultrasound::ScanAnnotation annotation =
      ultrasound::make_scan_annotation(picture_->raster, picture_->scan, caption);
  const QFont font = caption_font(is_small);
  const CaptionFacts facts{
      to_qt(transducer_.name), frames_per_s_, shown_cine_, measurements_.items(), is_small, output_, zoom_.factor};
  draw_caption(painter, layout.caption, caption_of(*picture_, facts), font, map.is_magnified());
  draw_depth_scale(painter, map, layout.scale_x, annotation, font);
  if (!layout.bars.isEmpty()) draw_bars(painter, layout.bars, annotation, *picture_, font);

  painter.save();
  if (map.is_magnified()) painter.setClipRect(map.area());
  painter.setClipPath(outline_of(picture_->scan, map), map.is_magnified() ? Qt::IntersectClip : Qt::ReplaceClip);
  if (picture_->unscanned_share > 0.0) hatch_unscanned(painter, map, picture_->scanned_T);
  const bool has_guide = is_guide_visible_ && is_guide_offered_;
  if (has_guide && settings_.guide.is_shown) draw_guide(painter, map, guide_line_T());
  if (has_guide) draw_needle_axis(painter, map, *picture_, needle_shaft_P_);
  if (throw_P_) draw_throw(painter, map, *picture_, *throw_P_, notch_P_);
  painter.restore();
  if (const QString message = flow_message(); !message.isEmpty()) draw_message(painter, map.area(), message, font);
  if (map.is_magnified()) painter.setClipRect(map.area());
  draw_measurements(painter, map, measurements_.items(), chosen_);
  if (tool_ != MeasuringTool::kNone)
    draw_unfinished(painter, map, marks_T_, hover_T_, tool_ == MeasuringTool::kEllipse, tool_ == MeasuringTool::kAngle,
                    live_result());
}

}  // namespace trocar::trainer
