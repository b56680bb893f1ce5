#pragma once

#include <QWidget>
#include <vector>

class QCheckBox;
class QGridLayout;
class QLabel;

namespace trocar::trainer {

/// The expert paths of a case with the distances of the attempt from each: legend of the paths in slices and 3D. Hidden
/// without rows. Object names: expert-paths, expert-path-N, show-expert-paths; N counts from 1.
class ExpertPathList : public QWidget {
  Q_OBJECT

 public:
  struct Row {
    QString name;
    double frechet_mm = 0.0, hausdorff_mm = 0.0;
    bool is_nearest = false;
  };
  explicit ExpertPathList(QWidget* parent = nullptr);

  void show_rows(const std::vector<Row>& rows);
  /// True if the user has not hidden the other paths.
  bool are_others_shown() const;

 Q_SIGNALS:
  void others_toggled(bool are_shown);

 private:
  QGridLayout* grid_ = nullptr;
  QCheckBox* others_ = nullptr;
};

}  // namespace trocar::trainer
