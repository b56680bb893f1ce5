#include "pages/start_page.h"

#include <QButtonGroup>
#include <QComboBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QFrame>
#include <QLabel>
#include <QListWidget>
#include <QPushButton>
#include <QRadioButton>
#include <QSettings>
#include <QVBoxLayout>
#include <algorithm>

#include "core/files/folders.h"
#include "pages/exam_choice.h"
#include "pages/first_steps_card.h"
#include "pages/history_card.h"
#include "pages/next_exercise_card.h"
#include "pages/patient_cards.h"
#include "pages/person_bar.h"
#include "panels/devices/device_choice.h"
#include "tasks/fit_to_patient.h"
#include "tasks/needle.h"
#include "tasks/task.h"
#include "ui_kit/parts.h"
#include "ui_kit/window_language.h"
#include "ui_kit/wrapped_rows.h"

namespace trocar::trainer {
namespace {

constexpr int kSource = Qt::UserRole;
constexpr int kMostFolders = 8;

constexpr std::pair<TrainingMode, const char*> kHelpLevels[] = {
    {TrainingMode::kGuided, "difficulty-guided"},
    {TrainingMode::kAssisted, "difficulty-assisted"},
    {TrainingMode::kExam, "difficulty-exam"},
};

QListWidgetItem* find_item(const QListWidget& list, const QString& source) {
  for (int row = 0; row < list.count(); ++row)
    if (list.item(row)->data(kSource).toString() == source) return list.item(row);
  return nullptr;
}

void add_item(QListWidget& list, const QString& title, const QString& source, const QString& text) {
  auto* item = new QListWidgetItem(title, &list);
  item->setData(kSource, source);
  item->setToolTip(text);
}

QListWidget* make_list(const char* name, const QString& title) {
  auto* list = new QListWidget;
  list->setObjectName(QString::fromLatin1(name));
  list->setAccessibleName(title);
  return list;
}

}  // namespace

StartPage::StartPage(QWidget* parent)
    : QWidget(parent), keys_(*this, [this](const QKeyEvent& key, const KeyPlace& place) {
        return press_by_enter(key, place, Action::kStart, *start_);
      }) {
  setObjectName(QStringLiteral("start-page"));
  // What needs more height than the window has is scrolled; Start is always visible.
  auto* content = new QWidget;
  auto* whole = new QVBoxLayout(this);
  whole->setContentsMargins(0, 0, 0, 0);
  whole->setSpacing(0);
  whole->addWidget(make_scrolled(*content), 1);
  auto* page = new QVBoxLayout(content);
  page->setContentsMargins(24, 12, 24, 8);
  page->setSpacing(10);
  auto* top = new QHBoxLayout;
  title_ = make_label(tr("Select a task and a patient"), "title");
  person_ = new PersonBar;
  top->addWidget(title_);
  top->addStretch();
  top->addWidget(person_);
  page->addLayout(top);
  page->addWidget(make_recovery());
  next_ = new NextExerciseCard;
  page->addWidget(next_);
  first_steps_ = new FirstStepsCard;
  page->addWidget(first_steps_);
  // A new user begins there.
  next_->set_held_back(!first_steps_->isHidden());
  connect(first_steps_, &FirstStepsCard::done, next_, [this] { next_->set_held_back(false); });
  auto* columns = new QHBoxLayout;
  columns->setSpacing(16);
  auto* tasks_and_history = new QVBoxLayout;
  tasks_and_history->setSpacing(12);
  tasks_and_history->addWidget(make_tasks(), 1);
  history_ = new HistoryCard;
  tasks_and_history->addWidget(history_, 2);
  columns->addLayout(tasks_and_history, 3);
  columns->addWidget(make_patients(), 8);
  columns->addWidget(make_help_choice(), 4);
  page->addLayout(columns, 1);

  auto* bottom = new QHBoxLayout;
  bottom->setContentsMargins(24, 8, 24, 10);
  bottom->setSpacing(10);
  bottom->addWidget(make_label(tr("A trainer, not a medical device."), "dim"));
  bottom->addStretch();
  auto* first_steps =
      make_button("open-first-steps", tr("First steps"), tr("A guided first puncture on a block of tissue"));
  bottom->addWidget(first_steps);
  start_ = make_button("start", tr("Start"), Action::kStart);
  start_->setProperty("role", "primary");
  bottom->addWidget(start_);
  whole->addLayout(bottom);
  const auto begin_first_steps = [this] {
    TrainerChoice exercise = FirstStepsCard::exercise();
    exercise.needle_device = devices_->needle();
    exercise.probe_device = devices_->probe();
    Q_EMIT start_requested(exercise);
  };
  connect(first_steps, &QPushButton::clicked, this, begin_first_steps);
  connect(first_steps_, &FirstStepsCard::exercise_requested, this, begin_first_steps);
  connect(start_, &QPushButton::clicked, this, &StartPage::start);
  connect(next_, &NextExerciseCard::exercise_requested, this, &StartPage::start_exercise);
  connect(tasks_, &QListWidget::currentRowChanged, this, [this] {
    fill_patients();
    fill_needles();
    Q_EMIT task_changed();
  });
  connect(patients_, &QListWidget::currentRowChanged, this, [this] { show_patient_details(); });
  connect(patients_, &QListWidget::itemDoubleClicked, start_, &QPushButton::click);

  const QSettings settings;
  const auto text = [&](const char* key, const std::string& otherwise) {
    return to_std(settings.value(QString::fromLatin1(key), to_qt(otherwise)).toString());
  };
  TrainerChoice last;
  last.task = text("start/task", last.task);
  last.patient = text("start/patient", last.patient);
  last.needle = text("start/needle", {});
  last.force_model = text("start/model", {});
  last.needle_device = text("start/device", last.needle_device);
  last.probe_device = text("start/device-probe", last.probe_device);
  last.mode = static_cast<TrainingMode>(std::clamp(settings.value(QStringLiteral("start/difficulty")).toInt(), 0, 2));
  choose(last);
}

QWidget* StartPage::make_tasks() {
  QBoxLayout* content = nullptr;
  QFrame* card = make_card(tr("Task"), content);
  tasks_ = make_list("tasks", tr("Task"));
  const auto tasks = tasks::load_tasks(data_dir() / "tasks");
  if (tasks) {
    for (const tasks::Task& task : *tasks)
      add_item(*tasks_, shown(task.title), to_qt(task.name), tr("Target organ: %1").arg(shown(task.organ)));
  } else {
    content->addWidget(make_label(shown(tasks.error().text()), "dim"));
  }
  wrap_rows(*tasks_);
  // All tasks are visible beside the history.
  constexpr int kFrame = 6;
  tasks_->setMinimumHeight(tasks_->count() * std::max(0, tasks_->sizeHintForRow(0)) + kFrame);
  content->addWidget(tasks_, 1);
  return card;
}

QWidget* StartPage::make_patients() {
  QBoxLayout* content = nullptr;
  QFrame* card = make_card(tr("Patient"), content);
  patients_ = new PatientCards;
  patients_->setObjectName(QStringLiteral("patients"));
  patients_->setAccessibleName(tr("Patient"));
  content->addWidget(patients_, 1);
  patient_text_ = make_label({}, "dim");
  patient_text_->setWordWrap(true);
  // Of one height for all patients: the cards above stay where they are.
  constexpr int kLines = 5;
  patient_text_->setFixedHeight(patient_text_->fontMetrics().lineSpacing() * kLines);
  patient_text_->setAlignment(Qt::AlignTop);
  content->addWidget(patient_text_);
  auto* open = make_button("open-patient", tr("Open a patient folder …"), Action::kOpenFolder,
                           tr("Open a folder made by the case builder or by trocar patient build"));
  connect(open, &QPushButton::clicked, this, &StartPage::open_folder);
  content->addWidget(open);
  return card;
}

QWidget* StartPage::make_help_choice() {
  QBoxLayout* content = nullptr;
  QFrame* card = make_card(tr("Level of help and tools"), content);
  difficulty_ = new QButtonGroup(this);
  for (const auto& [mode, name] : kHelpLevels) {
    const QString help = tr(help_text_of(mode));
    auto* button = new QRadioButton(tr(title_of(mode)));
    button->setObjectName(QString::fromLatin1(name));
    button->setToolTip(help);
    difficulty_->addButton(button, static_cast<int>(mode));
    content->addWidget(button);
    auto* text = make_label(help, "dim");
    text->setIndent(24);
    text->setWordWrap(true);
    content->addWidget(text);
  }
  exam_ = new ExamChoice;
  content->addWidget(exam_);
  connect(exam_, &ExamChoice::difficulty_chosen, this, &StartPage::choose_difficulty);
  content->addSpacing(8);
  tool_form_ = new QFormLayout;
  tool_form_->setSpacing(10);
  tool_form_->setLabelAlignment(Qt::AlignLeft);
  const auto add = [&](const QString& title, const char* name) {
    auto* box = new QComboBox;
    box->setObjectName(QString::fromLatin1(name));
    box->setAccessibleName(title);
    box->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
    tool_form_->addRow(make_label(title, "dim"), box);
    return box;
  };
  needle_ = add(tr("Needle"), "needle");
  model_ = add(tr("Forces"), "force-model");
  model_->addItem(tr("As defined by the task"), QString());
  model_->addItem(tr("Insertion model"), QStringLiteral("insertion"));
  model_->addItem(tr("Volume proxy"), QStringLiteral("proxy"));
  model_->addItem(tr("Both combined"), QStringLiteral("combined"));
  breathing_ = add(tr("Breathing"), "breathing");
  breathing_->addItem(tr("As defined by the task"), QString());
  breathing_->addItem(tr("None"), QStringLiteral("none"));
  breathing_->addItem(tr("Quiet"), QStringLiteral("quiet"));
  breathing_->addItem(tr("Deep"), QStringLiteral("deep"));
  content->addLayout(tool_form_);
  connect(difficulty_, QOverload<QAbstractButton*, bool>::of(&QButtonGroup::buttonToggled), this,
          [this] { lock_for_exam(); });
  devices_ = new DeviceChoice;
  content->addWidget(devices_);
  content->addStretch();
  return card;
}

void StartPage::start() {
  save();
  Q_EMIT start_requested(choice());
}

void StartPage::offer_next(const QString& title, const QString& why, const TrainerChoice& exercise) {
  next_->offer(title, why, exercise);
}

/// The devices stay; needle, forces and breathing are those of the task.
void StartPage::start_exercise(const TrainerChoice& exercise) {
  TrainerChoice next = exercise;
  next.needle_device = devices_->needle();
  next.probe_device = devices_->probe();
  choose(next);
  if (start_->isEnabled()) start();
}

void StartPage::show_history(const results::LearningCurve& curve) {
  history_->show_history(curve);
}

void StartPage::hide_history() {
  history_->clear();
}

void StartPage::choose_difficulty(int difficulty) {
  const QListWidgetItem* task = tasks_->currentItem();
  if (task == nullptr) return;
  for (const PatientEntry& entry : embedded_entries(task->data(kSource).toString(), task->text()))
    if (entry.difficulty == difficulty) {
      patients_->choose(entry.source);
      return;
    }
}

void StartPage::lock_for_exam() {
  const bool is_exam = difficulty_->checkedId() == static_cast<int>(TrainingMode::kExam);
  exam_->setVisible(is_exam);
  for (QComboBox* box : {needle_, model_, breathing_}) {
    box->setEnabled(!is_exam);
    box->setVisible(!is_exam);
    tool_form_->labelForField(box)->setVisible(!is_exam);
  }
}

QWidget* StartPage::make_recovery() {
  recovery_ = new QFrame;
  recovery_->setProperty("role", "card");
  auto* row = new QHBoxLayout(recovery_);
  recovery_text_ = make_label({});
  recovery_text_->setWordWrap(true);
  row->addWidget(recovery_text_, 1);
  auto* resume = make_button("recover", tr("Review recording"), tr("Score and replay the recording"));
  auto* decline = make_button("decline-recovery", tr("Not now"), tr("Keep the recording, without offering it again"));
  row->addWidget(resume);
  row->addWidget(decline);
  connect(resume, &QPushButton::clicked, this, &StartPage::recovery_requested);
  connect(decline, &QPushButton::clicked, this, [this] {
    offer_recovery({});
    Q_EMIT recovery_declined();
  });
  recovery_->hide();
  return recovery_;
}

void StartPage::offer_recovery(const QString& text) {
  recovery_text_->setText(text);
  recovery_->setVisible(!text.isEmpty());
  title_->setVisible(text.isEmpty());  // in a low window both do not fit
}

/// Lists the needles for the use of the selected task; keeps the selected needle if possible.
void StartPage::fill_needles() {
  const QString chosen = needle_->currentData().toString();
  needle_->clear();
  needle_->addItem(tr("As defined by the task"), QString());
  const QListWidgetItem* item = tasks_->currentItem();
  const auto tasks = tasks::load_tasks(data_dir() / "tasks");
  const auto needles = tasks::load_needles(data_dir() / "needles.toml");
  if (item == nullptr || !tasks || !needles) return;
  const std::string name = to_std(item->data(kSource).toString());
  const auto task = std::find_if(tasks->begin(), tasks->end(), [&](const tasks::Task& t) { return t.name == name; });
  if (task == tasks->end()) return;
  const std::vector<std::string> allowed = tasks::allowed_needles(*task, *needles);
  for (const tasks::Needle& needle : *needles)
    if (std::ranges::find(allowed, needle.name) != allowed.end())
      needle_->addItem(shown(needle.title), to_qt(needle.name));
  needle_->setCurrentIndex(std::max(0, needle_->findData(chosen)));
}

/// Embedded patients that support the selected task, and folders opened earlier.
void StartPage::fill_patients() {
  const QListWidgetItem* task = tasks_->currentItem();
  std::vector<PatientEntry> entries;
  if (task != nullptr) entries = embedded_entries(task->data(kSource).toString(), task->text());
  const QSettings settings;
  for (const QString& folder : settings.value(QStringLiteral("start/folders")).toStringList())
    entries.push_back(folder_entry(folder));
  {
    const QSignalBlocker blocked(patients_);
    patients_->show_patients(entries);
  }
  exam_->show_patients(entries);
  show_patient_details();
}

void StartPage::show_patient_details() {
  const PatientEntry* patient = patients_->chosen();
  QStringList lines{tr("No patient for this task yet: open a folder.")};
  if (patient != nullptr) lines = QStringList{patient->description, patient->details};
  lines.removeAll(QString());
  patient_text_->setText(lines.join(QLatin1Char('\n')));
  exam_->show_patient(patient);
  start_->setEnabled(patient != nullptr && tasks_->currentItem() != nullptr);
}

void StartPage::note_first_steps() {
  first_steps_->set_done();
}

void StartPage::open_folder() {
  const QString folder = QFileDialog::getExistingDirectory(this, tr("Patient folder"));
  if (!folder.isEmpty()) add_patient(folder);
}

void StartPage::add_patient(const QString& folder) {
  QSettings settings;
  QStringList folders = settings.value(QStringLiteral("start/folders")).toStringList();
  folders.removeAll(folder);
  folders.prepend(folder);
  while (folders.size() > kMostFolders) folders.removeLast();
  settings.setValue(QStringLiteral("start/folders"), folders);
  fill_patients();
  patients_->choose(folder);
}

void StartPage::choose(const TrainerChoice& choice) {
  QListWidgetItem* task = find_item(*tasks_, to_qt(choice.task));
  tasks_->setCurrentItem(task != nullptr ? task : tasks_->item(0));
  fill_patients();
  fill_needles();
  const QString patient = to_qt(choice.patient);
  if (!patients_->choose(patient) && patient.contains(QLatin1Char('/'))) {
    patients_->add_patient(folder_entry(patient));
    patients_->choose(patient);
  }
  if (auto* button = difficulty_->button(static_cast<int>(choice.mode))) button->setChecked(true);
  const auto select = [](QComboBox& box, const std::string& value) {
    box.setCurrentIndex(std::max(0, box.findData(to_qt(value))));
  };
  select(*needle_, choice.needle);
  select(*model_, choice.force_model);
  const QString breathing = to_qt(choice.breathing);
  if (breathing_->findData(breathing) < 0) breathing_->addItem(breathing, breathing);
  select(*breathing_, choice.breathing);
  devices_->choose(choice.needle_device, choice.probe_device);
  exam_->set_number(choice.exam_number);
  seeded_ = choice;
  lock_for_exam();
}

TrainerChoice StartPage::choice() const {
  TrainerChoice choice;
  if (const auto* task = tasks_->currentItem()) choice.task = to_std(task->data(kSource).toString());
  if (const PatientEntry* patient = patients_->chosen()) choice.patient = to_std(patient->source);
  choice.needle_device = devices_->needle();
  choice.probe_device = devices_->probe();
  choice.mode = static_cast<TrainingMode>(difficulty_->checkedId());
  if (choice.mode == TrainingMode::kExam) {
    choice.exam_number = exam_->number();
  } else {  // an exam uses the task's own
    if (choice.patient == seeded_.patient) choice.patient_seed = seeded_.patient_seed;
    choice.needle = to_std(needle_->currentData().toString());
    choice.force_model = to_std(model_->currentData().toString());
    choice.breathing = to_std(breathing_->currentData().toString());
  }
  return choice;
}

void StartPage::save() const {
  const TrainerChoice now = choice();
  QSettings settings;
  settings.setValue(QStringLiteral("start/task"), to_qt(now.task));
  settings.setValue(QStringLiteral("start/patient"), to_qt(now.patient));
  if (now.mode != TrainingMode::kExam) {  // which uses the task's own: those chosen before are kept
    settings.setValue(QStringLiteral("start/needle"), to_qt(now.needle));
    settings.setValue(QStringLiteral("start/model"), to_qt(now.force_model));
  }
  settings.setValue(QStringLiteral("start/device"), to_qt(now.needle_device));
  settings.setValue(QStringLiteral("start/device-probe"), to_qt(now.probe_device));
  settings.setValue(QStringLiteral("start/difficulty"), static_cast<int>(now.mode));
}

}  // namespace trocar::trainer
