#pragma once

#include <QWidget>
#include <cstdint>
#include <vector>

#include "choice/patient_entry.h"

class QComboBox;
class QLabel;
class QSpinBox;

namespace trocar::trainer {

/// Difficulty and number of an exam. The number is the seed of an embedded patient's body; 0 draws one that was not
/// practised. A patient folder has neither.
class ExamChoice : public QWidget {
  Q_OBJECT

 public:
  explicit ExamChoice(QWidget* parent = nullptr);

  /// The difficulties that the patients of the task have.
  void show_patients(const std::vector<PatientEntry>& entries);
  /// The patient that is selected; nullptr: none.
  void show_patient(const PatientEntry* patient);
  void set_number(std::uint64_t number);
  std::uint64_t number() const;  ///< 0: to be drawn.

 Q_SIGNALS:
  /// The first patient of this difficulty is asked for.
  void difficulty_chosen(int difficulty);

 private:
  QComboBox* difficulty_ = nullptr;
  QSpinBox* number_ = nullptr;
  QLabel* note_ = nullptr;
};

}  // namespace trocar::trainer
