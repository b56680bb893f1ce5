#include "script/script_player.h"

#include <fmt/format.h>
#include <signal.h>

#include <QAbstractButton>
#include <QAction>
#include <QApplication>
#include <QMenu>
#include <QPixmap>
#include <QWidget>
#include <algorithm>
#include <cmath>

#include "script/cut_off.h"
#include "script/english_text.h"
#include "script/widget_events.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

constexpr int kBetweenSteps_ms = 15;
constexpr double kTimeout_s = 30.0;
constexpr double kDrag_s = 0.4;
constexpr double kSettled_s = 1.0;  ///< Time after which a layout is stable.
constexpr double kMostPerPoll_s = 0.1;

QPointF place_in_arguments(const QStringList& arguments, int first) {
  if (arguments.size() < first + 2) return {0.5, 0.5};
  return {arguments[first].toDouble(), arguments[first + 1].toDouble()};
}

/// TROCAR_SCRIPT_TIMEOUT_FACTOR multiplies all timeouts of a script, for slow builds; 1 without it. Range 1..100.
double timeout_factor() {
  return std::clamp(qEnvironmentVariable("TROCAR_SCRIPT_TIMEOUT_FACTOR").toDouble(), 1.0, 100.0);
}

/// "within SECONDS" at the end of a step, times the factor; else `default_s`.
double timeout_of(const QStringList& arguments, double default_s) {
  const auto at = arguments.indexOf(QStringLiteral("within"));
  return at >= 0 && at + 1 < arguments.size() ? timeout_factor() * arguments[at + 1].toDouble() : default_s;
}

}  // namespace

ScriptPlayer::ScriptPlayer(std::vector<ScriptStep> steps, Stage stage, QObject* parent)
    : QObject(parent), steps_(std::move(steps)), stage_(std::move(stage)) {
  stage_.default_timeout_s *= timeout_factor();
  timer_.setInterval(kBetweenSteps_ms);
  connect(&timer_, &QTimer::timeout, this, &ScriptPlayer::play_on);
}

void ScriptPlayer::start() {
  poll_.start();
  step_.start();
  timer_.start();
}

void ScriptPlayer::play_on() {
  step_s_ += std::min(kMostPerPoll_s, static_cast<double>(poll_.nsecsElapsed()) / 1e9);
  poll_.restart();
  if (at_ >= steps_.size()) {
    timer_.stop();
    Q_EMIT finished({});
    return;
  }
  const ScriptStep& step = steps_[at_];
  const Result<Progress> progress = play(step);
  if (!progress) {
    timer_.stop();
    Q_EMIT finished(tr("%1 line %2: %3").arg(step.script).arg(step.line).arg(to_qt(progress.error().text())));
    return;
  }
  if (*progress == Progress::kAgain) return;
  if (tells_times_)
    fmt::print(stderr, "{:7.2f} s  {}:{} {} {}\n", static_cast<double>(step_.nsecsElapsed()) / 1e9, to_std(step.script),
               step.line, to_std(step.verb), to_std(step.arguments.join(' ')));
  step_.restart();
  ++at_;
  sent_ = 0;
  step_s_ = 0.0;
}

Result<QWidget*> ScriptPlayer::find(const QString& name) const {
  if (name == QLatin1String("window")) return stage_.window;
  QWidget* hidden = nullptr;
  for (QWidget* top : QApplication::topLevelWidgets()) {
    for (QWidget* widget : top->findChildren<QWidget*>(name)) {
      // Menu entries are used without opening the menu, which would block the player.
      if (widget->isVisible() || qobject_cast<QMenu*>(widget->window()) != nullptr) return widget;
      hidden = widget;
    }
  }
  if (hidden == nullptr) return fail("no such widget", to_std(name), "check its object name");
  if (seconds() < stage_.default_timeout_s) return nullptr;
  return fail("the widget is not visible", to_std(name), "is another page open?");
}

Result<QWidget*> ScriptPlayer::find_usable(const QString& name) const {
  TROCAR_TRY(QWidget* const widget, find(name));
  if (widget == nullptr || widget->isEnabled()) return widget;
  if (seconds() < stage_.default_timeout_s) return nullptr;
  return fail("it cannot be used now", to_std(name), "the widget is disabled");
}

Result<ScriptPlayer::Progress> ScriptPlayer::click_menu_entry(QAction& entry) const {
  if (entry.isEnabled()) {
    entry.trigger();
    return Progress::kDone;
  }
  if (seconds() < stage_.default_timeout_s) return Progress::kAgain;
  return fail("it cannot be used now", to_std(entry.objectName()), "the widget is disabled");
}

