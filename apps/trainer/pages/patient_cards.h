#pragma once

#include <QListWidget>
#include <vector>

#include "choice/patient_entry.h"

namespace trocar::trainer {

/// Patients as cards in a scrolled grid: picture, name, task, difficulty as dots, description in one line. As many
/// columns as fit; after a change of size the selected card is in sight. Arrow keys, Home, End and the first letters of
/// a name select; Enter and a double click activate. Screen readers get each card as a sentence.
class PatientCards : public QListWidget {
  Q_OBJECT

 public:
  explicit PatientCards(QWidget* parent = nullptr);

  /// Replaces all cards; keeps the selected patient if it is still there, otherwise selects the first.
  void show_patients(const std::vector<PatientEntry>& entries);
  /// Adds a card at the end.
  void add_patient(const PatientEntry& entry);
  /// False if there is no such card.
  bool choose(const QString& source);
  /// The selected patient; nullptr if there is none.
  const PatientEntry* chosen() const;

 protected:
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  void fit_cards();
  std::vector<PatientEntry> entries_;  ///< By row.
};

}  // namespace trocar::trainer
