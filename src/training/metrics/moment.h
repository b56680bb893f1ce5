#pragma once

#include <cstdint>
#include <optional>

#include "geometry/pose.h"
#include "tasks/xray_use.h"
#include "telemetry/tick_sample.h"

namespace trocar::metrics {

/// One moment of a recording of any system. Frame P (LPS, mm). Only time and needle are required.
struct Moment {
  double time_s = 0.0;  ///< Time of the recording.
  Vec3 tip_P = Vec3::Zero();
  Vec3 axis_P = Vec3::UnitZ();  ///< Hub to tip.
  /// The same in the anatomy at rest, frame A; missing: the patient does not move. What is compared with labels, CT or
  /// a plan uses tip_A() and axis_A(); the motion of the hand and the image plane are in P.
  std::optional<Vec3> rest_tip_A, rest_axis_A;
  std::optional<Mat3> R_PN;  ///< Orientation of the needle with its roll: +y to the bevel's face.
  /// Depth of the tip below the resting skin along the shaft, 0 outside. MeasureRun finds it in the patient if it is
  /// missing.
  std::optional<double> depth_mm;
  /// Label that the tip is in, its wall pierced, 0 for none; MeasureRun sets it from the patient.
  std::optional<std::uint8_t> label;
  std::optional<telemetry::InsertionPhase> phase;
  std::optional<telemetry::TickEvents> events;  ///< Layer ids as in MetricContext::layer_names.
  std::optional<double> resistance_n;           ///< Along the needle; positive pushes the needle out.
  std::optional<Pose> X_PT;                     ///< Ultrasound transducer.
  std::optional<double> contact_n;              ///< Contact force of transducer and skin.
  std::optional<tasks::XrayUse> xray;
  /// The trainee could not act between the moment before and this one: time and motion between them are not counted.
  bool is_paused = false;
  /// How far the tip presses in a layer that has not given way: the needle is pierced to so much before the tip.
  double pressed_mm = 0.0;

  const Vec3& tip_A() const noexcept { return rest_tip_A ? *rest_tip_A : tip_P; }
  const Vec3& axis_A() const noexcept { return rest_axis_A ? *rest_axis_A : axis_P; }
};

/// What a haptic tick says of the needle; image, X-ray and pauses are left out.
Moment moment_of(const telemetry::TickSample& sample);

}  // namespace trocar::metrics
