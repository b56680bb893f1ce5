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

/// The force that a model predicts along the planned path: faint for the default numbers, strong for the changed
/// numbers. Computed in the background; of several changes only the newest is used. Object names: parameter-model
/// (choice), force-plot, parameter-preview-error.
class ForcePreview : public QWidget {
  Q_OBJECT

 public:
  explicit ForcePreview(QWidget* parent = nullptr);
  ~ForcePreview() override;

  /// Selects the case's force model. Null: no case.
  void show_case(std::shared_ptr<const cases::OpenCase> open_case);
  /// Sets the differences from the case's numbers; the curve is updated.
  void show_settings(std::vector<std::string> settings);
  /// Polls the background work; call once per frame.
  void advance();

  QString model() const;
  bool offers(const QString& model) const;
  /// Selects one of the offered models without emitting model_changed.
  void choose_model(const QString& model);
  /// True if the curves are those of the last request.
  bool is_settled() const noexcept { return !is_wanted_ && !job_.has_work() && !default_job_.has_work(); }
  /// The displayed curve; empty until it is computed.
  const std::vector<cases::CurvePoint>& changed_curve() const noexcept { return changed_; }
  const std::vector<cases::CurvePoint>& default_curve() const;

 Q_SIGNALS:
  /// The user has selected another model.
  void model_changed(QString model);

 private:
  void request();
  void start_work();
  void take_work();
  void show_curves();
  void show_bands();
  void show_busy(bool is_busy);
  void show_error(const QString& text);

  std::shared_ptr<const cases::OpenCase> case_;
  std::vector<std::string> settings_;
  std::map<std::string, std::vector<cases::CurvePoint>> defaults_;  ///< Key: model.
  std::vector<cases::CurvePoint> changed_;
  bool is_wanted_ = false;  ///< A request that has not been started yet.
  BackgroundJob<std::vector<cases::CurvePoint>> job_, default_job_;
  std::string default_model_;  ///< Model of default_job_.
  RetiredJobs retired_;
  QComboBox* model_;
  ForcePlot* plot_;
  QLabel* caption_;
  QLabel* refusal_;
};

}  // namespace trocar::trainer
