#pragma once

#include <clocale>
#include <locale>
#include <stdexcept>
#include <string>

namespace trocar::testing {

/// Gives the whole process a user's locale, for C and for C++, as the start of Qt or an embedding program does.
class UserLocale {
 public:
  explicit UserLocale(const char* name) : before_(std::setlocale(LC_ALL, nullptr)) {
    try {
      before_cpp_ = std::locale::global(std::locale(name));
      is_there_ = true;
    } catch (const std::runtime_error&) {
      is_there_ = false;
    }
  }
  ~UserLocale() {
    std::locale::global(before_cpp_);
    std::setlocale(LC_ALL, before_.c_str());
  }
  UserLocale(const UserLocale&) = delete;
  UserLocale& operator=(const UserLocale&) = delete;

  /// False: this machine does not have it (`./test` makes those that the tests need), and nothing was changed.
  bool is_there() const noexcept { return is_there_; }

 private:
  std::string before_;
  std::locale before_cpp_;
  bool is_there_ = false;
};

}  // namespace trocar::testing
