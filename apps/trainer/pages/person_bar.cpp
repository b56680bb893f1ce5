#include "pages/person_bar.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QRegularExpressionValidator>
#include <QSignalBlocker>

#include "results/names.h"
#include "signing/password.h"
#include "ui_kit/parts.h"

namespace trocar::trainer {

PersonBar::PersonBar(QWidget* parent) : QFrame(parent) {
  setObjectName(QStringLiteral("person-bar"));
  auto* row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  row->setSpacing(8);
  message_ = make_label({}, "dim");
  message_->setObjectName(QStringLiteral("person-message"));
  prompt_ = make_label(tr("Trainee"), "dim");
  people_ = new QComboBox;
  people_->setObjectName(QStringLiteral("person"));
  people_->setAccessibleName(tr("Trainee"));
  people_->setMinimumContentsLength(24);
  people_->setToolTip(tr("Attempts are recorded for this person, in the database of the station or the department"));
  new_ = make_button("new-person", tr("New person …"), tr("Enter the name of somebody who is not in the list"));
  name_ = new QLineEdit;
  name_->setObjectName(QStringLiteral("person-name"));
  name_->setAccessibleName(tr("Name"));
  name_->setPlaceholderText(tr("Name"));
  name_->setMaxLength(static_cast<int>(results::kMaxNameCharacters));
  pin_ = new QLineEdit;
  pin_->setObjectName(QStringLiteral("person-pin"));
  pin_->setAccessibleName(tr("PIN"));
  pin_->setEchoMode(QLineEdit::Password);
  pin_->setValidator(
      new QRegularExpressionValidator(QRegularExpression(QStringLiteral("\\d{0,%1}").arg(signing::kLongestPin)), pin_));
  accept_ = make_button("person-ok", tr("Sign in"), tr("Sign in as this person"));
  accept_->setProperty("role", "primary");
  cancel_ = make_button("person-cancel", tr("Cancel"), tr("Back to the list of people"));
  row->addWidget(message_);
  for (QWidget* widget : std::initializer_list<QWidget*>{prompt_, people_, new_, name_, pin_, accept_, cancel_})
    row->addWidget(widget);
  connect(people_, QOverload<int>::of(&QComboBox::activated), this,
          [this](int index) { Q_EMIT person_requested(people_->itemData(index).toString()); });
  connect(new_, &QPushButton::clicked, this, &PersonBar::ask_for_name);
  connect(name_, &QLineEdit::returnPressed, this, &PersonBar::accept);
  connect(pin_, &QLineEdit::returnPressed, this, &PersonBar::accept);
  connect(accept_, &QPushButton::clicked, this, &PersonBar::accept);
  connect(cancel_, &QPushButton::clicked, this, [this] {
    close_entry();
    Q_EMIT entry_cancelled();
  });
  show_people({}, {}, false);
  close_entry();
}

void PersonBar::show_people(const std::vector<PersonEntry>& people, const QString& chosen, bool are_pins_required) {
  chosen_ = chosen;
  are_pins_required_ = are_pins_required;
  const QSignalBlocker blocked(people_);
  people_->clear();
  people_->addItem(tr("Nobody: results are not recorded"), QString());
  for (const PersonEntry& person : people)
    people_->addItem(person.course.isEmpty() ? person.name : tr("%1 (%2)").arg(person.name, person.course), person.id);
  people_->setCurrentIndex(std::max(0, people_->findData(chosen)));
}

void PersonBar::show_entry(const QString& prompt, bool has_name, bool has_pin) {
  prompt_->setText(prompt);
  people_->setVisible(!has_name && !has_pin);
  new_->setVisible(!has_name && !has_pin);
  name_->setVisible(has_name);
  pin_->setVisible(has_pin);
  accept_->setVisible(has_name || has_pin);
  cancel_->setVisible(has_name || has_pin);
  name_->clear();
  pin_->clear();
}

void PersonBar::ask_for_name() {
  show_message({});
  show_entry(tr("New person"), true, true);
  pin_->setPlaceholderText(are_pins_required_ ? tr("PIN, 4 to 12 digits") : tr("PIN, or leave empty"));
  name_->setFocus();
}

void PersonBar::ask_for_pin(const PersonEntry& person, bool is_new) {
  show_message({});
  show_entry(is_new ? tr("%1, choose a PIN").arg(person.name) : tr("PIN of %1").arg(person.name), false, true);
  pin_->setPlaceholderText(is_new ? tr("4 to 12 digits") : QString());
  pin_->setFocus();
}

void PersonBar::close_entry() {
  show_entry(tr("Trainee"), false, false);
  const QSignalBlocker blocked(people_);
  people_->setCurrentIndex(std::max(0, people_->findData(chosen_)));
}

bool PersonBar::is_entry_open() const {
  return !name_->isHidden() || !pin_->isHidden();
}

void PersonBar::accept() {
  // isHidden: the page itself may not be shown.
  if (!name_->isHidden()) {
    Q_EMIT new_person_entered(name_->text(), pin_->text());
  } else if (!pin_->isHidden()) {
    Q_EMIT pin_entered(pin_->text());
  }
}

void PersonBar::show_message(const QString& text) {
  message_->setText(text);
  message_->setVisible(!text.isEmpty());
}

}  // namespace trocar::trainer
