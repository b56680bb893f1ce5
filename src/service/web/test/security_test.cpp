// Each guard alone, without sockets, clocks or a database.
#include <gtest/gtest.h>

#include "web/security/rate_limits.h"
#include "web/security/request_guards.h"

namespace trocar::web {
namespace {

using namespace std::chrono_literals;
using TimePoint = TokenBuckets::TimePoint;
const TimePoint kFirstTry{1000h};
const std::string kToken = "abcdefghijklmnopqrstuvwxyz0123456789-_ABCDE";

HttpRequest request_with(TextPairs headers) {
  HttpRequest request;
  request.headers = std::move(headers);
  return request;
}

TEST(TokenBuckets, AllowABurstAndThenTheRate) {
  TokenBuckets buckets({3, 0.5});
  for (int n = 0; n < 3; ++n) EXPECT_FALSE(buckets.try_take("a", kFirstTry));
  EXPECT_EQ(buckets.try_take("a", kFirstTry), 2s);
  EXPECT_EQ(buckets.try_take("a", kFirstTry + 1s), 1s);
  EXPECT_FALSE(buckets.try_take("a", kFirstTry + 2s));
  EXPECT_TRUE(buckets.try_take("a", kFirstTry + 2s));
  EXPECT_FALSE(buckets.try_take("b", kFirstTry)) << "another key has a bucket of its own";
}

TEST(TokenBuckets, NeverHoldMoreThanTheirCapacity) {
  TokenBuckets buckets({2, 1});
  EXPECT_FALSE(buckets.try_take("a", kFirstTry));
  int taken = 0;
  while (!buckets.try_take("a", kFirstTry + 1000s)) ++taken;
  EXPECT_EQ(taken, 2);
  buckets.give_back("a");
  buckets.give_back("a");
  buckets.give_back("a");
  taken = 0;
  while (!buckets.try_take("a", kFirstTry + 1000s)) ++taken;
  EXPECT_EQ(taken, 2);
}

TEST(TokenBuckets, GrantNothingForATimeInThePast) {
  TokenBuckets buckets({1, 1});
  EXPECT_FALSE(buckets.try_take("a", kFirstTry));
  EXPECT_TRUE(buckets.try_take("a", kFirstTry - 100s));
  EXPECT_TRUE(buckets.try_take("a", kFirstTry));
}

/// 1000 made-up keys with room for 10: all beyond share one bucket.
TEST(TokenBuckets, ForgedKeysNeitherGrowNorEscapeTheTable) {
  TokenBuckets buckets({2, 0.001, 10});
  int taken = 0;
  for (int n = 0; n < 1000; ++n) taken += buckets.try_take(std::to_string(n), kFirstTry) ? 0 : 1;
  EXPECT_EQ(taken, 10 + 2);
  // Keys that rested long enough make room.
  EXPECT_FALSE(buckets.try_take("new", kFirstTry + 10000s));
  EXPECT_FALSE(buckets.try_take("new", kFirstTry + 10000s));
  EXPECT_FALSE(buckets.try_take("other", kFirstTry + 10000s));
}

int tries(LoginThrottle& throttle, const LoginTry& login, TimePoint now, int most = 1000) {
  int count = 0;
  while (count < most && !throttle.try_begin(login, now)) ++count;
  return count;
}

TEST(LoginThrottle, SlowsDownOneClientAtOneAccount) {
  LoginThrottle throttle;
  EXPECT_EQ(tries(throttle, {"weber", "192.0.2.1"}, kFirstTry), 5);
  EXPECT_EQ(throttle.try_begin({"weber", "192.0.2.1"}, kFirstTry), 60s);
  EXPECT_EQ(tries(throttle, {"weber", "192.0.2.1"}, kFirstTry + 60s), 1);
  // A day of guessing: the burst and one a minute.
  LoginThrottle day;
  int guesses = 0;
  for (int second = 0; second < 24 * 3600; ++second)
    guesses += day.try_begin({"weber", "192.0.2.1", true}, kFirstTry + std::chrono::seconds(second)) ? 0 : 1;
  EXPECT_LE(guesses, 5 + 24 * 60);
  EXPECT_GE(guesses, 24 * 60 / 2);
}

TEST(LoginThrottle, DoesNotLockOutOthers) {
  LoginThrottle throttle;
  tries(throttle, {"weber", "192.0.2.1"}, kFirstTry);
  EXPECT_FALSE(throttle.try_begin({"weber", "198.51.100.2"}, kFirstTry)) << "the owner of the account, elsewhere";
  EXPECT_FALSE(throttle.try_begin({"huber", "192.0.2.1"}, kFirstTry)) << "a colleague behind the same address";
}

/// Tries that are refused take nothing from colleagues behind the same address.
TEST(LoginThrottle, DoesNotCountRefusedTries) {
  LoginThrottle throttle;
  EXPECT_EQ(tries(throttle, {"weber", "192.0.2.1"}, kFirstTry), 5);
  for (int n = 0; n < 1000; ++n) EXPECT_TRUE(throttle.try_begin({"weber", "192.0.2.1"}, kFirstTry));
  int colleagues = 0;
  for (int n = 0; n < 1000; ++n) colleagues += throttle.try_begin({std::to_string(n), "192.0.2.1"}, kFirstTry) ? 0 : 1;
  EXPECT_EQ(colleagues, 25) << "of the 30 of the address";
  // Refused by the bucket of the address, a try takes nothing from that of the pair.
  EXPECT_EQ(tries(throttle, {"eva", "192.0.2.1", true}, kFirstTry), 5);
}

TEST(LoginThrottle, AClientCannotTryAllAccounts) {
  LoginThrottle throttle;
  int count = 0;
  for (int n = 0; n < 1000; ++n) count += throttle.try_begin({std::to_string(n), "192.0.2.1"}, kFirstTry) ? 0 : 1;
  EXPECT_EQ(count, 30);
  EXPECT_FALSE(throttle.try_begin({"weber", "192.0.2.1", true}, kFirstTry)) << "who has logged in from there before";
}

TEST(LoginThrottle, ManyClientsCannotTryOneAccount) {
  LoginThrottle throttle;
  int count = 0;
  for (int n = 0; n < 1000; ++n)
    count +=
        throttle.try_begin({"weber", "10.0." + std::to_string(n % 250) + "." + std::to_string(n)}, kFirstTry) ? 0 : 1;
  EXPECT_EQ(count, 100);
  EXPECT_FALSE(throttle.try_begin({"weber", "198.51.100.1", true}, kFirstTry)) << "a client that is known";
}

/// All addresses of one customer: their tries leave the owner of the account a place.
TEST(LoginThrottle, OneNetworkCannotExhaustTheTriesOfAnAccount) {
  LoginThrottle throttle;
  int count = 0;
  for (int n = 0; n < 60'000; ++n)
    count += throttle.try_begin(
                 {"weber", client_of("2001:db8:5:" + std::to_string(n % 9999) + "::" + std::to_string(n % 7))},
                 kFirstTry + std::chrono::milliseconds(n))
                 ? 0
                 : 1;
  EXPECT_LE(count, 21);
  EXPECT_FALSE(throttle.try_begin({"weber", client_of("2001:db8:6::1")}, kFirstTry + 60s));
  EXPECT_FALSE(throttle.try_begin({"weber", "198.51.100.1"}, kFirstTry + 60s));
}

TEST(LoginThrottle, RightPasswordsDoNotCount) {
  LoginThrottle throttle;
  for (const bool is_known : {false, true})
    for (int n = 0; n < 200; ++n) {
      const LoginTry login{"weber", "192.0.2.1", is_known};
      ASSERT_FALSE(throttle.try_begin(login, kFirstTry)) << n;
      throttle.succeeded(login);
    }
  EXPECT_EQ(tries(throttle, {"weber", "192.0.2.1"}, kFirstTry), 5) << "and give back no more than was taken";
}

TEST(ClientAddress, IsTheNetworkOfAMachine) {
  EXPECT_EQ(client_of("192.0.2.1"), "192.0.2.1");
  EXPECT_EQ(client_of("::ffff:192.0.2.1"), "192.0.2.1");
  EXPECT_EQ(client_of("2001:db8:1:2:aaaa::1"), "2001:db8:1:2::/64");
  EXPECT_EQ(client_of("2001:db8:1:2:bbbb::2"), client_of("2001:db8:1:2:aaaa::1"));
  EXPECT_NE(client_of("2001:db8:1:3::1"), client_of("2001:db8:1:2::1"));
  EXPECT_EQ(client_of("nonsense"), "nonsense");
  EXPECT_EQ(network_of(client_of("2001:db8:1:2:aaaa::1")), "2001:db8:1::/48");
  EXPECT_EQ(network_of("192.0.2.1"), "192.0.2.0/24");
  EXPECT_EQ(network_of("nonsense"), "nonsense");
}

TEST(ForwardedFor, IsTheLastAddressWithoutItsPort) {
  const auto last = [](TextPairs headers) { return forwarded_address(request_with(std::move(headers))); };
  EXPECT_EQ(last({}), std::nullopt);
  for (const char* header : {"192.0.2.1", "198.51.100.7, 192.0.2.1", "198.51.100.7,192.0.2.1:4711", " 192.0.2.1:1 ",
                             "\"192.0.2.1:4711\"", "::ffff:192.0.2.1"})
    EXPECT_EQ(last({{"X-Forwarded-For", header}}), "192.0.2.1") << header;
  for (const char* header : {"2001:db8::1", "[2001:db8::1]", "\"[2001:db8::1]:4711\"", "192.0.2.1, 2001:DB8::1"})
    EXPECT_EQ(last({{"X-Forwarded-For", header}}), "2001:db8::1") << header;
  for (const char* header :
       {"", "unknown", "_hidden", "192.0.2.1, unknown", "192.0.2", "[", "[]", ",", "a:b:c", "1.2.3.4,"})
    EXPECT_EQ(last({{"X-Forwarded-For", header}}), std::nullopt) << header;
  EXPECT_EQ(last({{"X-Forwarded-For", "198.51.100.7"}, {"x-forwarded-for", "192.0.2.1"}}), "192.0.2.1")
      << "one list in two headers";
}

TEST(HostHeader, IsReadWithoutItsPort) {
  EXPECT_EQ(host_of("LocalHost:8080"), "localhost");
  EXPECT_EQ(host_of("[::1]:8080"), "::1");
  EXPECT_EQ(host_of("10.0.0.7"), "10.0.0.7");
  for (const char* bad : {"", ":80", "a b", "a:", "a:8x", "[::1", "host/path", "user@host", "h\"ost", "[]:80"})
    EXPECT_FALSE(host_of(bad)) << bad;
}

TEST(HostHeader, NamesOfOtherMachinesAreRefused) {
  const auto nobody = [](const std::string&) { return false; };
  for (const char* ours : {"localhost:8080", "127.0.0.1", "127.0.0.1:1234", "[::1]:8080"})
    EXPECT_TRUE(is_for_this_host(request_with({{"Host", ours}}), true, nobody)) << ours;
  for (const char* other :
       {"evil.example", "evil.example:8080", "localhost.evil.example", "127.0.0.1.evil.example", ""})
    EXPECT_FALSE(is_for_this_host(request_with({{"Host", other}}), true, nobody)) << other;
  EXPECT_FALSE(is_for_this_host(request_with({}), true, nobody));
  EXPECT_FALSE(is_for_this_host(request_with({{"Host", "localhost"}, {"Host", "localhost"}}), true, nobody));
  EXPECT_FALSE(is_for_this_host(request_with({{"Host", "localhost"}}), false, nobody));
  EXPECT_TRUE(is_for_this_host(request_with({{"Host", "trainer.example"}}), false,
                               [](const std::string& host) { return host == "trainer.example"; }));
}

TEST(Origin, OfAnotherSiteIsDetected) {
  const auto is_foreign = [](TextPairs headers) {
    headers.emplace_back("Host", "localhost:8080");
    return is_from_another_site(request_with(std::move(headers)), "http");
  };
  EXPECT_FALSE(is_foreign({}));
  EXPECT_FALSE(is_foreign({{"Origin", "http://localhost:8080"}}));
  EXPECT_FALSE(is_foreign({{"Sec-Fetch-Site", "same-origin"}, {"Origin", "http://localhost:8080"}}));
  EXPECT_FALSE(is_foreign({{"Sec-Fetch-Site", "none"}}));
  for (const char* origin : {"http://localhost:8081", "https://localhost:8080", "http://evil.example", "null", "",
                             "http://localhost:8080.evil.example"})
    EXPECT_TRUE(is_foreign({{"Origin", origin}})) << origin;
  for (const char* site : {"cross-site", "same-site", "", "nonsense"})
    EXPECT_TRUE(is_foreign({{"Sec-Fetch-Site", site}})) << site;
  EXPECT_TRUE(is_foreign({{"Origin", "http://localhost:8080"}, {"Origin", "http://localhost:8080"}}));
}

TEST(Cookie, IsHttpOnlyAndSameSite) {
  const std::string plain = login_cookie(kToken, false), secure = login_cookie(kToken, true);
  EXPECT_EQ(plain, "trocar_session=" + kToken + "; Path=/; HttpOnly; SameSite=Strict");
  EXPECT_EQ(secure, "__Host-trocar_session=" + kToken + "; Path=/; HttpOnly; SameSite=Strict; Secure");
  EXPECT_NE(logout_cookie(true).find("Max-Age=0"), std::string::npos);
}

TEST(Cookie, TokenIsFoundAmongOtherCookies) {
  EXPECT_EQ(find_session_token(request_with({{"Cookie", "a=b; trocar_session=" + kToken + "; c=d"}}), false), kToken);
  EXPECT_EQ(find_session_token(request_with({{"Cookie", "a=b"}, {"cookie", "trocar_session=" + kToken}}), false),
            kToken);
  EXPECT_FALSE(find_session_token(request_with({}), false));
  EXPECT_FALSE(find_session_token(request_with({{"Cookie", "trocar_session=" + kToken}}), true))
      << "a cookie without the prefix may have been set by another host";
  EXPECT_FALSE(
      find_session_token(request_with({{"Cookie", "trocar_session=" + kToken + "; trocar_session=" + kToken}}), false));
  for (const std::string& bad : {std::string(), kToken + "x", kToken.substr(1), std::string(42, '\'') + ";"})
    EXPECT_FALSE(find_session_token(request_with({{"Cookie", "trocar_session=" + bad}}), false)) << bad;
}

TEST(Session, ExpiresByIdlenessAgeAndAClockSetBack) {
  const std::chrono::sys_seconds begun{std::chrono::seconds(1'700'000'000)};
  EXPECT_TRUE(is_session_valid(begun, begun, begun));
  EXPECT_TRUE(is_session_valid(begun, begun, begun + 29min + 59s));
  EXPECT_FALSE(is_session_valid(begun, begun, begun + 30min));
  EXPECT_TRUE(is_session_valid(begun, begun + 11h + 59min, begun + 11h + 59min + 59s));
  EXPECT_FALSE(is_session_valid(begun, begun + 12h, begun + 12h));
  EXPECT_FALSE(is_session_valid(begun, begun, begun - 2min));
  EXPECT_FALSE(is_session_valid(begun, begun + 10min, begun + 5min)) << "used in the future";
  EXPECT_TRUE(is_session_valid(begun, begun, begun - 30s)) << "clocks of two machines differ a little";
}

TEST(LogText, CannotForgeALine) {
  EXPECT_EQ(log_text("Weber"), "\"Weber\"");
  EXPECT_EQ(log_text("Müller"), "\"Müller\"");
  EXPECT_EQ(log_text("x\n06:00 info: login succeeded\r\x1b[31m"), "\"x?06:00 info: login succeeded??[31m\"");
  EXPECT_EQ(log_text("a\" from \"b\\"), "\"a? from ?b?\"");
  EXPECT_EQ(log_text("\xff\xfe"), "\"??\"");
  EXPECT_LT(log_text(std::string(10000, 'x')).size(), 70U);
}

TEST(SecurityHeaders, AllowNoForeignOrigins) {
  std::string policy;
  for (const auto& [name, value] : security_headers(false)) {
    if (name == "Content-Security-Policy") policy = value;
    EXPECT_NE(name, "Strict-Transport-Security") << "without TLS it would lock a browser out";
  }
  EXPECT_TRUE(policy.starts_with("default-src 'none'; script-src 'self'")) << policy;
  EXPECT_NE(policy.find("frame-ancestors 'none'"), std::string::npos);
  for (const char* hole : {"unsafe", "*", "http:", "https:", "blob:"}) EXPECT_EQ(policy.find(hole), std::string::npos);
  bool has_hsts = false;
  for (const auto& [name, value] : security_headers(true))
    has_hsts |= name == "Strict-Transport-Security" && value == "max-age=31536000";
  EXPECT_TRUE(has_hsts);
}

}  // namespace
}  // namespace trocar::web
