#include "core/random.h"

#include <cmath>
#include <numbers>

namespace trocar {
inline namespace core {

double Random::normal() noexcept {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

}  // namespace core
}  // namespace trocar
