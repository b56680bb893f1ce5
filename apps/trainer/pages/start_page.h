#pragma once

#include <QWidget>

#include "choice/trainer_choice.h"
#include "results/proficiency.h"
#include "ui_kit/page_keys.h"

class QButtonGroup;
class QComboBox;
class QFormLayout;
class QFrame;
class QLabel;
class QListWidget;
class QPushButton;

namespace trocar::trainer {

class DeviceChoice;
class ExamChoice;
class FirstStepsCard;
class HistoryCard;
class NextExerciseCard;
class PatientCards;
class PersonBar;

/// Start page: who practises, own history, next exercise, task, patients of the task as cards, level of help, device of
/// each tool. Keys: Enter starts, Ctrl+G starts the next exercise, Ctrl+O opens a patient folder. The last selection is
/// stored.
class StartPage : public QWidget {
  Q_OBJECT

 public:
  explicit StartPage(QWidget* parent = nullptr);

  void choose(const TrainerChoice& choice);
  TrainerChoice choice() const;
  /// Offers to recover an attempt that was interrupted by a crash; empty: no offer.
  void offer_recovery(const QString& text);
  /// Offers the next exercise of the learning path; `exercise` has its task, patient and level of help. An empty title:
  /// no offer.
  void offer_next(const QString& title, const QString& why, const TrainerChoice& exercise);
  PersonBar& person() noexcept { return *person_; }
  /// The guided first puncture was done: it is not offered any more.
  void note_first_steps();
  /// Shows the history of who practises at the selected task.
  void show_history(const results::LearningCurve& curve);
  void hide_history();
  /// Adds a patient folder to the list and selects it.
  void add_patient(const QString& folder);

 Q_SIGNALS:
  void start_requested(const trocar::trainer::TrainerChoice& choice);
  void task_changed();
  void recovery_requested();
  void recovery_declined();

 private:
  QWidget* make_tasks();
  QWidget* make_patients();
  QWidget* make_help_choice();
  QWidget* make_recovery();
  void start();
  void start_exercise(const TrainerChoice& exercise);
  void choose_difficulty(int difficulty);
  void lock_for_exam();
  void fill_patients();
  void fill_needles();
  void open_folder();
  void show_patient_details();
  void save() const;

  QListWidget* tasks_ = nullptr;
  PatientCards* patients_ = nullptr;
  QLabel* patient_text_ = nullptr;
  QButtonGroup* difficulty_ = nullptr;
  ExamChoice* exam_ = nullptr;
  PersonBar* person_ = nullptr;
  HistoryCard* history_ = nullptr;
  NextExerciseCard* next_ = nullptr;
  FirstStepsCard* first_steps_ = nullptr;
  DeviceChoice* devices_ = nullptr;
  QFormLayout* tool_form_ = nullptr;  ///< Needle, forces and breathing; hidden in an exam.
  QComboBox* needle_ = nullptr;
  QComboBox* model_ = nullptr;
  QComboBox* breathing_ = nullptr;
  QPushButton* start_ = nullptr;
  QLabel* title_ = nullptr;
  QFrame* recovery_ = nullptr;
  QLabel* recovery_text_ = nullptr;
  TrainerChoice seeded_;  ///< Patient and seed that were chosen by choose().
  PageKeys keys_;
};

}  // namespace trocar::trainer
