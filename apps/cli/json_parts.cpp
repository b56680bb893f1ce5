#include "json_parts.h"

namespace trocar::cli {

config::Json vector_json(const Vec3& v) {
  return config::Json::array({v.x(), v.y(), v.z()});
}

}  // namespace trocar::cli
