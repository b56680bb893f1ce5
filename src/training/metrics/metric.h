#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "geometry/pose.h"
#include "motion/patient_motion.h"
#include "tasks/action.h"
#include "tasks/needle.h"
#include "tasks/task.h"
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

/// Where the patient was at a recorded tick, to the bit. `model`: of a patient who was moved; else null.
motion::PatientMotion recorded_motion(const motion::MotionModel* model, const telemetry::TickSample& sample) noexcept;

/// Value of a metric. Either `value` is finite, or `missing` says why there is none.
struct MetricValue {
  std::string name;  ///< As in the catalogue.
  std::optional<double> value;
  std::string unit;
  std::string missing;
  std::string note;            ///< Details: names of structures. May be empty.
  std::optional<double> at_s;  ///< Recording time of the moment to look at in a replay.

  void set(double new_value, std::optional<double> when_s = {}) {
    value = new_value;
    at_s = when_s;
  }
};

/// Parts of a recording, and of its description, that a metric needs beside the needle.
enum class Role : std::uint8_t {
  kDepth,       ///< Depth below the skin, recorded or from the patient.
  kEvents,      ///< Puncture events.
  kForce,       ///< Resistance along the needle.
  kTransducer,  ///< Pose of the ultrasound transducer.
  kContact,     ///< Its contact force, or a patient whose skin it can touch.
  kXray,
  kTask,
  kPatient,
  kExpert,  ///< One or more expert paths.
  kPlane,   ///< Geometry of the image plane.
  kRoll,    ///< Rotation of the needle about its axis.
};
class Roles {
 public:
  constexpr Roles() = default;
  constexpr Roles(std::initializer_list<Role> roles) {
    for (const Role role : roles) add(role);
  }
  constexpr void add(Role role) noexcept { bits_ |= 1U << static_cast<unsigned>(role); }
  constexpr bool has(Role role) const noexcept { return (bits_ & (1U << static_cast<unsigned>(role))) != 0; }

 private:
  unsigned bits_ = 0;
};
/// Reason why there is no value without a role: "no task was given".
const char* reason_without(Role role) noexcept;
inline constexpr Role kLastRole = Role::kRoll;

/// Geometry of an ultrasound image in the plane (x, y) of T; y away from the array, 0 at the middle of the face.
struct ImagePlane {
  double depth_mm = 160.0;          ///< Depth of the image, from the face. Range 10..400.
  double radius_mm = 0.0;           ///< Radius of a convex face; 0 for a phased array. Fans only.
  double field_of_view_rad = 0.0;   ///< Angle between the outermost scanlines; 0: parallel scanlines.
  double width_mm = 0.0;            ///< Width of the image of parallel scanlines.
  double slice_mm = 2.0;            ///< Thickness of the slice at the elevation focus. Range 0.1..20.
  double elevation_mm = 0.0;        ///< Height of the elements; 0: the slice has the same thickness everywhere.
  double elevation_focus_mm = 0.0;  ///< Depth of the elevation focus.

  /// Thickness of the slice: that of a beam which is `elevation_mm` high at the face and narrows linearly to the
  /// focus, hypot(slice, height * |1 - depth/focus|). docs/metrics.md.
  double slice_at_mm(double depth_mm) const noexcept;
  /// True if a point lies between the outermost scanlines and above the image's lower border, at any distance from the
  /// plane.
  bool is_in_field(const Vec3& p_T) const noexcept;
  /// True if it also lies within half of the slice's thickness from the plane.
  bool is_visible(const Vec3& p_T) const noexcept;
};

struct ExpertPath {
  std::string name;
  Segment line_P;  ///< a: entry on the skin, b: end position of the tip.
};

/// Description of a recording. Everything is optional; pointers outlive the measurement.
struct MetricContext {
  const tasks::Task* task = nullptr;
  const anatomy::VirtualPatient* patient = nullptr;
  std::optional<tasks::Needle> needle;
  std::vector<ExpertPath> expert_paths;
  std::optional<ImagePlane> plane;
  std::vector<std::string> layer_names;  ///< Names of the layers in events, by id.
  std::optional<double> end_s;  ///< Recording time of the end (scoring/attempt_end.h); empty: the deepest moment.
  std::vector<double> shots_s;  ///< Of all its shots, in order.

  const std::string* layer_name(std::uint8_t id) const noexcept {
    return id < layer_names.size() ? &layer_names[id] : nullptr;
  }
};

/// A valid moment: finite, later than the one before.
struct Step {
  const Moment& now;
  const Moment* before = nullptr;  ///< Null for the first moment and after an interruption.
  double dt_s = 0.0;               ///< Time since `before`, positive; 0 without it.
  double active_s = 0.0;           ///< Time since the first moment, without interruptions.

  bool is_inside() const noexcept { return now.depth_mm && *now.depth_mm > 0.0; }
};

/// End position of the needle and what follows from it, for metrics of the final position.
struct RunEnd {
  /// The end: MetricContext::end_s, else the deepest moment, else (no depth) the moment nearest to the end of an expert
  /// path, else none.
  std::optional<Moment> moment;
  std::optional<Vec3> entry_P;        ///< Where the needle crossed the skin at its last entry before the end.
  std::optional<std::size_t> expert;  ///< Nearest of the expert paths.
  std::optional<Segment> inserted_P;  ///< The inserted part of the shaft at the end, from the skin to the tip.
};

/// A streaming metric: one or more values from all moments of a recording.
class Metric {
 public:
  virtual ~Metric() = default;
  virtual void step(const Step& step) = 0;
  /// `values`: those of the metric's group, in its order, with name and unit; only called when their roles exist.
  virtual void report(const RunEnd& end, std::span<MetricValue> values) const = 0;
};

enum class Better : std::uint8_t { kLower, kHigher, kNeither };

struct MetricDescription {
  const char* name;   ///< "path_length".
  const char* title;  ///< "Path length of the tip".
  const char* unit;   ///< "1" for a pure number.
  Better better;
  Roles roles;
  const char* source;
};

/// Values that are computed together.
struct MetricGroup {
  std::span<const MetricDescription> values;
  /// Called only if all roles of the context that the first value needs exist.
  std::unique_ptr<Metric> (*make)(const MetricContext& context);
};

/// All groups, and the descriptions of all values, in the order of reports.
std::span<const MetricGroup> metric_groups();
std::vector<MetricDescription> metric_catalogue();

/// The first structure between the transducer's face and a point that ultrasound does not pass: bone, lung, gas;
/// nullptr: none. The beam runs along the scanline of the point's projection into the image plane, through the patient
/// as it is now. `X_PT`: the transducer, `p_P` a point in its field.
const anatomy::Label* find_shadow(const anatomy::VirtualPatient& patient, const motion::PatientMotion& motion,
                                  const ImagePlane& plane, const Pose& X_PT, const Vec3& p_P);

}  // namespace trocar::metrics
