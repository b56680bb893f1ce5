#pragma once

#include <cstddef>
#include <span>
#include <string>

namespace trocar {
inline namespace core {

/// 128-bit content hash (XXH3) as 32 hexadecimal digits, to compare patients or tables. Not for security.
class ContentHash {
 public:
  ContentHash();
  ~ContentHash();
  ContentHash(const ContentHash&) = delete;
  ContentHash& operator=(const ContentHash&) = delete;

  void add(std::span<const std::byte> bytes);
  std::string digest() const;

 private:
  void* state_;
};

}  // namespace core
}  // namespace trocar
