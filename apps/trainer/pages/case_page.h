#pragma once

#include <QWidget>
#include <memory>
#include <string>
#include <vector>

#include "case_builder/case_editor.h"
#include "case_panels/case_panel.h"

class QLabel;
class QProgressBar;
class QPushButton;
class QStackedWidget;
class QVBoxLayout;

namespace trocar::trainer {

class CheckList;
class CaseViews;

/// The case builder for instructors: seven steps at the left (import, labels, target and risks, entry and path, forces,
/// recorded ultrasound, save), images (CaseViews), and a list of checks. A click in an image sets the item of the
/// selected tool; a left drag moves it. Landmarks are shown in slices and in 3D (key I).
/// Keys: Ctrl+Z undo, Ctrl+Shift+Z redo, Alt+1..7 steps, Ctrl+T target, Ctrl+L landmark, Ctrl+E entry zone, Ctrl+P
/// plan, Ctrl+1 entry, Ctrl+2 tip, Ctrl+U landmark pair, Ctrl+S save, Esc deselects the tool.
class CasePage : public QWidget {
  Q_OBJECT

 public:
  explicit CasePage(QWidget* parent = nullptr);
  ~CasePage() override;

  /// Call once per frame.
  void advance();
  /// False if a case would be lost and the user, who is asked, keeps it. `question`: what is about to happen.
  bool may_discard(const QString& question);
  case_builder::CaseEditor& editor() noexcept { return *editor_; }

 Q_SIGNALS:
  /// "Open this case" was pressed: the patient folder with its task.
  void case_saved(QString patient_folder);

 protected:
  void keyPressEvent(QKeyEvent* event) override;

 private:
  QWidget* make_head();
  QWidget* make_steps();
  QWidget* make_views();
  QWidget* make_foot();
  void add_panel(CasePanel* panel, const QString& title);
  void go_to(int step);
  void refresh();
  void refresh_foot();
  void set_click(CaseClick click);
  void show_hint();
  std::string click_name() const;
  void click_at(const Vec3& p_P, bool is_drag);
  void click_ultrasound_at(const Vec3& p_U, bool is_drag);
  Result<case_builder::CaseDraft> clicked_draft(const Vec3& p_P) const;

  std::unique_ptr<case_builder::CaseEditor> editor_;
  std::vector<QPushButton*> steps_;
  std::vector<CasePanel*> panels_;
  QStackedWidget* stack_ = nullptr;
  QLabel* step_title_ = nullptr;
  QPushButton* undo_ = nullptr;
  QPushButton* redo_ = nullptr;
  QLabel* message_ = nullptr;
  QLabel* click_text_ = nullptr;
  QProgressBar* progress_ = nullptr;
  QPushButton* cancel_ = nullptr;
  CheckList* checks_ = nullptr;
  CaseViews* views_ = nullptr;
  /// State displayed by the panels; initially empty.
  struct Shown {
    std::uint64_t version = ~std::uint64_t{0};
    bool is_reviewed = false;
    case_builder::CaseEditor::Work work = case_builder::CaseEditor::Work::kNone;
    const anatomy::VirtualPatient* patient = nullptr;
    std::string message;
    bool operator==(const Shown&) const = default;
  };
  Shown shown_;
  CaseClick click_ = CaseClick::kLook;
  int clicks_ = 0;
};

}  // namespace trocar::trainer
