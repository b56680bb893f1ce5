#include <cstdlib>

namespace {

[[gnu::constructor]] void crash() {
  std::abort();
}

}  // namespace
