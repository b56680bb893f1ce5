#include <gtest/gtest.h>

#include "attempt/live/realtime_session.h"

namespace trocar::attempt {
namespace {

Status check(const std::vector<std::string>& endpoints) {
  RealtimeOptions options;
  options.endpoints = endpoints;
  return check_realtime(options);
}

TEST(RealtimeOptions, TakesNoneOneOrTwoServers) {
  EXPECT_TRUE(check({}));
  EXPECT_TRUE(check({"ipc:///tmp/a"}));
  EXPECT_TRUE(check({"ipc:///tmp/a", "ipc:///tmp/b"}));
}

TEST(RealtimeOptions, RefusesInvalidServersAsUsageErrors) {
  const std::vector<std::vector<std::string>> wrong{{"ipc:///tmp/a", "ipc:///tmp/b", "ipc:///tmp/c"},
                                                    {"ipc:///tmp/a", "ipc:///tmp/a"},
                                                    {"http://127.0.0.1"},
                                                    {"tcp://127.0.0.1:5571"},
                                                    {"tcp://192.0.2.1:5571"}};
  for (const auto& endpoints : wrong) {
    const Status status = check(endpoints);
    ASSERT_FALSE(status.has_value()) << endpoints.front();
    EXPECT_EQ(status.error().exit_status, 2);
  }
}

TEST(RealtimeOptions, AllowsRemoteServersWithKeys) {
  RealtimeOptions options;
  options.endpoints = {"tcp://192.0.2.1:5571"};
  options.security.emplace();
  EXPECT_TRUE(check_realtime(options));
}

}  // namespace
}  // namespace trocar::attempt
