#pragma once

#include <QWidget>
#include <optional>
#include <vector>

#include "attempt/live/attempt_view.h"

class QGridLayout;
class QLabel;
class QToolButton;

namespace trocar::trainer {

/// Steps of the procedure: done ones with a tick and a button that repeats them, the current one with what it lacks and
/// the reason for it, later ones dim. Folded, it shows the last done step, the current one and the next one. A finished
/// step is confirmed in the heading for kConfirmed_s. Hidden without steps. Object names: steps, steps-heading,
/// steps-fold, step-N, step-N-repeat, step-lacks, step-why, step-stuck; N counts from 1.
class StepList : public QWidget {
  Q_OBJECT

 public:
  explicit StepList(QWidget* parent = nullptr);

  static constexpr double kConfirmed_s = 4.0;  ///< Session time.
  /// `time_s`: session time. Without `has_help` only titles and ticks are shown. Cheap if nothing has changed. `stuck`:
  /// help for the current step, after the reason.
  void show_steps(const std::vector<attempt::PhaseView>& steps, std::optional<std::size_t> current, double time_s,
                  bool has_help, const QString& stuck = {});
  /// Folded or not, until the user presses the fold button; from then on the user's choice stays.
  void propose_folded(bool is_folded);
  bool is_folded() const noexcept { return is_folded_; }

 Q_SIGNALS:
  void repeat_requested(std::size_t step);

 private:
  struct Step {
    attempt::PhaseView phase;
    bool is_confirmed = false;  ///< Done a moment ago.
  };
  struct Row {
    QLabel* mark = nullptr;
    QLabel* title = nullptr;
    QToolButton* repeat = nullptr;
  };
  void make_rows();
  void update_rows();
  void update_heading();
  bool is_row_shown(std::size_t step) const;
  void set_folded(bool is_folded);

  std::vector<Step> steps_;
  std::optional<std::size_t> current_;
  bool has_help_ = false, is_folded_ = false, is_chosen_ = false;
  QLabel* heading_ = nullptr;
  QToolButton* fold_ = nullptr;
  QGridLayout* grid_ = nullptr;
  std::vector<Row> rows_;
  QLabel* lacks_ = nullptr;
  QLabel* why_ = nullptr;
  QLabel* stuck_ = nullptr;
};

}  // namespace trocar::trainer
