#pragma once

#include <QWidget>
#include <optional>
#include <vector>

#include "scoring/score.h"

class QPushButton;
class QVBoxLayout;

namespace trocar::trainer {

/// Advice of a score, most important first. A hint with a moment of the attempt is a button that shows the moment in
/// the replay. Object names: hint-N, N counts from 1.
class HintList : public QWidget {
  Q_OBJECT

 public:
  explicit HintList(QWidget* parent = nullptr);

  void show_hints(const std::vector<scoring::Hint>& hints);
  /// Chooses the next hint with a moment, after the last one the first; no effect without such a hint.
  void choose_next();

 Q_SIGNALS:
  void moment_chosen(double time_s);

 private:
  struct Moment {
    double time_s = 0.0;
    QPushButton* row = nullptr;
  };
  void add_row(int number, const scoring::Hint& hint);
  void choose(std::size_t moment);

  QVBoxLayout* rows_ = nullptr;
  std::vector<Moment> moments_;
  std::optional<std::size_t> chosen_;
};

}  // namespace trocar::trainer
