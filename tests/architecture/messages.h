#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace trocar::architecture {

/// A call in a source text: its line and its arguments as written, without outer white space.
struct Call {
  std::string function;
  int line = 0;
  std::vector<std::string> arguments;
};

/// The calls of fail() and fail_usage() in a C++ source; strings and nested brackets are skipped.
std::vector<Call> find_fail_calls(std::string_view source);

/// "path:line: ..." for every error without the failure, the place, and the advice.
std::vector<std::string> check_messages(const std::string& path, std::string_view source);

}  // namespace trocar::architecture
