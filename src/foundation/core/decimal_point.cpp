#include "core/decimal_point.h"

#include <clocale>
#include <locale>
#include <mutex>
#include <string>

namespace trocar {
inline namespace core {
namespace {

/// The global locale of C++, while it is replaced.
struct ReplacedLocale {
  std::mutex mutex;
  int count = 0;
  std::locale before;
};

ReplacedLocale& replaced_locale() {
  static ReplacedLocale shared;
  return shared;
}

/// The classic locale, without its name: global() gives a name to C's setlocale(), too.
std::locale make_nameless_classic() {
  return {std::locale::classic(), new std::numpunct<char>};
}

/// Makes it the global locale of C++. That of C stays as it is.
void restore(const std::locale& before) {
  const std::string of_c = std::setlocale(LC_ALL, nullptr);
  std::locale::global(before);
  std::setlocale(LC_ALL, of_c.c_str());
}

}  // namespace

DecimalPoint::DecimalPoint() {
  {
    ReplacedLocale& shared = replaced_locale();
    const std::lock_guard lock(shared.mutex);
    if (shared.count++ == 0) {
      shared.before = std::locale();
      if (shared.before != std::locale::classic()) std::locale::global(make_nameless_classic());
    }
  }
  numbers_ = ::newlocale(LC_NUMERIC_MASK, "C", ::duplocale(::uselocale(nullptr)));
  before_ = numbers_ == nullptr ? nullptr : ::uselocale(numbers_);
}

DecimalPoint::~DecimalPoint() {
  if (before_ != nullptr) ::uselocale(before_);
  if (numbers_ != nullptr) ::freelocale(numbers_);
  ReplacedLocale& shared = replaced_locale();
  const std::lock_guard lock(shared.mutex);
  if (--shared.count == 0 && shared.before != std::locale::classic()) restore(shared.before);
}

}  // namespace core
}  // namespace trocar
