#pragma once

#include <array>
#include <bitset>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "metrics/metric.h"
#include "tasks/action.h"
#include "tasks/needle.h"
#include "tasks/task.h"

namespace trocar::metrics {

/// What needle or stylet did to one structure.
struct HarmEvent {
  std::string label;
  tasks::Harm grade = tasks::Harm::kMinor;  ///< By depth, notch and time; of a graze at most minor.
  bool is_graze = false;                    ///< Within the labels' resolution of the surface: a warning.
  bool is_by_stylet = false;                ///< Only the stylet of a biopsy gun went into it.
  bool is_by_notch = false;                 ///< The grade is that of the notch that closed in it.
  bool has_stayed = false;                  ///< The grade is that of a needle that stays in it.
  double inside_mm = 0.0;                   ///< Longest piece of needle or stylet that was in it.
  double depth_mm = 0.0;                    ///< Of its first touched point below the skin.
  double begin_s = 0.0;                     ///< Time of the first touch.
  double worst_s = 0.0;                     ///< Time at which the longest piece was in it.
  double stayed_s = 0.0;                    ///< Longest time without a break.
  std::string reason;                       ///< What happens to the patient; may be empty.
};
/// "the needle went 12 mm into the heart", "the needle grazed the colon", "the notch closed in the hepatic vein".
std::string harm_words(const HarmEvent& event);
/// True if `a` is to be told before `b`: the graver one, then the earlier one.
bool is_graver(const HarmEvent& a, const HarmEvent& b) noexcept;

/// Follows tip and shaft of a needle, and a biopsy gun's stylet, through the structures that a task must not harm
/// (tasks::find_harm; docs/physics.md, E5). A structure counts once the needle has pierced it: pressing on its wall is
/// no harm, except for bone, which the needle only touches. The shaft is straight from the tip to the skin. Frame P.
/// Task and patient outlive it; not thread-safe; a step takes some microseconds.
class HarmWatch {
 public:
  HarmWatch(const tasks::Task& task, const anatomy::VirtualPatient& patient, const tasks::Needle& needle);

  /// The next moment, in the order of time; one that is not finite, has no depth or no axis is skipped.
  void step(const Moment& moment);
  /// The gun was fired at this moment; the stylet goes straight on from the tip and stops at bone.
  void fire(const Moment& moment);
  /// Something came out of the needle: it was no graze of the structure that the bevel is in.
  void note(const tasks::Action& action);

  /// All events so far, the first touch first.
  const std::vector<HarmEvent>& events() const noexcept { return events_; }
  /// The gravest of the events whose structure the needle is in now, beyond a graze; nullptr: none.
  const HarmEvent* present() const noexcept;
  /// The events whose grade has risen, or that are new, since the last call.
  std::vector<HarmEvent> take_news();

 private:
  struct Piece;   // of one label along a line
  struct Depths;  // distances below the surface of a structure, in a box
  void walk(const Vec3& from_P, const Vec3& to_P, double depth_mm, double time_s, bool is_by_stylet);
  const Depths& depths_about(std::uint8_t id, const Vec3& p_P);
  bool is_deep(std::uint8_t id, const Vec3& p_P);
  bool is_known(std::uint8_t id) const noexcept;
  HarmEvent& event_of(std::uint8_t id, double depth_mm, double time_s, bool is_by_stylet);
  void judge(const Piece& piece, double time_s, bool is_by_stylet);
  void touch_bone(const Moment& moment);
  void stay(double time_s);
  void raise(HarmEvent& event, tasks::Harm grade) noexcept;

  const anatomy::VirtualPatient* patient_;
  tasks::Needle needle_;
  std::array<tasks::LabelHarm, 256> harms_{};
  std::array<bool, 256> is_bone_{}, is_vessel_{};
  double tolerance_mm_ = 1.0;                              ///< One voxel, at least 1 mm.
  std::array<std::shared_ptr<const Depths>, 256> depths_;  ///< Of each label, about the place last looked at.
  std::vector<HarmEvent> events_;
  std::vector<std::pair<tasks::Harm, bool>> told_;  ///< Grade and graze of each event at the last take_news().
  std::array<std::int16_t, 256> event_of_{};        ///< Index into events_, -1: none.
  std::bitset<256> now_;  ///< Labels that the needle is in, once it was in them beyond a graze.
  std::array<double, 256> stays_since_s_{}, left_s_{};  ///< Begin and end of the last contact.
  std::optional<Vec3> tip_P_;                           ///< Of the last tested position.
  Vec3 skin_P_ = Vec3::Zero();
  double last_s_ = 0.0;
};

/// All harm of a recording, the gravest first; none of grade "none". `shots`: samples at which the gun was fired, in
/// order.
std::vector<HarmEvent> find_harms(const tasks::Task& task, const anatomy::VirtualPatient& patient,
                                  const tasks::Needle& needle, std::span<const telemetry::TickSample> samples,
                                  std::span<const std::size_t> shots = {},
                                  std::span<const tasks::Interruption> interruptions = {},
                                  std::span<const tasks::Action> actions = {});

}  // namespace trocar::metrics
