#pragma once

#include <QObject>
#include <QVariantMap>
#include <filesystem>
#include <memory>

#include "attempt/record/attempt_replay.h"
#include "cases/open_case.h"
#include "choice/trainer_choice.h"
#include "ui_kit/page_keys.h"

namespace trocar::trainer {

class WorkPage;

/// A recorded attempt in the workspace: the time line moves the needle in all views, with score and hints beside them.
class ReplayControl : public QObject {
  Q_OBJECT

 public:
  /// `warnings`: those of the attempt that has just ended, see RunResult.
  ReplayControl(attempt::AttemptReplay replay, std::shared_ptr<const cases::OpenCase> open, WorkPage& page,
                const std::vector<std::string>& warnings = {});
  ~ReplayControl() override;

  /// Call once per frame.
  void advance(double dt_s);
  void go_to_worst();
  /// Pauses and shows the moment; clamped to the recording.
  void go_to(double time_s);
  Status save_report(const std::filesystem::path& file) const;
  QVariantMap facts() const;

 private:
  bool take_key(const QKeyEvent& key, const KeyPlace& place);
  void fill_plot();
  void fill_time_line();
  void show_at(double time_s, bool is_moving);
  void show_xray(double time_s);
  void show_expert_paths();
  Pose transducer_at(double time_s) const;

  attempt::AttemptReplay replay_;
  std::shared_ptr<const cases::OpenCase> open_;
  WorkPage& page_;
  PageKeys keys_;
  double shown_s_ = -1.0;
  double still_s_ = 1.0;  ///< Time since the replay time last changed.
};

}  // namespace trocar::trainer
