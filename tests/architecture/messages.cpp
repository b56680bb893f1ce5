#include "architecture/messages.h"

#include <algorithm>

#include "architecture/source_files.h"

namespace trocar::architecture {
namespace {

constexpr std::size_t kParts = 3;

std::string trimmed(std::string text) {
  const auto first = text.find_first_not_of(" \t\n");
  if (first == std::string::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
}

/// The index behind a string or character literal that begins at `at`.
std::size_t behind_literal(std::string_view source, std::size_t at) {
  const char quote = source[at];
  for (++at; at < source.size() && source[at] != quote; ++at)
    if (source[at] == '\\') ++at;
  return std::min(at + 1, source.size());
}

/// The arguments of a call whose bracket opens at `at`.
std::vector<std::string> arguments_at(std::string_view source, std::size_t at) {
  std::vector<std::string> arguments(1);
  int depth = 0;
  while (at < source.size()) {
    const char c = source[at];
    if (c == '"' || c == '\'') {
      const std::size_t end = behind_literal(source, at);
      arguments.back() += source.substr(at, end - at);
      at = end;
      continue;
    }
    if (c == '(' || c == '[' || c == '{') ++depth;
    if (c == ')' || c == ']' || c == '}') --depth;
    if (depth == 0) break;
    if (depth == 1 && c == ',') {
      arguments.emplace_back();
    } else if (depth > 1 || c != '(') {
      arguments.back() += c;
    }
    ++at;
  }
  for (std::string& argument : arguments) argument = trimmed(argument);
  return arguments;
}

}  // namespace

std::vector<Call> find_fail_calls(std::string_view source) {
  std::vector<Call> calls;
  for (const std::string_view function : {std::string_view("fail"), std::string_view("fail_usage")}) {
    for (auto at = source.find(function); at != std::string_view::npos; at = source.find(function, at + 1)) {
      const std::size_t open = at + function.size();
      const bool is_call = open < source.size() && source[open] == '(' && (at == 0 || !is_word(source[at - 1]));
      if (!is_call) continue;
      const auto line = 1 + std::count(source.begin(), source.begin() + static_cast<std::ptrdiff_t>(at), '\n');
      calls.push_back({std::string(function), static_cast<int>(line), arguments_at(source, open)});
    }
  }
  return calls;
}

std::vector<std::string> check_messages(const std::string& path, std::string_view source) {
  std::vector<std::string> complaints;
  for (const Call& call : find_fail_calls(source)) {
    const auto& parts = call.arguments;
    if (!parts.empty() && parts.front().starts_with("std::string what")) continue;  // its declaration
    const bool is_whole = parts.size() == kParts && parts[0] != "\"\"" && parts[2] != "\"\"" && parts[2] != "{}";
    if (!is_whole)
      complaints.push_back(path + ":" + std::to_string(call.line) + ": " + call.function +
                           "(what, where, what to do): the last part is missing");
  }
  return complaints;
}

}  // namespace trocar::architecture
