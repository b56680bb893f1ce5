#pragma once

#include <QWidget>

#include "choice/trainer_choice.h"

class QButtonGroup;
class QComboBox;
class QFrame;
class QLabel;
class QListWidget;
class QPushButton;

namespace trocar::trainer {

class DeviceChoice;
class PatientCards;

/// Start page: task, patients of the task as cards, level of help, device of each tool. Keys: Enter starts, Ctrl+O
/// opens a patient folder. The last selection is stored.
class StartPage : public QWidget {
  Q_OBJECT

 public:
  explicit StartPage(QWidget* parent = nullptr);

  void choose(const TrainerChoice& choice);
  TrainerChoice choice() const;
  /// Offers to recover an attempt that was interrupted by a crash; empty: no offer.
  void offer_recovery(const QString& text);
  /// Adds a patient folder to the list and selects it.
  void add_patient(const QString& folder);

 Q_SIGNALS:
  void start_requested(const trocar::trainer::TrainerChoice& choice);
  void recovery_requested();
  void recovery_declined();

 private:
  QWidget* make_tasks();
  QWidget* make_patients();
  QWidget* make_help_choice();
  QWidget* make_recovery();
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
  DeviceChoice* devices_ = nullptr;
  QComboBox* needle_ = nullptr;
  QComboBox* model_ = nullptr;
  QPushButton* start_ = nullptr;
  QFrame* recovery_ = nullptr;
  QLabel* recovery_text_ = nullptr;
};

}  // namespace trocar::trainer
