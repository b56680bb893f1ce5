#pragma once

#include <QObject>
#include <QProcess>
#include <QString>

#include "geometry/vec.h"

namespace trocar::trainer {

/// State of a device under test.
struct DeviceCheckView {
  enum class State { kStarting, kAnswers, kUnplugged, kFailed };
  State state = State::kStarting;
  QString text;     ///< Device title, or the reason why it does not respond, as a sentence.
  QString details;  ///< The whole error.
  bool has_force = false;
  double push_n = 0.0;  ///< Magnitude of the force of push().
  bool has_pose = false;
  Vec3 p_D = Vec3::Zero(), axis_D = Vec3::UnitZ();  ///< Grip (mm) and direction of the stylus.
  double moved_mm = 0.0;                            ///< Largest distance from its first position.
  unsigned buttons = 0;
  double force_n = 0.0;       ///< Present force.
  double strongest_n = 0.0;   ///< Largest force since the last push was requested.
  bool is_push_over = false;  ///< The last push has ended.
  QString stop_reason;        ///< Fault with which the safety gate refused or ended the last push; empty: none.
};

/// Tests a device without a patient with a separate trocar-hapticd --test: connection, pose, a small force on request.
/// The destructor releases the device.
class DeviceCheck : public QObject {
  Q_OBJECT

 public:
  /// `is_calibrating`: the device is calibrated first; a person must hold it in the calibration position.
  DeviceCheck(const QString& spec, bool is_calibrating, QObject* parent = nullptr);
  ~DeviceCheck() override;

  const DeviceCheckView& view() const noexcept { return view_; }
  void push();

 Q_SIGNALS:
  void changed();

 private:
  void read_lines();
  void read_device(const QStringList& fields);
  void read_state(const QStringList& fields);
  void note_end();
  void fail_with(const QString& text, const QString& details);

  QProcess process_;
  DeviceCheckView view_;
  Vec3 first_p_D_ = Vec3::Zero();
  int pushes_ = 0;  ///< Requested.
};

}  // namespace trocar::trainer
