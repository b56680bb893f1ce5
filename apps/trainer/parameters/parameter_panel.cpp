#include "parameters/parameter_panel.h"

#include <QHBoxLayout>
#include <QLabel>
#include <QScrollArea>
#include <QScrollBar>
#include <QTimer>
#include <QToolButton>
#include <QVBoxLayout>
#include <algorithm>
#include <utility>
#include <vector>

#include "core/files/folders.h"
#include "parameters/force_preview.h"
#include "parameters/parameter_list.h"
#include "parameters/parameter_profiles.h"
#include "ui_kit/parts.h"
#include "ui_kit/theme.h"
#include "ui_kit/window_language.h"

namespace trocar::trainer {
namespace {

/// A moving slider changes the number with every frame; server and prediction get the newest value after this time.
constexpr std::chrono::milliseconds kQuiet{150};

std::vector<std::string> texts_of(const QStringList& list) {
  std::vector<std::string> texts;
  for (const QString& text : list) texts.push_back(to_std(text));
  return texts;
}

}  // namespace

ParameterPanel::ParameterPanel(QWidget* parent)
    : QWidget(parent),
      empty_(make_label(tr("Open a case to adjust its tissues."), "dim")),
      body_(new QWidget),
      profiles_(new ParameterProfiles),
      preview_(new ForcePreview),
      scroll_(new QScrollArea),
      list_(new ParameterList) {
  setObjectName(QStringLiteral("parameter-panel"));
  setAccessibleName(tr("Tissue parameters"));
  setAttribute(Qt::WA_StyledBackground);
  setStyleSheet(QStringLiteral("#parameter-panel { background: %1; }").arg(theme().ground.name()));
  scroll_->setWidget(list_);
  scroll_->setWidgetResizable(true);
  scroll_->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll_->setFocusPolicy(Qt::NoFocus);
  scroll_->setMinimumHeight(120);

  auto* parts = new QVBoxLayout(body_);
  parts->setContentsMargins(0, 0, 0, 0);
  parts->setSpacing(8);
  parts->addWidget(profiles_);
  parts->addWidget(preview_);
  parts->addWidget(scroll_, 1);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(8, 8, 8, 8);
  layout->setSpacing(8);
  layout->addWidget(make_head());
  layout->addWidget(empty_);
  layout->addWidget(body_, 1);
  layout->addStretch(0);

  connect(preview_, &ForcePreview::model_changed, this, [this](const QString& model) {
    edits_.set_model(to_std(model));
    list_->show_model(model);
    show_values();
    Q_EMIT model_changed(model);
  });
  connect(list_, &ParameterList::edited, this, &ParameterPanel::edit);
  connect(list_, &ParameterList::reset_asked, this, [this](const std::string& setting) {
    edits_.reset(setting);
    show_changes();
  });
  connect(list_, &ParameterList::reset_tissue_asked, this, [this](const std::string& tissue) {
    for (const anatomy::TissueParameterGroup& group : edits_.groups())
      if (group.name == tissue) edits_.reset(group);
    show_changes();
  });
  connect(list_, &ParameterList::opened, this, [this] {
    show_values();
    // The positions of the rows are known after the layout.
    QTimer::singleShot(0, this, &ParameterPanel::scroll_to_opened);
  });
  connect(profiles_, &ParameterProfiles::chosen, this, &ParameterPanel::choose_profile);
  connect(profiles_, &ParameterProfiles::save_asked, this, &ParameterPanel::save_profile_as);
  connect(profiles_, &ParameterProfiles::listed, this, &ParameterPanel::show_values);
  set_profile_folder(user_config_folder() / "profiles");
  show_case(nullptr);
}

QWidget* ParameterPanel::make_head() {
  auto* head = new QWidget;
  auto* layout = new QHBoxLayout(head);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(6);
  layout->addWidget(make_label(tr("Tissues"), "heading"), 1);
  undo_buttons_.emplace(
      "parameter", *this, [this] { undo(); }, [this] { redo(); });
  undo_buttons_->add_to(*layout);
  reset_ = make_tool_button("parameter-reset-all", tr("Reset all"), tr("Reset all parameters to those of the case"));
  connect(reset_, &QToolButton::clicked, this, [this] {
    edits_.reset_all();
    show_changes();
  });
  reset_->setFocusPolicy(Qt::StrongFocus);
  layout->addWidget(reset_);
  return head;
}

void ParameterPanel::show_case(std::shared_ptr<const cases::OpenCase> open_case) {
  case_ = std::move(open_case);
  empty_->setVisible(case_ == nullptr);
  body_->setVisible(case_ != nullptr);
  preview_->show_case(case_);
  edits_.start(case_ ? case_->the_case.tissues : anatomy::TissueTable{}, to_std(preview_->model()));
  list_->show_model(preview_->model());
  list_->show_tissues(edits_.groups(), case_ ? case_->pieces : std::vector<cases::PathPiece>{});
  // A server that has just loaded the case uses the numbers of the case.
  sent_.clear();
  show_changes();
}

QStringList ParameterPanel::settings() const {
  QStringList list;
  for (const std::string& setting : edits_.settings()) list << to_qt(setting);
  return list;
}

Status ParameterPanel::apply_settings(const QStringList& settings) {
  TROCAR_TRY_STATUS(edits_.replace(texts_of(settings)));
  show_changes();
  return {};
}

void ParameterPanel::edit(const std::string& setting, double value, bool joins) {
  const Status done = edits_.set(setting, value, joins);
  if (done) {
    show_changes();
  } else {
    show_values();
    list_->show_refusal(setting, shown(done.error().what));
  }
}

void ParameterPanel::undo() {
  edits_.undo();
  show_changes();
}

void ParameterPanel::redo() {
  edits_.redo();
  show_changes();
}

void ParameterPanel::show_changes() {
  show_model();
  show_values();
  changed_at_ = std::chrono::steady_clock::now();
}

/// Undo or a profile can change the model.
void ParameterPanel::show_model() {
  const QString model = to_qt(edits_.model());
  if (model == preview_->model()) return;
  preview_->choose_model(model);
  list_->show_model(model);
  Q_EMIT model_changed(model);
}

void ParameterPanel::show_values() {
  if (!edits_.profile().empty() && profiles_->find(edits_.profile()) == nullptr)
    edits_.forget_profile(edits_.profile());
  profiles_->show_chosen(edits_.profile(), edits_.differs_from_profile());
  list_->show_values(edits_);
  undo_buttons_->show(edits_.can_undo(), edits_.can_redo());
  reset_->setEnabled(edits_.is_changed());
}

void ParameterPanel::set_profile_folder(const std::filesystem::path& folder) {
  profiles_->set_folder(folder);
}

void ParameterPanel::choose_profile(const std::string& file) {
  if (!case_) return;
  cases::TissueProfile profile;  // The case's own.
  if (const cases::TissueProfile* found = profiles_->find(file)) profile = *found;
  if (profile.force_model.empty()) profile.force_model = case_->force_model;
  Status done;
  if (preview_->offers(to_qt(profile.force_model))) {
    done = edits_.choose_profile(file, profile.overrides, profile.force_model);
  } else {
    done = fail_usage("there is no force model \"" + profile.force_model + "\"", file,
                      "write insertion, proxy or combined");
  }
  if (done) {
    show_changes();
  } else {
    show_values();
  }
  profiles_->show_problem(done ? QString()
                               : tr("“%1” was not applied: %2").arg(to_qt(profile.name), shown(done.error().text())));
}

void ParameterPanel::save_profile_as(cases::TissueProfile profile, bool may_replace) {
  if (!case_) return;
  profile.force_model = edits_.model();
  profile.overrides = edits_.settings();
  profile.file = cases::profile_file(profiles_->folder(), profile.name);
  const Status saved = cases::save_profile(profile, case_->the_case.tissues, profiles_->folder(), may_replace);
  if (!saved) {
    profiles_->show_problem(shown(saved.error().text()));
    return;
  }
  profiles_->finish_saving(profile);
  edits_.call_profile(profile.file.string());
  show_values();
}

/// Scrolls as little as necessary to show the whole tissue, at least its header; not if the header is already near the
/// top.
void ParameterPanel::scroll_to_opened() {
  constexpr int kMargin_px = 4;
  const QRect opened = list_->chosen_rect();
  QScrollBar* bar = scroll_->verticalScrollBar();
  const int header = opened.top() - bar->value();
  if (opened.isNull() || (header >= 0 && header < scroll_->viewport()->height() / 4)) return;
  const int lowest = opened.bottom() + kMargin_px - scroll_->viewport()->height();
  bar->setValue(std::min(std::max(bar->value(), lowest), opened.top() - kMargin_px));
}

void ParameterPanel::advance() {
  if (changed_at_ && std::chrono::steady_clock::now() - *changed_at_ >= kQuiet) {
    changed_at_.reset();
    preview_->show_settings(edits_.settings());
    const QStringList now = settings();
    if (now != sent_) {
      sent_ = now;
      Q_EMIT parameters_changed(now);
    }
  }
  preview_->advance();
}

bool ParameterPanel::is_settled() const noexcept {
  return !changed_at_ && preview_->is_settled();
}

QSize ParameterPanel::sizeHint() const {
  return {340, 700};
}

}  // namespace trocar::trainer
