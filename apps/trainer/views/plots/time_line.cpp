#include "views/plots/time_line.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QLocale>
#include <QToolButton>
#include <algorithm>
#include <cmath>

#include "ui_kit/action_table.h"
#include "ui_kit/parts.h"
#include "views/plots/player_icons.h"

namespace trocar::trainer {
namespace {

constexpr double kStep_s = 0.1;
constexpr double kLongStep_s = 1.0;
constexpr double kSame_s = 1e-3;  ///< Within one tick of the recording: the same time as the event.

QString clock_text(double time_s) {
  const auto tenths = std::llround(10.0 * time_s);
  return QStringLiteral("%1:%2%3%4")
      .arg(tenths / 600)
      .arg(tenths / 10 % 60, 2, 10, QLatin1Char('0'))
      .arg(QLocale().decimalPoint())
      .arg(tenths % 10);
}

}  // namespace

const std::vector<double>& TimeLine::speeds() {
  static const std::vector<double> kSpeeds{0.25, 0.5, 1.0, 2.0, 4.0, 8.0};
  return kSpeeds;
}

TimeLine::TimeLine(QWidget* parent)
    : QWidget(parent), track_(new TimeTrack), speed_(new QComboBox), label_(make_label({}, "dim")) {
  setObjectName(QStringLiteral("time-line"));
  setAccessibleName(tr("Replay"));
  setFocusPolicy(Qt::StrongFocus);
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(8, 4, 8, 4);
  row->setSpacing(4);
  setLayout(row);
  play_ = add_button("time-play", {}, tr("Play and pause (Space)"));
  previous_ = add_button("time-previous", {}, tr("Previous event (P)"));
  next_ = add_button("time-next", {}, tr("Next event (N)"));
  play_->setIcon(player_icon(PlayerIcon::kPlay));
  previous_->setIcon(player_icon(PlayerIcon::kPrevious));
  next_->setIcon(player_icon(PlayerIcon::kNext));
  row->addWidget(track_, 1);
  label_->setObjectName(QStringLiteral("time-label"));
  label_->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
  label_->setMinimumWidth(QFontMetrics(label_->font()).horizontalAdvance(QStringLiteral("0:00.0 / 0:00.0")) + 4);
  row->addWidget(label_);
  worst_ = add_button("time-worst", tr("Worst"), tr("Go to the worst moment (W)"));
  for (const double factor : speeds()) speed_->addItem(QStringLiteral("%1×").arg(factor), factor);
  speed_->setObjectName(QStringLiteral("time-speed"));
  speed_->setAccessibleName(tr("Speed"));
  speed_->setToolTip(tr("Replay speed (< slower, > faster)"));
  speed_->setFocusPolicy(Qt::TabFocus);
  row->addWidget(speed_);
  set_speed(1.0);

  connect(play_, &QToolButton::clicked, this, [this] { set_playing(!is_playing_); });
  connect(previous_, &QToolButton::clicked, this, &TimeLine::go_to_previous_event);
  connect(next_, &QToolButton::clicked, this, &TimeLine::go_to_next_event);
  connect(worst_, &QToolButton::clicked, this, &TimeLine::go_to_worst);
  connect(track_, &TimeTrack::scrubbed, this, &TimeLine::set_time);
  set_events({});
  update_label();
}

QToolButton* TimeLine::add_button(const char* name, const QString& text, const QString& tooltip) {
  QToolButton* button = make_tool_button(name, text, tooltip);
  button->setAccessibleName(tooltip);
  button->setFocusPolicy(Qt::TabFocus);  // a click must not move the focus away from the time line
  layout()->addWidget(button);
  return button;
}

double TimeLine::time_s() const noexcept {
  return track_->time_s();
}

double TimeLine::duration_s() const noexcept {
  return track_->duration_s();
}

double TimeLine::speed() const noexcept {
  return speeds()[static_cast<std::size_t>(std::max(0, speed_->currentIndex()))];
}

void TimeLine::set_duration(double duration_s) {
  set_playing(false);
  track_->set_duration(duration_s);
  set_time(0.0);
  update_label();
}

void TimeLine::set_events(std::vector<Event> events) {
  const bool has_worst =
      std::any_of(events.begin(), events.end(), [](const Event& e) { return e.kind == TimeMark::kWorst; });
  worst_->setVisible(has_worst);
  previous_->setEnabled(!events.empty());
  next_->setEnabled(!events.empty());
  track_->set_events(std::move(events));
}

void TimeLine::set_phases(std::vector<Phase> phases) {
  track_->set_phases(std::move(phases));
}

void TimeLine::set_curve(std::vector<QPointF> curve) {
  track_->set_curve(std::move(curve));
}

void TimeLine::set_time(double time_s) {
  if (std::isnan(time_s)) return;
  const double inside_s = std::clamp(time_s, 0.0, duration_s());
  if (inside_s == this->time_s()) return;
  track_->set_time(inside_s);
  update_label();
  Q_EMIT time_changed(inside_s);
}

void TimeLine::set_playing(bool is_playing) {
  if (is_playing == is_playing_ || (is_playing && !(duration_s() > 0.0))) return;
  is_playing_ = is_playing;
  play_->setIcon(player_icon(is_playing ? PlayerIcon::kPause : PlayerIcon::kPlay));
  if (is_playing && time_s() >= duration_s()) set_time(0.0);
  Q_EMIT playing_changed(is_playing);
}

void TimeLine::set_speed(double factor) {
  const auto nearer = [&](double a, double b) { return std::abs(a - factor) < std::abs(b - factor); };
  const auto nearest = std::min_element(speeds().begin(), speeds().end(), nearer);
  speed_->setCurrentIndex(static_cast<int>(nearest - speeds().begin()));
}

void TimeLine::step_speed(int by) {
  speed_->setCurrentIndex(std::clamp(speed_->currentIndex() + by, 0, speed_->count() - 1));
}

void TimeLine::advance(double dt_s) {
  if (!is_playing_ || !(dt_s > 0.0)) return;
  set_time(time_s() + speed() * dt_s);
  if (time_s() >= duration_s()) set_playing(false);
}

void TimeLine::go_to_next_event() {
  for (const Event& event : track_->events())
    if (event.time_s > time_s() + kSame_s) return set_time(event.time_s);
}

void TimeLine::go_to_previous_event() {
  const std::vector<Event>& events = track_->events();
  for (auto event = events.rbegin(); event != events.rend(); ++event)
    if (event->time_s < time_s() - kSame_s) return set_time(event->time_s);
}

void TimeLine::go_to_worst() {
  for (const Event& event : track_->events())
    if (event.kind == TimeMark::kWorst) {
      set_playing(false);  // stop to show the event
      return set_time(event.time_s);
    }
}

void TimeLine::update_label() {
  label_->setText(clock_text(time_s()) + QStringLiteral(" / ") + clock_text(duration_s()));
}

void TimeLine::keyPressEvent(QKeyEvent* event) {
  auto found = find_action(Scope::kTimeLine, *event);
  if (!found) found = find_action(Scope::kFeedback, *event);
  if (!found || !perform(*found)) QWidget::keyPressEvent(event);
}

bool TimeLine::perform(const FoundAction& found) {
  const double sign = found.key == 0 ? -1.0 : 1.0;
  switch (found.action) {
    case Action::kPlay:
      set_playing(!is_playing_);
      return true;
    case Action::kStepTime:
      set_time(time_s() + sign * kStep_s);
      return true;
    case Action::kStepTimeFar:
      set_time(time_s() + sign * kLongStep_s);
      return true;
    case Action::kFirstMoment:
      set_time(0.0);
      return true;
    case Action::kLastMoment:
      set_time(duration_s());
      return true;
    case Action::kNextEvent:
      go_to_next_event();
      return true;
    case Action::kPreviousEvent:
      go_to_previous_event();
      return true;
    case Action::kWorstMoment:
      go_to_worst();
      return true;
    case Action::kSpeed:
      step_speed(found.key < 2 ? -1 : 1);
      return true;
    default:
      return false;
  }
}

}  // namespace trocar::trainer
