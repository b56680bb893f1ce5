#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "anatomy/patient.h"
#include "anatomy/tissue/tissue_table.h"
#include "metrics/detail/uniform_sampler.h"
#include "metrics/metric.h"
#include "tasks/action.h"
#include "tasks/plan.h"
#include "tasks/task.h"
#include "telemetry/tick_sample.h"

namespace trocar::metrics {

/// Follows the needle through a recording: its first contact, its entries through the skin, its end. Score and metrics
/// take them from here.
class AttemptTrack {
 public:
  /// What is known of the recording; pointers outlive the track.
  struct Facts {
    const anatomy::VirtualPatient* patient = nullptr;  ///< Null: the entry follows from depth and axis.
    std::optional<std::uint8_t> skin_layer;            ///< Its id in events; empty: events do not know it.
    std::optional<double> end_s;        ///< Time of the end (scoring/attempt_end.h); empty: the deepest moment.
    std::vector<Vec3> target_points_P;  ///< The nearest moment is the end if no depth is recorded.
  };
  /// An entry through the skin: at its puncture; without the event of it where the depth becomes positive.
  struct Entry {
    Moment moment;
    int count = 1;  ///< Entries up to this one.
  };
  /// The needle at its end and what led to it.
  struct End {
    Moment moment;
    std::optional<Entry> entry;  ///< The last one before.
    /// Inward path of the tip inside the body, with repeated pushes after a pull back; motion to and fro of less than 1
    /// mm is tremor and not counted.
    double travel_mm = 0.0;
    double deepest_mm = 0.0;  ///< Largest depth until then.
  };

  explicit AttemptTrack(Facts facts) : facts_(std::move(facts)) {}

  /// The next moment: finite, later than the one before, its axis of length 1.
  void step(const Moment& now);

  std::optional<double> contact_s() const noexcept { return contact_s_; }  ///< First contact with the skin.
  const std::optional<End>& end() const noexcept { return end_; }
  /// Where the needle crossed the resting skin (frame A): the skin is dented at its puncture.
  Vec3 skin_crossing_A(const Entry& entry) const noexcept;

 private:
  void note_entry(const Moment& now);
  void take(const Moment& now);

  Facts facts_;
  std::optional<double> contact_s_;
  std::optional<Entry> punctured_, sunk_;  ///< The newest entry by an event, and by depth.
  bool is_sunk_ = false;
  bool has_left_ = false;            ///< It was outside since the last puncture.
  bool is_newest_by_depth_ = false;  ///< It entered again, and the event of it was not recorded.
  detail::Strokes strokes_{detail::kTremor_mm, true};
  double deepest_mm_ = 0.0;
  std::optional<End> end_;
  bool is_over_ = false;
  double nearest_mm_ = 0.0;  ///< Without depth: of the end to the nearest of the target points.
};

/// Measures of an attempt against a planned path. Offsets are "is minus planned", frame A.
struct AttemptMetrics {
  bool has_touched_skin = false;
  bool has_entered = false;  ///< The skin was pierced; if false, all values below stay zero.
  int entries = 0;           ///< Punctures of the skin.
  /// Offset of the needle's crossing of the skin, at the last entry before the end.
  Vec3 entry_offset_P = Vec3::Zero();
  Vec3 axis_P = Vec3::UnitZ();        ///< Axis of the needle at its end.
  double angle_deg = 0.0;             ///< Angle to the planned path.
  Vec3 tip_P = Vec3::Zero();          ///< Tip at the needle's end.
  Vec3 pierced_tip_P = Vec3::Zero();  ///< The same as far as layers have given way.
  Vec3 target_offset_P = Vec3::Zero();
  double travel_mm = 0.0;   ///< See AttemptTrack::End.
  double deepest_mm = 0.0;  ///< Depth of the tip below the skin, the largest up to the end.
  double entry_s = 0.0;     ///< Time of the last entry before the end.
  double end_s = 0.0;       ///< Time of the end.
  double time_s = 0.0;      ///< From the first contact with the skin to the end, without interruptions.
};

/// Follows the samples of an attempt. Those that are not finite are left out.
AttemptTrack follow_attempt(const anatomy::VirtualPatient& patient, const anatomy::TissueTable& tissues,
                            std::span<const telemetry::TickSample> samples, std::optional<double> end_s);
AttemptMetrics measure_against(const tasks::PlannedPath& plan, const AttemptTrack& track,
                               std::span<const tasks::Interruption> interruptions = {});

/// The bevel at the punctures of the layer whose fibres it has to part (tasks::BevelRule); of several the worst.
/// Frame P.
class WorstBevel {
 public:
  struct Puncture {
    double to_fibres_deg = 0.0;  ///< 0..90, see tasks::bevel_to_fibres_deg.
    double time_s = 0.0;
  };

  /// Task and patient outlive it. `layer`: id of the rule's layer in events; empty: events do not know it.
  WorstBevel(const tasks::Task& task, const anatomy::VirtualPatient& patient, std::optional<std::uint8_t> layer)
      : task_(&task), patient_(&patient), layer_(layer) {}

  /// `R_PN`: the needle with its roll, +y to the bevel's face.
  void step(double time_s, const Vec3& tip_P, const Mat3& R_PN, const telemetry::TickEvents& events);

  bool has_punctured() const noexcept { return has_punctured_; }  ///< The layer, with or without fibres there.
  /// Empty: the task has no such rule, the layer was not punctured, or the patient lacks the fibres.
  const std::optional<Puncture>& worst() const noexcept { return worst_; }

 private:
  const tasks::Task* task_;
  const anatomy::VirtualPatient* patient_;
  std::optional<std::uint8_t> layer_;
  bool has_punctured_ = false;
  std::optional<Puncture> worst_;
};

}  // namespace trocar::metrics
