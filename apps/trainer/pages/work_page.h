#pragma once

#include <QWidget>

class QStackedWidget;

namespace trocar::trainer {

class FeedbackPanel;
class ForcePlot;
class ParameterPanel;
class PatientView;
class PuncturePanel;
class TimeLine;
class UltrasoundView;
class Workspace;
class XrayView;

/// The views, with a side panel: figures and tools during the puncture, score and replay afterwards.
class WorkPage : public QWidget {
  Q_OBJECT

 public:
  explicit WorkPage(QWidget* parent = nullptr);

  Workspace& workspace() noexcept { return *workspace_; }
  /// Views for attempt and replay.
  PatientView& view_3d() noexcept { return *view_3d_; }
  UltrasoundView& ultrasound() noexcept { return *ultrasound_; }
  XrayView& xray() noexcept { return *xray_; }
  ForcePlot& forces() noexcept { return *forces_; }
  PuncturePanel& puncture() noexcept { return *puncture_; }
  FeedbackPanel& feedback() noexcept { return *feedback_; }
  ParameterPanel& parameters() noexcept { return *parameters_; }
  TimeLine& time_line() noexcept { return *time_line_; }

  void show_puncture();
  void show_feedback();
  /// Locked: the parameter panel stays closed and has no effect.
  void set_parameters_locked(bool are_locked);
  /// False if it is locked.
  bool toggle_parameters();
  bool are_parameters_shown() const;
  bool are_parameters_locked() const noexcept { return are_parameters_locked_; }
  /// Returns false, so that a wrapped text in a panel does not reduce the height of the bars above and below the page.
  bool hasHeightForWidth() const override { return false; }

 protected:
  void resizeEvent(QResizeEvent* event) override;
  void changeEvent(QEvent* event) override;

 private:
  void fit();

  Workspace* workspace_ = nullptr;
  PatientView* view_3d_ = nullptr;
  UltrasoundView* ultrasound_ = nullptr;
  XrayView* xray_ = nullptr;
  ForcePlot* forces_ = nullptr;
  QStackedWidget* side_ = nullptr;
  PuncturePanel* puncture_ = nullptr;
  FeedbackPanel* feedback_ = nullptr;
  ParameterPanel* parameters_ = nullptr;
  bool are_parameters_locked_ = false;
  TimeLine* time_line_ = nullptr;
};

}  // namespace trocar::trainer
