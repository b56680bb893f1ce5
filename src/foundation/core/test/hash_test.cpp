#include <gtest/gtest.h>

#include <string_view>

#include "core/content_hash.h"

namespace trocar {
inline namespace core {
namespace {

std::string hash_of(std::initializer_list<std::string_view> parts) {
  ContentHash hash;
  for (const std::string_view part : parts) hash.add(std::as_bytes(std::span(part)));
  return hash.digest();
}

TEST(ContentHash, OfEmptyInputMatchesXxh3) {
  EXPECT_EQ(hash_of({}), "99aa06d3014798d86001c324468d497f");  // XXH3 128 bits of empty input
}

TEST(ContentHash, IsIndependentOfChunking) {
  const std::string text(100'000, 'x');
  const std::string_view view = text;
  EXPECT_EQ(hash_of({view}), hash_of({view.substr(0, 1), "", view.substr(1, 5000), view.substr(5001)}));
}

TEST(ContentHash, DistinguishesContents) {
  EXPECT_NE(hash_of({"liver"}), hash_of({"Liver"}));
  EXPECT_NE(hash_of({"liver"}), hash_of({"liver "}));
  EXPECT_NE(hash_of({"ab"}), hash_of({"ba"}));
}

TEST(ContentHash, DigestCanBeReadAtAnyTime) {
  ContentHash hash;
  const std::string before = hash.digest();
  EXPECT_EQ(hash.digest(), before);
  hash.add(std::as_bytes(std::span(std::string_view("x"))));
  EXPECT_EQ(hash.digest(), hash_of({"x"}));
  EXPECT_EQ(hash.digest().size(), 32u);
}

}  // namespace
}  // namespace core
}  // namespace trocar
