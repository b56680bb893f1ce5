#include "haptics/closed_loop/encoder.h"

#include "haptics/closed_loop/rotation.h"

namespace trocar::haptics {
namespace {

Vec3 rounded(const Vec3& v, double count) noexcept {
  return count > 0.0 ? Vec3((v / count).array().round() * count) : v;
}

}  // namespace

Pose quantise(const Pose& X_DS, const EncoderParams& encoder) noexcept {
  const Vec3 p = rounded(X_DS.p(), encoder.count_mm);
  if (!(encoder.count_rad > 0.0)) return {X_DS.R(), p};
  return {rotation_from_vector(rounded(rotation_vector(X_DS.R()), encoder.count_rad)), p};
}

}  // namespace trocar::haptics
