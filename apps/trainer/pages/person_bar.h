#pragma once

#include <QFrame>
#include <QString>
#include <vector>

class QComboBox;
class QLabel;
class QLineEdit;
class QPushButton;

namespace trocar::trainer {

/// A person of the database of results, as the start page shows it.
struct PersonEntry {
  QString id, name, course;
  bool has_pin = false;
};

/// Who practises: a list of people, fields for a new person, a field for a PIN. Nobody may be chosen: then results stay
/// on this station.
class PersonBar : public QFrame {
  Q_OBJECT

 public:
  explicit PersonBar(QWidget* parent = nullptr);

  /// `chosen`: id of the person who practises; empty: nobody.
  void show_people(const std::vector<PersonEntry>& people, const QString& chosen, bool are_pins_required);
  /// Asks for the PIN of a person; `is_new`: for a new one, because everybody has to have one.
  void ask_for_pin(const PersonEntry& person, bool is_new);
  /// Back to the list, with the person who practises.
  void close_entry();
  /// A name or a PIN is being entered.
  bool is_entry_open() const;
  void show_message(const QString& text);

 Q_SIGNALS:
  /// An entry of the list was chosen; empty: nobody.
  void person_requested(const QString& id);
  void pin_entered(const QString& pin);
  void new_person_entered(const QString& name, const QString& pin);
  void entry_cancelled();

 private:
  void ask_for_name();
  void accept();
  void show_entry(const QString& prompt, bool has_name, bool has_pin);

  QComboBox* people_ = nullptr;
  QPushButton* new_ = nullptr;
  QLabel* prompt_ = nullptr;
  QLineEdit* name_ = nullptr;
  QLineEdit* pin_ = nullptr;
  QPushButton* accept_ = nullptr;
  QPushButton* cancel_ = nullptr;
  QLabel* message_ = nullptr;
  QString chosen_;
  bool are_pins_required_ = false;
};

}  // namespace trocar::trainer
