#include "core/parallel.h"

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>

namespace trocar {
inline namespace core {

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  if (count == 0) return;
  using Range = oneapi::tbb::blocked_range<std::size_t>;
  oneapi::tbb::parallel_for(Range(0, count, std::max<std::size_t>(grain, 1)),
                            [&](const Range& part) { body(part.begin(), part.end()); });
}

void run_on_threads(int most, const std::function<void()>& body) {
  oneapi::tbb::task_arena arena(std::max(most, 1));
  arena.execute([&] { body(); });
}

void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b) {
  oneapi::tbb::parallel_invoke(a, b);
}

void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b, const std::function<void()>& c) {
  oneapi::tbb::parallel_invoke(a, b, c);
}

}  // namespace core
}  // namespace trocar
