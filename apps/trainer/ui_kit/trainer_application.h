#pragma once

#include <QApplication>
#include <QString>
#include <vector>

namespace trocar::trainer {

/// A handler that blocked the window.
struct SlowHandler {
  double ms = 0.0;
  QString what;  ///< Event and receiver.
};

/// The application; measures the duration of each event handler. Drawing is measured separately: its time depends on
/// the level of detail, all other handlers must be short.
class TrainerApplication : public QApplication {
  Q_OBJECT

 public:
  TrainerApplication(int& argc, char** argv);

  bool notify(QObject* receiver, QEvent* event) override;

  /// The slowest handlers other than drawing since the last reset, slowest first, ten at most.
  const std::vector<SlowHandler>& slowest() const noexcept { return slowest_; }
  void reset_watch();

  /// Time within this scope counts as drawing, not as time of the handler.
  class DrawingScope {
   public:
    DrawingScope();
    ~DrawingScope();
    DrawingScope(const DrawingScope&) = delete;
    DrawingScope& operator=(const DrawingScope&) = delete;

   private:
    std::int64_t begin_ns_;
  };

 private:
  std::int64_t drawn_ns_ = 0;  ///< Drawing time within the outermost running handler.
  int depth_ = 0;
  std::vector<SlowHandler> slowest_;
};

}  // namespace trocar::trainer