bool ScriptPlayer::holds(const QString& fact, const QString& op, const QString& value) const {
  const QVariantMap facts = stage_.facts();
  const auto found = facts.find(fact);
  if (found == facts.end()) return false;  // it may appear later
  if (op == QLatin1String("is")) return found->toString() == value;
  if (op == QLatin1String("isnt")) return found->toString() != value;
  if (op == QLatin1String("has")) return found->toString().contains(value);
  const double a = found->toDouble(), b = value.toDouble();
  if (op == QLatin1String("<")) return a < b;
  if (op == QLatin1String(">")) return a > b;
  if (op == QLatin1String("<=")) return a <= b;
  return a >= b;
}

Result<ScriptPlayer::Progress> ScriptPlayer::wait_until_holds(const QStringList& fact_op_value, double timeout_s) {
  const QString& fact = fact_op_value[0];
  if (holds(fact, fact_op_value[1], fact_op_value[2])) return Progress::kDone;
  if (seconds() < timeout_s) return Progress::kAgain;
  const QVariantMap facts = stage_.facts();
  if (!facts.contains(fact))
    return fail("unknown fact \"" + to_std(fact) + "\"", {}, "known: " + to_std(facts.keys().join(' ')));
  const QString banner = facts.value(QStringLiteral("banner")).toString();
  return fail("the condition did not become true: " + to_std(fact_op_value.mid(0, 3).join(' ')),
              to_std(fact + " is " + facts.value(fact).toString()),
              banner.isEmpty() ? "increase the time: within SECONDS" : "window message: " + to_std(banner));
}

Result<ScriptPlayer::Progress> ScriptPlayer::play(const ScriptStep& step) {
  const QString& verb = step.verb;
  const QStringList& a = step.arguments;
  if (verb.startsWith(QLatin1String("wait"))) return play_waiting(step);
  if (verb.startsWith(QLatin1String("expect")) || verb == QLatin1String("screenshot") || verb == QLatin1String("print"))
    return play_looking(step);
  if (verb == QLatin1String("key")) {
    TROCAR_TRY_STATUS(press_keys(*stage_.window, a[0]));
    return ++sent_ >= (a.size() > 1 ? a[1].toInt() : 1) ? Progress::kDone : Progress::kAgain;
  }
  if (verb == QLatin1String("key-until")) return play_until(step, [&] { return press_keys(*stage_.window, a[0]); });
  if (verb == QLatin1String("hold") || verb == QLatin1String("release")) {
    const bool is_down = verb == QLatin1String("hold");
    TROCAR_TRY_STATUS(send_keys(*stage_.window, a[0], is_down ? KeyMotion::kDown : KeyMotion::kUp));
    return Progress::kDone;
  }
  if (verb == QLatin1String("type")) {
    type_text(*stage_.window, a[0]);
    return Progress::kDone;
  }
  if (verb == QLatin1String("resize")) {
    stage_.window->resize(a[0].toInt(), a[1].toInt());
    return Progress::kDone;
  }
  if (verb == QLatin1String("end-server")) {
    stage_.end_server(a[0]);
    return Progress::kDone;
  }
  if (verb == QLatin1String("end-window")) ::raise(SIGKILL);
  if (verb == QLatin1String("close-window")) {
    stage_.window->close();
    return Progress::kDone;
  }
  if (verb == QLatin1String("reset-watch")) {
    stage_.reset_watch();
    return Progress::kDone;
  }
  if (verb == QLatin1String("click")) {
    if (auto* entry = stage_.window->findChild<QAction*>(a[0])) return click_menu_entry(*entry);
  }
  TROCAR_TRY(QWidget* const widget, find_usable(a[0]));
  if (widget == nullptr) return Progress::kAgain;
  if (verb == QLatin1String("choose") || verb == QLatin1String("set")) {
    TROCAR_TRY_STATUS(verb == QLatin1String("set") ? set_value(*widget, a[1]) : choose_entry(*widget, a[1]));
    return Progress::kDone;
  }
  return play_pointer(step, *widget);
}

Result<ScriptPlayer::Progress> ScriptPlayer::play_pointer(const ScriptStep& step, QWidget& widget) {
  const QStringList& a = step.arguments;
  if (step.verb == QLatin1String("drag")) return play_drag(step, widget);
  if (step.verb == QLatin1String("wheel-until")) {
    return play_until(step, [&]() -> Status {
      turn_wheel(widget, {0.5, 0.5}, a[1].toDouble() > 0 ? 1 : -1);
      return {};
    });
  }
  if (step.verb == QLatin1String("wheel")) {
    const int notches = a[1].toInt();
    if (notches == 0) return Progress::kDone;
    turn_wheel(widget, place_in_arguments(a, 2), notches > 0 ? 1 : -1);
    return ++sent_ >= std::abs(notches) ? Progress::kDone : Progress::kAgain;
  }
  const QPointF place = place_in_arguments(a, 1);
  if (step.verb == QLatin1String("double-click")) {
    double_click(widget, place);
    return Progress::kDone;
  }
  const Qt::MouseButton button = step.verb == QLatin1String("right-click") ? Qt::RightButton : Qt::LeftButton;
  press(widget, place, button);
  release(widget, place, button);
  return Progress::kDone;
}

