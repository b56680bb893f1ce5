#include "core/result.h"

#include <atomic>
#include <cstdio>
#include <cstdlib>

namespace trocar {
inline namespace core {
namespace {

void append_part(std::string& line, const std::string& part) {
  if (part.empty()) return;
  if (!line.empty()) line += " — ";
  for (const char c : part) line += (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) ? ' ' : c;
}

}  // namespace

std::string Error::text() const {
  std::string line;
  append_part(line, what);
  append_part(line, where);
  append_part(line, advice);
  return line;
}

tl::unexpected<Error> fail(std::string what, std::string where, std::string advice) {
  return tl::unexpected(Error{std::move(what), std::move(where), std::move(advice), 1});
}

tl::unexpected<Error> fail_usage(std::string what, std::string where, std::string advice) {
  return tl::unexpected(Error{std::move(what), std::move(where), std::move(advice), 2});
}

}  // namespace core
inline namespace core {
namespace {

void print_failure(const char* text) {
  std::fprintf(stderr, "%s\n", text);
}

std::atomic<CheckHandler> check_handler{print_failure};

}  // namespace

CheckHandler set_check_handler(CheckHandler handler) noexcept {
  const CheckHandler before = check_handler.exchange(handler == nullptr ? print_failure : handler);
  return before == print_failure ? nullptr : before;
}

namespace detail {

void check_failed(const char* condition, const char* file, int line) {
  constexpr std::size_t kMostText = 1024;
  char text[kMostText];
  std::snprintf(text, sizeof(text), "internal error: check failed: %s — %s:%d — please report this", condition, file,
                line);
  check_handler.load()(text);
  std::abort();
}

}  // namespace detail
}  // namespace core
}  // namespace trocar
