#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "anatomy/patient.h"
#include "anatomy/tissue/tissue_table.h"
#include "core/progress.h"
#include "core/result.h"
#include "haptics/needle_geometry.h"
#include "lab/haptics/random_motion.h"

namespace trocar::bench {

/// What moves: a needle under a force model, or a face on the skin.
enum class MovedModel { kInsertion, kProxy, kCombined, kProbe, kFinger };
inline constexpr std::array kMovedModels{MovedModel::kInsertion, MovedModel::kProxy, MovedModel::kCombined,
                                         MovedModel::kProbe, MovedModel::kFinger};
const char* to_string(MovedModel model) noexcept;
/// Of the motion with this number: of eleven, three for each force model of a needle and one for each face.
MovedModel model_of(int number) noexcept;

struct NamedNeedle {
  std::string name;
  haptics::NeedleGeometry geometry;
};

/// Patients, needles and tissues from which random motions are drawn.
struct MotionPool {
  std::vector<std::shared_ptr<const anatomy::VirtualPatient>> patients;
  std::vector<NamedNeedle> needles;
  std::vector<anatomy::TissueTable> tissues;  ///< Of every profile.
};
Result<MotionPool> load_motion_pool(const Progress& progress);

/// One random motion with all that it needs.
struct PlannedMotion {
  int number = 0;
  MovedModel model = MovedModel::kInsertion;
  haptics::MotionKind kind = haptics::MotionKind::kDrag;
  std::string patient, needle, profile;
  double rate_hz = 1000.0;
  double angle_deg = 0.0;
  double tempo_mm_per_s = 0.0;
  std::shared_ptr<const haptics::HapticScene> scene;
  std::optional<haptics::ClosedMotion> before;
  std::optional<haptics::ClosedMotion> motion;

  /// "motion 17: drag, 45 degrees to the skin, 20 mm/s, 1000 Hz, layers-liver, chiba-22g, paper-a"
  std::string text() const;
};
/// The motion with this number: a function of pool, seed and number.
Result<PlannedMotion> plan_motion(const MotionPool& pool, std::uint64_t seed, int number);

}  // namespace trocar::bench
