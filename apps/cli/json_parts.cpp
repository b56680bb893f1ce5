#include "cli/json_parts.h"

namespace trocar::cli {

config::Json vector_json(const Vec3& v) {
  return config::Json::array({v.x(), v.y(), v.z()});
}

config::Json counts_json(const learning::AttemptCounts& counts) {
  return {{"counted", counts.counted()},
          {"scored", counts.scored},
          {"passed", counts.passed},
          {"without_result", counts.unscored},
          {"left_out",
           {{"never_began", counts.never_began},
            {"lost", counts.lost},
            {"running", counts.running},
            {"without_level", counts.without_level}}}};
}

}  // namespace trocar::cli
