#include "architecture/throwing_forms.h"

#include <algorithm>
#include <regex>

namespace trocar::architecture {
namespace {

/// The source with blanks instead of comments and of the contents of strings; lines stay.
std::string code_of(std::string_view source) {
  std::string code(source);
  const auto blank = [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < std::min(last, code.size()); ++n)
      if (code[n] != '\n') code[n] = ' ';
  };
  for (std::size_t at = 0; at < code.size(); ++at) {
    const std::string_view rest = source.substr(at);
    std::size_t end = at;
    if (rest.starts_with("//")) {
      end = source.find('\n', at);
    } else if (rest.starts_with("/*")) {
      end = source.find("*/", at + 2);
    } else if (rest.front() == '"') {
      for (end = at + 1; end < source.size() && source[end] != '"' && source[end] != '\n'; ++end)
        if (source[end] == '\\') ++end;
      blank(at + 1, end);
      at = std::min(end, code.size());
      continue;
    } else {
      continue;
    }
    blank(at, end);
    at = std::min(end, code.size());
  }
  return code;
}

struct Form {
  std::string home;  ///< The only files with this form, without their endings.
  std::regex pattern;
  std::string advice;
};

const std::vector<Form>& forms() {
  static const std::string thread_home = "src/foundation/core/start_thread";
  static const std::string thread_advice = "start threads with core/start_thread.h";
  static const std::vector<Form> all{
      // std::thread(...), std::jthread name(...), std::thread{...}
      {thread_home, std::regex(R"(\bstd::j?thread\s*(\w+\s*)?[({]\s*[^)}\s])"), thread_advice},
      {thread_home, std::regex(R"(\b(make_unique|make_shared|optional)\s*<\s*std::j?thread\b)"), thread_advice},
      // thread_([this] {...}), threads.emplace_back([this] {...})
      {thread_home, std::regex(R"(\b\w*threads?_?(\s*\.\s*emplace\w*)?\s*[({]\s*\[)"), thread_advice},
      {thread_home, std::regex(R"(\b(std::async|pthread_create|thrd_create)\b)"), thread_advice},
      {"src/foundation/core/files/folders", std::regex(R"(\bdirectory_iterator\b|\brecursive_directory_iterator\b)"),
       "list folders with core/files/folders.h"}};
  return all;
}

}  // namespace

std::vector<std::string> find_throwing_forms(const std::string& path, std::string_view source) {
  std::vector<std::string> complaints;
  const std::string code = code_of(source);
  for (const Form& form : forms()) {
    if (path.starts_with(form.home)) continue;
    for (std::sregex_iterator match(code.begin(), code.end(), form.pattern), end; match != end; ++match) {
      const auto line = 1 + std::count(code.begin(), code.begin() + match->position(), '\n');
      const std::string complaint = path + ":" + std::to_string(line) + ": " + form.advice;
      if (std::ranges::find(complaints, complaint) == complaints.end()) complaints.push_back(complaint);
    }
  }
  return complaints;
}

}  // namespace trocar::architecture
