#include "parameters/parameter_profiles.h"

#include <QComboBox>
#include <QHBoxLayout>
#include <QIcon>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QPainter>
#include <QPixmap>
#include <QPushButton>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>

#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

constexpr int kDot_px = 10;
constexpr int kLongestName = 80;
constexpr int kShownLetters = 14;  ///< Width of a name in a question, next to its buttons.

QIcon make_dot(qreal pixel_ratio) {
  QPixmap dot(QSize(kDot_px, kDot_px) * pixel_ratio);
  dot.setDevicePixelRatio(pixel_ratio);
  dot.fill(Qt::transparent);
  QPainter painter(&dot);
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setPen(Qt::NoPen);
  painter.setBrush(theme().accent);
  painter.drawEllipse(QRectF(1.5, 1.5, kDot_px - 3.0, kDot_px - 3.0));
  painter.end();
  return QIcon(dot);
}

/// Never requests more than the available width.
QLabel* make_wrapped(const char* name) {
  auto* label = make_label({});
  label->setObjectName(QString::fromLatin1(name));
  label->setTextFormat(Qt::PlainText);
  label->setWordWrap(true);
  QSizePolicy policy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  policy.setHeightForWidth(true);
  label->setSizePolicy(policy);
  return label;
}

/// Inserts break opportunities for wrapping paths, keys and very long words.
QString breakable_words(const QString& text) {
  constexpr int kLongestWord = 18;
  QString broken;
  int run = 0;
  for (const QChar c : text) {
    broken += c;
    run = c.isSpace() ? 0 : run + 1;
    if (c != QLatin1Char('/') && c != QLatin1Char('_') && run < kLongestWord) continue;
    broken += QChar(0x200b);
    run = 0;
  }
  return broken;
}

QString about(const cases::TissueProfile& profile) {
  const int count = static_cast<int>(profile.overrides.size());
  QString text = count == 1 ? ParameterProfiles::tr("1 number") : ParameterProfiles::tr("%1 numbers").arg(count);
  if (!profile.force_model.empty()) text += QStringLiteral(", ") + shown(profile.force_model);
  if (!profile.note.empty()) text += QLatin1Char('\n') + to_qt(profile.note);
  return text;
}

}  // namespace

ParameterProfiles::ParameterProfiles(QWidget* parent)
    : QWidget(parent), problem_(make_wrapped("parameter-profile-problem")) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  layout->addWidget(make_choice());
  layout->addWidget(make_question());
  layout->addWidget(problem_);
  problem_->hide();
  ask(Question::kNone);
}

QWidget* ParameterProfiles::make_choice() {
  auto* row = new QWidget;
  auto* layout = new QHBoxLayout(row);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(6);
  choice_ = new QComboBox;
  choice_->setObjectName(QStringLiteral("parameter-profile"));
  choice_->setAccessibleName(tr("Profile"));
  choice_->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  choice_->setMinimumContentsLength(6);
  choice_->setIconSize({kDot_px, kDot_px});
  connect(choice_, QOverload<int>::of(&QComboBox::activated), this, [this](int index) {
    ask(Question::kNone);
    Q_EMIT chosen(to_std(choice_->itemData(index).toString()));
  });
  save_as_ = make_tool_button("parameter-profile-save-as", tr("Save as …"),
                              tr("Save the parameters and the force model under a name  (Space)"));
  delete_ = make_tool_button("parameter-profile-delete", tr("Delete"),
                             tr("Delete the selected profile; the parameters do not change  (Space)"));
  connect(save_as_, &QToolButton::clicked, this, [this] { ask(Question::kName); });
  connect(delete_, &QToolButton::clicked, this, [this] { ask(Question::kDelete); });
  layout->addWidget(choice_, 1);
  for (QToolButton* button : {save_as_, delete_}) {
    button->setFocusPolicy(Qt::StrongFocus);
    button->setStyleSheet(QStringLiteral("padding: 5px 6px"));  // leaves more width for names
    layout->addWidget(button);
  }
  return row;
}

