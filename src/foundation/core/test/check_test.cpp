#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "core/result.h"

namespace trocar {
namespace {

int half_of(int even) {
  TROCAR_CHECK(even % 2 == 0);
  return even / 2;
}

struct CheckHandlers : ::testing::Test {
  void TearDown() override { set_check_handler(nullptr); }
};

TEST_F(CheckHandlers, AreUnsetByDefault) {
  EXPECT_EQ(set_check_handler(nullptr), nullptr);
  EXPECT_DEATH(half_of(3), "internal error: check failed: even % 2 == 0");
}

TEST_F(CheckHandlers, HandTheirExceptionToTheCaller) {
  const CheckHandler thrower = [](const char* text) { throw std::logic_error(text); };
  EXPECT_EQ(set_check_handler(thrower), nullptr);
  EXPECT_EQ(half_of(4), 2);
  try {
    half_of(3);
    FAIL() << "the check must not pass";
  } catch (const std::logic_error& error) {
    EXPECT_NE(std::string(error.what()).find("even % 2 == 0"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("check_test.cpp"), std::string::npos) << error.what();
  }
  EXPECT_EQ(set_check_handler(nullptr), thrower);
}

TEST_F(CheckHandlers, ThatReturnAreFollowedByAnAbort) {
  set_check_handler([](const char*) {});
  EXPECT_DEATH(half_of(3), "");
}

}  // namespace
}  // namespace trocar
