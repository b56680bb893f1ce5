#pragma once

#include <cstddef>
#include <functional>

namespace trocar {
inline namespace core {

// In a cancelled job (core/progress.h) these functions end with Cancelled between two parts.

/// Calls body(first, last) on disjoint parts of [0, count) from several threads; returns when all are done.
/// Parts are at least `grain` long. Never called from real-time code.
void parallel_for(std::size_t count, std::size_t grain,
                  const std::function<void(std::size_t first, std::size_t last)>& body);

/// Calls body(), whose parallel work uses at most `most` threads (>= 1), including the calling thread. With 1, all work
/// runs on the calling thread, at the priority of that thread.
void run_on_threads(int most, const std::function<void()>& body);

/// Runs the functions in parallel and waits for all of them.
void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b);
void parallel_invoke(const std::function<void()>& a, const std::function<void()>& b, const std::function<void()>& c);

}  // namespace core
}  // namespace trocar