QWidget* ParameterProfiles::make_question() {
  asked_ = new QWidget;
  auto* layout = new QHBoxLayout(asked_);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(6);
  name_ = new QLineEdit;
  name_->setObjectName(QStringLiteral("parameter-profile-name"));
  name_->setAccessibleName(tr("Name of the profile"));
  name_->setToolTip(tr("Name of the profile  (Enter saves, Escape cancels)"));
  name_->setPlaceholderText(tr("Name"));
  name_->setMaxLength(kLongestName);
  words_ = make_label({});
  words_->setObjectName(QStringLiteral("parameter-profile-question"));
  words_->setTextFormat(Qt::PlainText);
  words_->setSizePolicy(QSizePolicy::Ignored, QSizePolicy::Preferred);
  yes_ = make_button("parameter-profile-yes", {}, tr("Confirm  (Space)"));
  no_ = make_button("parameter-profile-no", tr("Cancel"), tr("Cancel  (Escape)"));
  for (QPushButton* button : {yes_, no_}) button->setStyleSheet(QStringLiteral("padding: 5px 9px"));
  connect(name_, &QLineEdit::returnPressed, this, &ParameterProfiles::answer_yes);
  connect(yes_, &QPushButton::clicked, this, &ParameterProfiles::answer_yes);
  connect(no_, &QPushButton::clicked, this, &ParameterProfiles::answer_no);
  layout->addWidget(name_, 1);
  layout->addWidget(words_, 1);
  layout->addWidget(yes_);
  layout->addWidget(no_);
  return asked_;
}

void ParameterProfiles::set_folder(const std::filesystem::path& folder) {
  folder_ = folder;
  ask(Question::kNone);
  read_folder();
}

void ParameterProfiles::read_folder() {
  cases::ProfileList list = cases::list_profiles(folder_);
  profiles_ = std::move(list.profiles);
  list_entries();
  if (!list.problems.empty()) {
    QString text = shown(list.problems.front());
    if (list.problems.size() > 1) text += tr(" (and %1 more)").arg(static_cast<int>(list.problems.size() - 1));
    show_problem(text);
  }
  Q_EMIT listed();
}

void ParameterProfiles::list_entries() {
  choice_->clear();
  choice_->addItem(tr("As in the case"), QString());
  for (const cases::TissueProfile& profile : profiles_) {
    choice_->addItem(to_qt(profile.name), to_qt(profile.file.string()));
    choice_->setItemData(choice_->count() - 1, about(profile), Qt::ToolTipRole);
  }
  show_chosen(chosen_, differs_);
}

void ParameterProfiles::show_chosen(const std::string& file, bool differs) {
  chosen_ = file;
  differs_ = differs;
  const int index = std::max(0, choice_->findData(to_qt(file)));
  if (choice_->currentIndex() != index) choice_->setCurrentIndex(index);
  for (int entry = 0; entry < choice_->count(); ++entry)
    if (const bool is_dotted = entry == index && differs; choice_->itemIcon(entry).isNull() == is_dotted)
      choice_->setItemIcon(entry, is_dotted ? make_dot(devicePixelRatioF()) : QIcon());
  const QString tip = tr("Tissue profile: %1  (Up, Down)").arg(choice_->currentText());
  choice_->setToolTip(differs ? tip + QLatin1Char('\n') + tr("●  changed since it was selected") : tip);
  choice_->setAccessibleDescription(differs ? tr("changed") : QString());
  delete_->setEnabled(index > 0);
}

const cases::TissueProfile* ParameterProfiles::find(const std::string& file) const noexcept {
  const auto found = std::find_if(profiles_.begin(), profiles_.end(),
                                  [&](const cases::TissueProfile& profile) { return profile.file.native() == file; });
  return found != profiles_.end() ? &*found : nullptr;
}

const cases::TissueProfile* ParameterProfiles::find_same(const std::string& name) const noexcept {
  for (const cases::TissueProfile& profile : profiles_)
    if (profile.name == name) return &profile;
  return find(cases::profile_file(folder_, name).string());
}

const cases::TissueProfile* ParameterProfiles::current() const noexcept {
  return find(chosen_);
}

