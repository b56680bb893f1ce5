#include "core/decimal_point.h"

#include <locale>
#include <mutex>

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

}  // namespace

DecimalPoint::DecimalPoint() {
  {
    ReplacedLocale& shared = replaced_locale();
    const std::lock_guard lock(shared.mutex);
    if (shared.count++ == 0) {
      shared.before = std::locale();
      if (shared.before != std::locale::classic()) std::locale::global(std::locale::classic());
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
  if (--shared.count == 0 && shared.before != std::locale::classic()) std::locale::global(shared.before);
}

}  // namespace core
}  // namespace trocar
