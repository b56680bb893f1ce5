#include "core/result.h"

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
}  // namespace trocar
