#pragma once

#include <QWidget>
#include <optional>
#include <vector>

#include "anatomy/patient.h"

namespace trocar::trainer {

class SliceView;

/// Lies over a slice viewer and marks what a case is made of beside the plan: the target and landmarks; faint where
/// they lie beside the slice. Lets the mouse through.
class SliceMarks : public QWidget {
  Q_OBJECT

 public:
  explicit SliceMarks(SliceView* view);

  void set_target(const std::optional<Vec3>& p_P);
  void set_landmarks(const std::vector<Landmark>& landmarks);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  /// Away from the slice's plane, mm.
  double away_mm(const Vec3& p_P) const;

  SliceView* view_;
  std::optional<Vec3> target_P_;
  std::vector<Landmark> landmarks_;
};

}  // namespace trocar::trainer
