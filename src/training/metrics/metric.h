#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "metrics/moment.h"
#include "tasks/needle.h"
#include "tasks/task.h"

namespace trocar::metrics {

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

}  // namespace trocar::metrics
