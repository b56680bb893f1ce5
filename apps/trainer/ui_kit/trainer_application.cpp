#include "ui_kit/trainer_application.h"

#include <QEvent>
#include <QMetaEnum>
#include <QWidget>
#include <algorithm>
#include <chrono>
#include <clocale>

namespace trocar::trainer {
namespace {

constexpr double kWorthNoting_ms = 5.0;
constexpr std::size_t kMostNoted = 10;

std::int64_t now_ns() {
  return std::chrono::steady_clock::now().time_since_epoch().count();
}

bool is_drawing(QEvent::Type type) {
  return type == QEvent::Paint || type == QEvent::UpdateRequest || type == QEvent::Expose ||
         type == QEvent::UpdateLater;
}

TrainerApplication* the_application() {
  return qobject_cast<TrainerApplication*>(QCoreApplication::instance());
}

}  // namespace

TrainerApplication::TrainerApplication(int& argc, char** argv) : QApplication(argc, argv) {
  // Qt has taken over the user's locale. Messages stay, but no library may write decimal commas into a file.
  std::setlocale(LC_NUMERIC, "C");
}

bool TrainerApplication::notify(QObject* receiver, QEvent* event) {
  const QEvent::Type type = event->type();
  const bool is_outermost = depth_ == 0;
  if (is_outermost) drawn_ns_ = 0;
  const std::int64_t begin_ns = now_ns();
  // The receiver may have been deleted.
  const QString name = receiver->objectName();
  const char* kind = receiver->metaObject()->className();
  ++depth_;
  const bool is_taken = QApplication::notify(receiver, event);
  --depth_;
  const std::int64_t took_ns = now_ns() - begin_ns;
  if (is_drawing(type)) {
    // Painting within another handler is drawing, too.
    if (!is_outermost) drawn_ns_ += took_ns;
    return is_taken;
  }
  if (!is_outermost) return is_taken;
  const double ms = static_cast<double>(took_ns - drawn_ns_) / 1e6;
  if (ms >= kWorthNoting_ms) {
    const QMetaEnum types = QMetaEnum::fromType<QEvent::Type>();
    const char* key = types.valueToKey(type);
    slowest_.push_back(
        {ms, QStringLiteral("%1 to %2 %3")
                 .arg(QString::fromLatin1(key != nullptr ? key : "an event"), QString::fromLatin1(kind), name)});
    std::sort(slowest_.begin(), slowest_.end(), [](const SlowHandler& a, const SlowHandler& b) { return a.ms > b.ms; });
    if (slowest_.size() > kMostNoted) slowest_.pop_back();
  }
  return is_taken;
}

void TrainerApplication::reset_watch() {
  slowest_.clear();
}

TrainerApplication::DrawingScope::DrawingScope() : begin_ns_(now_ns()) {}

TrainerApplication::DrawingScope::~DrawingScope() {
  if (auto* application = the_application()) application->drawn_ns_ += now_ns() - begin_ns_;
}

}  // namespace trocar::trainer
