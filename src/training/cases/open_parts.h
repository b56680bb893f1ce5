#pragma once

#include <chrono>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace trocar::cases {

/// One part of opening a case and its duration. Parts run in parallel: the durations do not add up to the whole.
struct OpenPart {
  std::string name;  ///< "patient", "acoustic scene".
  double seconds = 0.0;
};

/// Measures the parts. Any thread may measure.
class OpenParts {
 public:
  /// Calls `work` and notes its duration; returns its result.
  template <class Work>
  auto measure(std::string_view name, const Work& work) {
    const auto begin = std::chrono::steady_clock::now();
    auto result = work();
    add(name, std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count());
    return result;
  }
  std::vector<OpenPart> take() {
    const std::lock_guard lock(mutex_);
    return std::move(parts_);
  }

 private:
  void add(std::string_view name, double seconds) {
    const std::lock_guard lock(mutex_);
    parts_.push_back({std::string(name), seconds});
  }
  std::mutex mutex_;
  std::vector<OpenPart> parts_;
};

}  // namespace trocar::cases
