#include "program_end.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <new>
#include <string>

#include "core/text.h"

namespace trocar::arguments {
namespace {

/// Both streams are used: fmt prints with stdio, CLI11 prints help with iostream.
int end_output(int status) {
  errno = 0;
  std::cout.flush();
  const bool is_stream_good = std::cout.good();
  const bool is_file_good = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
  if (is_stream_good && is_file_good) return status;
  const std::string reason = errno != 0 ? fmt::format(": {}", std::strerror(errno)) : std::string();
  const int failed = report_error(
      {"cannot write the output" + reason, "standard output", "free disk space or choose another file", 1});
  return status == 0 ? failed : status;
}

/// A part of an error may quote a file, of any length and with any bytes.
std::string short_text(const std::string& text) {
  constexpr std::size_t kMostBytes = 1500;
  if (text.size() <= kMostBytes) return valid_utf8(text);
  std::size_t end = kMostBytes;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end;  // not within a character
  return valid_utf8(text.substr(0, end)) + "…";
}

}  // namespace

int report_error(const Error& error) {
  Error shown = error;
  for (std::string* part : {&shown.what, &shown.where, &shown.advice}) *part = short_text(*part);
  fmt::print(stderr, "error: {}\n", shown.text());
  return error.exit_status;
}

int run_program(const std::function<int()>& program, const char* name) {
  // Our code does not throw; memory can still run out, and fmt throws if standard output cannot be written.
  try {
    return end_output(program());
  } catch (const std::bad_alloc&) {
    return report_error({"not enough memory", name, "close other programs, or use smaller files", 1});
  } catch (const std::exception& exception) {
    if (std::ferror(stdout) != 0) return end_output(1);
    return report_error({std::string("internal error: ") + exception.what(), name, "report this with the command", 1});
  }
}

}  // namespace trocar::arguments