Result<ScriptPlayer::Progress> ScriptPlayer::play_drag(const ScriptStep& step, QWidget& widget) {
  const QStringList& a = step.arguments;
  const QString name = a.size() > 5 ? a[5] : QStringLiteral("left");
  const Qt::MouseButton button = name == QLatin1String("right")    ? Qt::RightButton
                                 : name == QLatin1String("middle") ? Qt::MiddleButton
                                                                   : Qt::LeftButton;
  const double duration_s = a.size() > 6 ? a[6].toDouble() : kDrag_s;
  const QPointF from = place_in_arguments(a, 1), to = place_in_arguments(a, 3);
  if (sent_++ == 0) {
    press(widget, from, button);
    return Progress::kAgain;
  }
  const double share = std::min(1.0, seconds() / std::max(duration_s, 1e-3));
  move(widget, from + share * (to - from), button);
  if (share < 1.0) return Progress::kAgain;
  release(widget, to, button);
  return Progress::kDone;
}

Result<ScriptPlayer::Progress> ScriptPlayer::play_until(const ScriptStep& step, const std::function<Status()>& act) {
  const QStringList& a = step.arguments;
  TROCAR_TRY(const Progress progress, wait_until_holds(a.mid(2), timeout_of(a, timeout_factor() * kTimeout_s)));
  if (progress == Progress::kDone) return progress;
  const int due = static_cast<int>(seconds() * std::abs(a[1].toDouble()));
  // One at a time, so that none follows once the condition holds; missed events are dropped.
  if (sent_ < due) TROCAR_TRY_STATUS(act());
  sent_ = due;
  return Progress::kAgain;
}

Result<ScriptPlayer::Progress> ScriptPlayer::play_waiting(const ScriptStep& step) {
  const QStringList& a = step.arguments;
  if (step.verb == QLatin1String("wait")) return seconds() >= a[0].toDouble() ? Progress::kDone : Progress::kAgain;
  return wait_until_holds(a, timeout_of(a, timeout_factor() * kTimeout_s));
}

Result<ScriptPlayer::Progress> ScriptPlayer::play_looking(const ScriptStep& step) {
  const QStringList& a = step.arguments;
  if (step.verb == QLatin1String("print")) {
    const QVariantMap facts = stage_.facts();
    for (const QString& fact : a) fmt::print("{}: {}\n", to_std(fact), to_std(facts.value(fact).toString()));
    std::fflush(stdout);
    return Progress::kDone;
  }
  if (step.verb == QLatin1String("expect-whole")) return expect_whole();
  if (step.verb == QLatin1String("expect")) return wait_until_holds(a, timeout_of(a, stage_.default_timeout_s));
  TROCAR_TRY(QWidget* const widget,
             find(step.verb == QLatin1String("screenshot") && a.size() < 2 ? QStringLiteral("window")
                  : step.verb == QLatin1String("screenshot")               ? a[1]
                                                                           : a[0]));
  if (widget == nullptr) return Progress::kAgain;
  const QImage image = widget->grab().toImage();
  if (step.verb == QLatin1String("screenshot")) {
    if (!image.save(a[0])) return fail("cannot write the image", to_std(a[0]), "check the folder");
    return Progress::kDone;
  }
  const double share = share_near(image, QColor(a[1]), a[2].toInt());
  if (share >= a[3].toDouble()) return Progress::kDone;
  if (seconds() >= timeout_of(a, stage_.default_timeout_s))
    return fail(fmt::format("only {:.2f} % of its pixels are near {}", 100.0 * share, to_std(a[1])), to_std(a[0]),
                "look at the picture, or correct the step");
  return Progress::kAgain;
}

/// Checks the force stop and every text of the page.
Result<ScriptPlayer::Progress> ScriptPlayer::expect_whole() const {
  const auto* stop = stage_.window->findChild<QWidget*>(QStringLiteral("force-stop"));
  QStringList faults = find_cut_off(*stage_.window);
  if (stop == nullptr || !is_wholly_visible(*stop)) faults.prepend(QStringLiteral("force-stop: not fully visible"));
  if (!window_language().is_english()) faults << find_english(*stage_.window);
  if (faults.isEmpty()) return Progress::kDone;
  if (seconds() < kSettled_s) return Progress::kAgain;
  const QSize size = stage_.window->size();
  return fail(to_std(faults.join(QStringLiteral("; "))), fmt::format("{}x{}", size.width(), size.height()),
              "provide more space, let it scroll, or translate it");
}

}  // namespace trocar::trainer
