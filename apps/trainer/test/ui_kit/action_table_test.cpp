#include "ui_kit/action_table.h"

#include <gtest/gtest.h>

#include <QComboBox>
#include <QCoreApplication>
#include <QDialog>
#include <QDockWidget>
#include <QFile>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QSettings>
#include <QTimer>
#include <algorithm>
#include <map>
#include <set>

#include "core/testing/source_dir.h"
#include "pages/work_page.h"
#include "shell/keys_dialog.h"
#include "ui_kit/page_keys.h"
#include "workspace/workspace.h"

namespace trocar::trainer {
namespace {

using Pair = std::pair<Action, Action>;

/// Actions that share a key because they are never offered together, with the reason.
const std::set<Pair> kNeverTogether = {
    {Action::kLoad, Action::kStylet},    // a biopsy gun has no stylet of its own
    {Action::kFire, Action::kMark},      // the finger or the needle is the active tool
    {Action::kFire, Action::kConfirm},   // an open question has the key
    {Action::kMark, Action::kConfirm},   // an open question has the key
    {Action::kUndoHere, Action::kUndo},  // the panels are not in the case builder
    {Action::kRedoHere, Action::kRedo},  // the panels are not in the case builder
};

QKeyEvent event_of(const QKeySequence& keys) {
#if QT_VERSION >= QT_VERSION_CHECK(6, 0, 0)
  return {QEvent::KeyPress, keys[0].key(), keys[0].keyboardModifiers()};
#else
  const int key = keys[0];
  return {QEvent::KeyPress, static_cast<int>(key & ~Qt::KeyboardModifierMask),
          Qt::KeyboardModifiers(key & static_cast<int>(Qt::KeyboardModifierMask))};
#endif
}

std::vector<const ActionRow*> rows_of(std::initializer_list<Scope> scopes) {
  std::vector<const ActionRow*> rows;
  for (const ActionRow& row : action_table())
    if (std::ranges::find(scopes, row.scope) != scopes.end()) rows.push_back(&row);
  return rows;
}

void expect_no_conflict(std::initializer_list<Scope> scopes) {
  const std::vector<const ActionRow*> rows = rows_of(scopes);
  for (std::size_t a = 0; a < rows.size(); ++a) {
    for (std::size_t b = a + 1; b < rows.size(); ++b) {
      if (kNeverTogether.contains({rows[a]->action, rows[b]->action})) continue;
      for (const QKeySequence& key : keys_of(rows[a]->action))
        EXPECT_EQ(std::ranges::count(keys_of(rows[b]->action), key), 0)
            << key.toString().toStdString() << ": " << rows[a]->does << " / " << rows[b]->does;
    }
  }
}

TEST(ActionTable, HasEachActionOnce) {
  std::map<Action, int> rows;
  for (const ActionRow& row : action_table()) ++rows[row.action];
  for (int n = 0; n <= static_cast<int>(Action::kRedoHere); ++n) EXPECT_EQ(rows[static_cast<Action>(n)], 1) << n;
}

TEST(ActionTable, EveryKeyFindsItsAction) {
  for (const ActionRow& row : action_table()) {
    EXPECT_FALSE(keys_text(row.action).isEmpty()) << row.does;
    EXPECT_FALSE(does_text(row.action).endsWith(QLatin1Char('.'))) << row.does;
    int number = 0;
    for (const QKeySequence& key : keys_of(row.action)) {
      ASSERT_EQ(key.count(), 1) << row.does;
      ASSERT_NE(key.toString(), QString()) << row.does;
      const auto found = find_action(row.scope, event_of(key), [&](Action action) { return action == row.action; });
      ASSERT_TRUE(found) << row.does << ": " << key.toString().toStdString();
      EXPECT_EQ(found->key, number++) << row.does;
    }
  }
}

TEST(ActionTable, MatchesSymbolsWithAnyShiftStateAndOnTheKeypad) {
  const QKeyEvent shifted(QEvent::KeyPress, Qt::Key_Plus, Qt::ShiftModifier);
  EXPECT_EQ(find_action(Scope::kView3d, shifted)->action, Action::kZoom3d);
  const QKeyEvent french(QEvent::KeyPress, Qt::Key_3, Qt::ShiftModifier);
  EXPECT_EQ(find_action(Scope::kView3d, french)->key, 2);
  const QKeyEvent keypad(QEvent::KeyPress, Qt::Key_Enter, Qt::KeypadModifier);
  EXPECT_EQ(find_action(Scope::kPuncture, keypad)->action, Action::kFire);
  const QKeyEvent letter(QEvent::KeyPress, Qt::Key_H, Qt::ShiftModifier);
  EXPECT_FALSE(find_action(Scope::kPuncture, letter));
}

TEST(ActionTable, HasNoKeyConflictsWithinAPage) {
  for (const Scope page : {Scope::kStart, Scope::kBriefing}) expect_no_conflict({Scope::kWindow, page});
  expect_no_conflict({Scope::kWindow, Scope::kPanel, Scope::kCaseBuilder});
  for (const Scope page : {Scope::kPuncture, Scope::kFeedback})
    expect_no_conflict({Scope::kWindow, Scope::kWork, Scope::kPanel, page});
  for (const Scope view : {Scope::kView3d, Scope::kSlices, Scope::kUltrasound, Scope::kForcePlot, Scope::kTimeLine})
    expect_no_conflict({Scope::kWindow, Scope::kPanel, view});
}

/// Space, and the letters and Enter that act on the patient, are never taken by a view that has the focus, except P.
TEST(ActionTable, ReservesPatientKeysInEveryView) {
  for (const ActionRow* row : rows_of({Scope::kPuncture})) {
    if (!row->acts_on_patient && row->action != Action::kForces && row->action != Action::kEnd) continue;
    for (const QKeySequence& key : keys_of(row->action))
      for (const Scope view : {Scope::kView3d, Scope::kSlices, Scope::kUltrasound, Scope::kForcePlot})
        EXPECT_FALSE(find_action(view, event_of(key))) << row->does;
  }
}

TEST(ActionTable, MatchesTheKeysPage) {
  QFile page(QString::fromStdString((testing::source_dir() / "docs/keys.md").string()));
  ASSERT_TRUE(page.open(QIODevice::ReadOnly));
  EXPECT_TRUE(QString::fromUtf8(page.readAll()).contains(actions_as_markdown()))
      << "replace the table in docs/keys.md with what trocar-trainer --keys prints:\n"
      << actions_as_markdown().toStdString();
}

/// Views, buttons and pages: a key that acts on the patient works there. Everything else edits or chooses.
bool is_view_or_button(const QWidget& widget) {
  if (qobject_cast<const QAbstractButton*>(&widget) != nullptr) return true;
  for (const char* view : {"PatientView", "SliceView", "UltrasoundView", "XrayView", "ForcePlot", "TimeLine",
                           "WorkPage", "StructurePanel"})
    if (widget.inherits((std::string("trocar::trainer::") + view).c_str())) return true;
  return widget.inherits("QVTKOpenGLNativeWidget") || widget.metaObject() == &QWidget::staticMetaObject;
}

/// Every dangerous key with the focus on every widget that takes it, in the real page with all its views.
TEST(ActionKeys, PatientKeysDoNothingInTextFieldsAndLists) {
  QSettings().clear();
  WorkPage page;
  page.resize(1600, 1000);
  page.show();
  for (QDockWidget* dock : page.findChildren<QDockWidget*>()) dock->show();
  page.toggle_parameters();
  QCoreApplication::processEvents();
  page.activateWindow();
  std::set<std::string> edits, acts;
  for (QWidget* widget : page.findChildren<QWidget*>()) {
    if (widget->focusPolicy() == Qt::NoFocus || widget->focusProxy() != nullptr || !widget->isEnabled()) continue;
    widget->setFocus();
    if (page.focusWidget() != widget) continue;  // not visible
    KeyPlace place;
    PageKeys keys(page, [&](const QKeyEvent&, const KeyPlace& at) {
      place = at;
      return true;
    });
    const bool acts_here = is_view_or_button(*widget);
    const std::string name = std::string(widget->metaObject()->className()) + " " + widget->objectName().toStdString();
    (acts_here ? acts : edits).insert(widget->metaObject()->className());
    for (const ActionRow* row : rows_of({Scope::kPuncture})) {
      if (!row->acts_on_patient) continue;
      for (const QKeySequence& key : keys_of(row->action)) {
        QKeyEvent event = event_of(key);
        QCoreApplication::sendEvent(widget, &event);
        const bool is_done = judge_key(*row, event, place) == KeyVerdict::kPerform;
        EXPECT_EQ(is_done, acts_here) << name << ": " << row->does;
      }
    }
  }
  EXPECT_GE(edits.size(), 3U) << "combo boxes, sliders, lists";
  EXPECT_GE(acts.size(), 4U) << "views and buttons";
}

TEST(KeysDialog, FitsASmallWindowAndFilters) {
  QWidget window;
  window.resize(1024, 768);
  window.show();
  int all = 0, of_stylet = 0;
  QSize size;
  QTimer::singleShot(0, &window, [&] {
    auto* dialog = window.findChild<QDialog*>(QStringLiteral("keys"));
    const auto visible_rows = [&] {
      const auto labels = dialog->findChildren<QLabel*>();
      return static_cast<int>(std::ranges::count_if(labels, [](const QLabel* label) {
        return label->isVisible() && label->property("role") == QStringLiteral("badge");
      }));
    };
    size = dialog->size();
    all = visible_rows();
    dialog->findChild<QLineEdit*>(QStringLiteral("keys-filter"))->setText(QStringLiteral("stylet"));
    of_stylet = visible_rows();
    dialog->accept();
  });
  show_keys(&window);
  EXPECT_LE(size.width(), 1024);
  EXPECT_LE(size.height(), 768);
  EXPECT_EQ(all, static_cast<int>(action_table().size()));
  EXPECT_EQ(of_stylet, 1);
}

}  // namespace
}  // namespace trocar::trainer
