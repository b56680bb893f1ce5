#pragma once

#include <string>
#include <vector>

namespace trocar::testing {

/// Violated calling rules, in the order of the violations.
class Violations {
 public:
  void require(bool is_kept, const char* rule) {
    if (!is_kept) broken_.emplace_back(rule);
  }
  void clear() { broken_.clear(); }
  std::string text() const {
    std::string lines;
    for (const std::string& rule : broken_) lines += rule + "\n";
    return lines;
  }

 private:
  std::vector<std::string> broken_;
};

}  // namespace trocar::testing
