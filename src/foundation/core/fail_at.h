#pragma once

#include <string>
#include <utility>

#include "core/result.h"

namespace trocar {
inline namespace core {

/// An error with the place where it occurred in front of its own: "liver.nrrd: trocar_depth_mm".
inline tl::unexpected<Error> fail_at(const std::string& place, Error error) {
  error.where = error.where.empty() ? place : place + ": " + error.where;
  return tl::unexpected(std::move(error));
}

}  // namespace core
}  // namespace trocar
