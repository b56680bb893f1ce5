#pragma once

#include <QString>
#include <QWidget>
#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cases/force_curve.h"
#include "cases/open_case.h"
#include "core/background_job.h"

class QComboBox;
class QLabel;

namespace trocar::trainer {

class ForcePlot;

/// The force that a model predicts along the planned path: the default's faint, with changed numbers strong. Computed
/// in the background; of several changes only the newest counts. Object names: parameter-model (choice), force-plot,
/// parameter-preview-error.
class ForcePreview : public QWidget {
  Q_OBJECT

 public:
  explicit ForcePreview(QWidget* parent = nullptr);
  ~ForcePreview() override;

  /// Null: nothing to show. Chooses the case's force model.
  void show_case(std::shared_ptr<const cases::OpenCase> open_case);
  /// What differs from the case's numbers; the curve follows.
  void show_settings(std::vector<std::string> settings);
  /// Looks at the work in the background; once a frame.
  void advance();

  QString model() const;
  bool offers(const QString& model) const;
  /// One that it offers, chosen by the program: model_changed is not told.
  void choose_model(const QString& model);
  /// Whether the curves are those of what was last asked for.
  bool is_settled() const noexcept { return !is_wanted_ && !job_.has_work() && !default_job_.has_work(); }
  /// As shown; empty until it is there.
  const std::vector<cases::CurvePoint>& changed_curve() const noexcept { return changed_; }
  const std::vector<cases::CurvePoint>& default_curve() const;

 Q_SIGNALS:
  /// A person has chosen another.
  void model_changed(QString model);

 private:
  void want();
  void start_work();
  void take_work();
  void show_curves();
  void show_bands();
  void show_busy(bool is_busy);
  void show_error(const QString& text);

  std::shared_ptr<const cases::OpenCase> case_;
  std::vector<std::string> settings_;
  std::map<std::string, std::vector<cases::CurvePoint>> defaults_;  ///< By model.
  std::vector<cases::CurvePoint> changed_;
  bool is_wanted_ = false;  ///< Work that has not been started yet.
  BackgroundJob<std::vector<cases::CurvePoint>> job_, default_job_;
  std::string default_model_;  ///< Of default_job_.
  RetiredJobs retired_;
  QComboBox* model_;
  ForcePlot* plot_;
  QLabel* caption_;
  QLabel* refusal_;
};

}  // namespace trocar::trainer
