#pragma once

#include <locale.h>

namespace trocar {
inline namespace core {

/// During its lifetime, libraries read and write the numbers of this thread with a decimal point and without separators
/// of thousands. Those that call printf or strtod, or use streams, follow the user's locale otherwise, once a program
/// has taken it over, as Qt does for C at its start. Our own code formats by fmt and parses by parse_number(), which
/// know no locale. Where the program has changed the global locale of C++, that has the numbers of the classic one
/// meanwhile, for all threads; the global locale of C is not changed. Thread-safe.
class DecimalPoint {
 public:
  DecimalPoint();
  ~DecimalPoint();
  DecimalPoint(const DecimalPoint&) = delete;
  DecimalPoint& operator=(const DecimalPoint&) = delete;

 private:
  ::locale_t numbers_;
  ::locale_t before_;
};

}  // namespace core
}  // namespace trocar
