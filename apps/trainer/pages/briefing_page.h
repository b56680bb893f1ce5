#pragma once

#include <QWidget>

#include "cases/open_case.h"
#include "choice/trainer_choice.h"

class QBoxLayout;
class QLabel;
class QProgressBar;
class QPushButton;

namespace trocar::trainer {

/// Task, patient, needle, scoring and controls; shows the progress while the case opens. Keys: Enter begins, Escape
/// goes back.
class BriefingPage : public QWidget {
  Q_OBJECT

 public:
  explicit BriefingPage(QWidget* parent = nullptr);

  void show_opening(const TrainerChoice& choice);
  void show_progress(const QString& step, double fraction);
  void show_error(const QString& text);
  void show_case(const cases::OpenCase& open, Difficulty difficulty);
  /// Pictures of the case that are still prepared, after show_case; empty: none.
  void show_later(const QString& step);

 Q_SIGNALS:
  void begin_requested();
  void back_requested();

 private:
  QWidget* make_text();
  QWidget* make_pictures();
  QWidget* make_bottom();

  QLabel* title_ = nullptr;
  QLabel* subtitle_ = nullptr;
  QLabel* goal_ = nullptr;
  QLabel* counts_ = nullptr;
  QLabel* controls_ = nullptr;
  QLabel* axial_ = nullptr;
  QLabel* second_ = nullptr;  ///< A slice perpendicular to the first.
  QLabel* state_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QPushButton* begin_ = nullptr;
};

}  // namespace trocar::trainer
