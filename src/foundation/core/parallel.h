#pragma once

#include <cstddef>
#include <functional>

namespace trocar {
inline namespace core {

/// Calls body(first, last) on disjoint parts of [0, count) from several threads; returns when all are done.
/// Parts are at least `grain` long. Never called from real-time code.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t first, std::size_t last)>& body);

/// Calls body(); what it does in parallel uses at most so many threads, the calling one among them (>= 1). With 1
/// everything stays on the calling thread, whose priority then holds for all of it.
void run_on_threads(int most, const std::function<void()>& body);

/// Runs the functions side by side and waits for all of them.
void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b);
void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b, const std::function<void()>& c);

}  // namespace core
}  // namespace trocar
