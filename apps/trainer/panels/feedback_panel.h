#pragma once

#include <QWidget>
#include <span>

#include "scoring/score.h"

class QGridLayout;
class QLabel;
class QPushButton;
class QScrollArea;
class QVBoxLayout;

namespace trocar::attempt {
struct GunShot;
}

namespace trocar::trainer {

class CorePicture;
class ExpertPathList;
class HintList;
class ScoreDial;

/// Result of an attempt, in the order of reading: harm to the patient, passed or not and why, score, improvements,
/// parts of the score. Keys: Ctrl+R tries again or begins another exam, W shows the worst moment, H the moment of the
/// next hint.
class FeedbackPanel : public QWidget {
  Q_OBJECT

 public:
  explicit FeedbackPanel(QWidget* parent = nullptr);

  /// Shows the outcome, scrolled to the top. `worst_moment`: empty if there is none.
  void show_outcome(const scoring::Outcome& outcome, const QString& worst_moment);
  /// Shows the level of help of the attempt beside the score; empty: unknown.
  void show_level(const QString& level);
  /// Shows the image of the cores; empty: the gun was not fired.
  void show_cores(std::span<const attempt::GunShot> shots);
  /// Events during the attempt: warnings, interruptions, changed parameters. One line each.
  void show_notes(const QStringList& notes);
  /// Compares the score with the person's others and with those of peers and experts; empty: nobody practises.
  void show_comparison(const QString& text);
  /// Shows what to practise next and why; empty: nothing.
  void show_next(const QString& text);
  /// Names the button of again_requested: "Next exam" (`is_next_exam`: it draws another body) or "Try again".
  void show_again(bool is_next_exam);
  /// Shows where the signed result of an exam lies, or why there is none; empty: no exam.
  void show_result(const QString& text);
  HintList& hints() noexcept { return *hints_; }
  ExpertPathList& expert_paths() noexcept { return *expert_paths_; }

 Q_SIGNALS:
  void again_requested();
  void other_case_requested();
  void report_requested();
  void worst_requested();

 private:
  QWidget* make_buttons();
  void show_verdict(const scoring::Outcome& outcome);
  void show_parts(const std::vector<scoring::ScorePart>& parts);

  QScrollArea* scroll_ = nullptr;
  QPushButton* again_button_ = nullptr;
  QPushButton* worst_button_ = nullptr;
  ScoreDial* dial_ = nullptr;
  QLabel* level_ = nullptr;
  QLabel* alarm_ = nullptr;
  QLabel* verdict_ = nullptr;
  QGridLayout* parts_ = nullptr;
  QLabel* reasons_ = nullptr;
  QLabel* score_heading_ = nullptr;
  HintList* hints_ = nullptr;
  QLabel* core_ = nullptr;
  QLabel* harm_ = nullptr;
  CorePicture* core_picture_ = nullptr;
  ExpertPathList* expert_paths_ = nullptr;
  QLabel* worst_ = nullptr;
  QLabel* notes_ = nullptr;
  QLabel* result_ = nullptr;
  QLabel* comparison_ = nullptr;
  QLabel* next_title_ = nullptr;
  QLabel* next_ = nullptr;
};

}  // namespace trocar::trainer
