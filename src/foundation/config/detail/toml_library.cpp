#include "config/detail/toml_library.h"

#include <stdexcept>

namespace trocar::config::detail {

void give_up(const char* condition) {
  throw std::logic_error(condition);
}

}  // namespace trocar::config::detail