void ParameterProfiles::ask(Question question) {
  const bool had_focus = asked_->isAncestorOf(focusWidget());
  if (question == Question::kName && question_ == Question::kNone)
    name_->setText(current() != nullptr ? to_qt(current()->name) : QString());
  question_ = question;
  show_problem({});
  const bool is_name = question == Question::kName;
  asked_->setVisible(question != Question::kNone);
  name_->setVisible(is_name);
  words_->setVisible(!is_name);
  QString verb = tr("Save"), name = name_->text().trimmed();
  if (question == Question::kReplace) {
    verb = tr("Replace");
    if (const cases::TissueProfile* old = find_same(to_std(name))) name = to_qt(old->name);
  } else if (question == Question::kDelete && current() != nullptr) {
    verb = tr("Delete");
    name = to_qt(current()->name);
  }
  const int room = kShownLetters * words_->fontMetrics().averageCharWidth();
  words_->setText(tr("%1 “%2”?").arg(verb, words_->fontMetrics().elidedText(name, Qt::ElideMiddle, room)));
  words_->setToolTip(name);
  yes_->setText(verb);
  yes_->setAccessibleName(verb);
  if (is_name) {
    name_->setFocus();
    name_->selectAll();
  } else if (question != Question::kNone) {
    no_->setFocus();  // an accidental second Enter or Space has no effect
  } else if (had_focus) {
    choice_->setFocus();
  }
}

void ParameterProfiles::answer_yes() {
  if (question_ == Question::kDelete) {
    remove();
  } else if (question_ != Question::kNone) {
    save();
  }
}

void ParameterProfiles::answer_no() {
  ask(question_ == Question::kReplace ? Question::kName : Question::kNone);
}

void ParameterProfiles::save() {
  cases::TissueProfile profile;
  profile.name = to_std(name_->text().trimmed());
  std::error_code error;
  const cases::TissueProfile* old = find_same(profile.name);
  const bool replaces = old != nullptr || std::filesystem::exists(cases::profile_file(folder_, profile.name), error);
  if (replaces && question_ != Question::kReplace && !profile.name.empty()) {
    ask(Question::kReplace);
    return;
  }
  show_problem({});
  if (old != nullptr) profile.note = old->note;
  Q_EMIT save_asked(profile, question_ == Question::kReplace);
}

void ParameterProfiles::finish_saving(const cases::TissueProfile& saved) {
  // Deletes a profile of the same name in another file.
  Status done;
  for (const cases::TissueProfile& profile : profiles_)
    if (profile.name == saved.name && profile.file != saved.file) done = cases::delete_profile(profile);
  ask(Question::kNone);
  read_folder();
  if (!done) show_problem(shown(done.error().text()));
}

void ParameterProfiles::remove() {
  const cases::TissueProfile* profile = current();
  if (profile == nullptr) return;
  const QString name = to_qt(profile->name);
  const Status done = cases::delete_profile(*profile);
  ask(Question::kNone);
  read_folder();
  if (done) {
    show_message(tr("Profile “%1” is deleted; its values stay active.").arg(breakable_words(name)), false);
  } else {
    show_problem(shown(done.error().text()));
  }
}

void ParameterProfiles::show_problem(const QString& text) {
  show_message(breakable_words(text), true);
}

void ParameterProfiles::show_message(const QString& text, bool is_problem) {
  problem_->setText(text);
  problem_->setStyleSheet(QStringLiteral("color: %1").arg((is_problem ? theme().bad : theme().dim).name()));
  problem_->setVisible(!text.isEmpty());
}

/// Escape closes the question before window shortcuts receive it.
bool ParameterProfiles::event(QEvent* event) {
  if (event->type() == QEvent::ShortcutOverride && question_ != Question::kNone &&
      static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape) {
    event->accept();
    return true;
  }
  return QWidget::event(event);
}

void ParameterProfiles::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Escape && question_ != Question::kNone) {
    answer_no();
  } else {
    QWidget::keyPressEvent(event);
  }
}

void ParameterProfiles::showEvent(QShowEvent* event) {
  QWidget::showEvent(event);
  read_folder();
}

}  // namespace trocar::trainer
