#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "attempt/guide/needle_view.h"
#include "attempt/record/session_motion.h"
#include "attempt/record/xray_replay.h"
#include "cases/open_case.h"
#include "core/result.h"
#include "storage/session_file.h"

namespace trocar::attempt {

/// A notable moment of a recorded attempt.
struct ReplayMoment {
  enum class Kind { kPuncture, kEnter, kRisk, kFired, kAction, kChange, kInterruption, kWorst };
  double time_s = 0.0;
  Kind kind = Kind::kPuncture;
  std::string text;  ///< "through the liver capsule", "the needle went 4 mm into the lung"
};

/// A recorded attempt for replay. Immutable. Frame P.
class AttemptReplay {
 public:
  /// Reads a session. If a crash left it without a score, scores it against the case. Errors: file errors; a session of
  /// another patient; no ticks.
  static Result<AttemptReplay> load(const std::filesystem::path& session, std::shared_ptr<const cases::OpenCase> open);

  /// The same for a session in memory whose file could not be written completely.
  static Result<AttemptReplay> of(storage::Session session, std::shared_ptr<const cases::OpenCase> open);

  const storage::Session& session() const noexcept { return session_; }
  const scoring::Outcome& outcome() const noexcept { return *session_.outcome; }
  bool was_cut_off() const noexcept { return was_cut_off_; }
  double duration_s() const noexcept { return session_.samples.back().time_s; }
  /// The tick at a time; before the first or after the last tick, that tick.
  const telemetry::TickSample& at(double time_s) const noexcept;
  /// Where the patient was at that tick.
  motion::PatientMotion motion_at(double time_s) const noexcept { return motion_.at(at(time_s)); }
  /// See needle_shaft (attempt/guide/needle_view.h); straight in a session of an older program.
  std::vector<Vec3> shaft_at(double time_s) const;
  /// X_PT, interpolated between the recorded samples; constant in a gap of more than kTransducerGap_s. Empty: the
  /// session has no transducer samples.
  std::optional<Pose> transducer_at(double time_s) const noexcept;
  static constexpr double kTransducerGap_s = 0.1;

  /// The fluoroscope at a time; empty: not used before.
  std::optional<XrayMoment> xray_at(double time_s) const { return xray_moment(session_.xray, time_s); }
  /// At the recorded tips of the needle.
  InjectionSteps injections() const;

  /// Shots of the gun by time.
  const std::vector<GunShot>& shots() const noexcept { return shots_; }
  /// The shot whose core is in the gun at a time; null: it is loaded.
  const GunShot* shot_at(double time_s) const noexcept;
  /// Ordered by time; includes the worst one if there is one.
  const std::vector<ReplayMoment>& moments() const noexcept { return moments_; }
  /// Empty: the needle touched nothing.
  const std::optional<ReplayMoment>& worst() const noexcept { return worst_; }

 private:
  AttemptReplay(storage::Session session, std::shared_ptr<const cases::OpenCase> open, bool was_cut_off);
  void find_moments();
  void find_worst();

  storage::Session session_;
  std::shared_ptr<const cases::OpenCase> open_;
  SessionMotion motion_;
  bool was_cut_off_;
  std::vector<GunShot> shots_;
  std::vector<metrics::HarmEvent> harms_;  ///< The gravest first.
  std::vector<ReplayMoment> moments_;
  std::optional<ReplayMoment> worst_;
};

}  // namespace trocar::attempt
