#pragma once

#include <QObject>
#include <QProcess>
#include <QString>

#include "geometry/vec.h"

namespace trocar::trainer {

/// What is known of a device that is being tried out.
struct DeviceCheckView {
  enum class State { kStarting, kAnswers, kUnplugged, kFailed };
  State state = State::kStarting;
  QString text;     ///< The device's title, or the reason why it does not answer, as a sentence.
  QString details;  ///< The whole error.
  bool has_force = false;
  double push_n = 0.0;  ///< Size of the force that push() gives.
  bool has_pose = false;
  Vec3 p_D = Vec3::Zero(), axis_D = Vec3::UnitZ();  ///< Grip (mm) and direction of the stylus.
  double moved_mm = 0.0;                            ///< The furthest from where it was first seen.
  unsigned buttons = 0;
  double force_n = 0.0;      ///< Given now.
  double strongest_n = 0.0;  ///< Since the start.
};

/// Tests a device without a patient with a separate trocar-hapticd --test: connection, pose, a small force on request.
/// The destructor releases the device.
class DeviceCheck : public QObject {
  Q_OBJECT

 public:
  /// `is_calibrating`: the device is calibrated first; somebody holds it where that is right.
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
};

}  // namespace trocar::trainer
