// Logins: who gets in, how a login ends, and what a forged request achieves.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "results/accounts.h"
#include "results/names.h"
#include "service_lab.h"
#include "signing/password.h"
#include "signing/token.h"
#include "web/api/route.h"

namespace trocar::web {
namespace {

using namespace std::chrono_literals;
using namespace testing;

TEST(Login, ReturnsACookieAndACsrfToken) {
  ServiceLab lab;
  const HttpAnswer answer = lab.log_in("dr. WEBER");
  EXPECT_EQ(answer.status, 200) << body_of(answer);
  EXPECT_EQ(json_of(answer)["account"], (Json{{"name", "Dr. Weber"}, {"role", "admin"}}));
  const std::string cookie = header_of(answer, "Set-Cookie");
  EXPECT_TRUE(cookie.starts_with("trocar_session=")) << cookie;
  EXPECT_NE(cookie.find("; HttpOnly; SameSite=Strict"), std::string::npos);
  EXPECT_EQ(json_of(lab.get("/api/me"))["csrf"], lab.csrf);
}

TEST(Login, StoresOnlyADigestOfTheToken) {
  ServiceLab lab;
  lab.log_in();
  const std::string token = lab.cookie.substr(lab.cookie.find('=') + 1);
  EXPECT_FALSE(results::find_web_session(lab.repository(), token).value());
  EXPECT_TRUE(results::find_web_session(lab.repository(), signing::token_digest(token)).value());
}

TEST(Login, AnswersUnknownNamesLikeWrongPasswords) {
  ServiceLab lab;
  const HttpAnswer unknown = lab.log_in("nobody", kPassword), wrong = lab.log_in(kAdmin, "another password");
  EXPECT_EQ(unknown.status, 401);
  EXPECT_EQ(wrong.status, 401);
  EXPECT_EQ(body_of(unknown), body_of(wrong));
  EXPECT_EQ(unknown.headers, wrong.headers);
  EXPECT_EQ(lab.log_in("' OR 1=1 --", "' OR '1'='1").status, 401);
  EXPECT_EQ(lab.log_in(kAdmin, "").status, 401);
  EXPECT_EQ(lab.log_in(kAdmin, std::string(kPassword) + " ").status, 401);
}

TEST(Login, IsSlowedDownAfterFiveFailures) {
  ServiceLab lab;
  for (int n = 0; n < 5; ++n) EXPECT_EQ(lab.log_in(kAdmin, "wrong").status, 401);
  const HttpAnswer slowed = lab.log_in();
  EXPECT_EQ(slowed.status, 429);
  EXPECT_EQ(header_of(slowed, "Retry-After"), "60");
  lab.address = "192.0.2.9";
  EXPECT_EQ(lab.log_in().status, 200) << "the owner of the account is not locked out";
  lab.address = "127.0.0.1";
  lab.pass(60s);
  EXPECT_EQ(lab.log_in().status, 200);
}

/// A client can write X-Forwarded-For itself; a proxy appends the address that it sees.
TEST(Login, BlanksAroundTheNameDoNotBypassTheThrottle) {
  ServiceLab lab;
  const std::string name = kAdmin;
  for (const std::string& typed : {name, " " + name, name + " ", "  " + name + "   ", " " + name + "  "})
    EXPECT_EQ(lab.log_in(typed, "wrong").status, 401) << typed;
  for (const std::string& typed : {name, "    " + name, name + "      "})
    EXPECT_EQ(lab.log_in(typed, "wrong").status, 429) << typed;
  EXPECT_EQ(results::name_key("  Anna   Meier "), results::name_key("anna meier"));
  EXPECT_NE(results::name_key("anna meier"), results::name_key("annameier"));
}

TEST(Login, ForgedAddressDoesNotBypassTheThrottle) {
  const auto status = [](ServiceLab& lab, const std::string& forwarded) {
    HttpRequest request = lab.request("POST", "/api/login", {{"name", kAdmin}, {"password", "wrong"}});
    std::erase_if(request.headers, [](const auto& h) { return h.first == "Origin"; });
    request.headers.emplace_back("X-Forwarded-For", forwarded);
    return lab.send(request).status;
  };
  ServiceLab direct, proxied(true, true);
  for (int n = 0; n < 5; ++n) {
    EXPECT_EQ(status(direct, "192.0.2." + std::to_string(n)), 401);
    EXPECT_EQ(status(proxied, "192.0.2." + std::to_string(n) + ", 198.51.100.1"), 401);
  }
  EXPECT_EQ(status(direct, "192.0.2.99"), 429);
  EXPECT_EQ(status(proxied, "192.0.2.99, 198.51.100.1:4711"), 429) << "a port makes no other client";
  EXPECT_EQ(status(proxied, "192.0.2.99, 198.51.100.1"), 429);
  EXPECT_EQ(status(proxied, "198.51.100.2"), 401) << "another client of the proxy";
}

/// Wrong tries from all the addresses of a network, and from many of them: who has logged in before can log in again,
/// also after a restart of the server.
TEST(Login, KnownClientIsNotThrottledByOthers) {
  ServiceLab lab;
  lab.address = "2001:db8:1:2::1";
  ASSERT_EQ(lab.log_in().status, 200);
  lab.restart();
  for (int n = 0; n < 300; ++n) {
    lab.address = "10.0." + std::to_string(n % 100) + ".1";
    lab.log_in(kAdmin, "wrong");
  }
  lab.address = "198.51.100.1";
  EXPECT_EQ(lab.log_in().status, 429) << "a client that is not known";
  lab.address = "2001:db8:1:2:ffff::7";
  EXPECT_EQ(lab.log_in().status, 200) << "another address of the network that is known";
}

TEST(Login, FloodFromOneNetworkDoesNotBlockTheOwner) {
  ServiceLab lab;
  for (int n = 0; n < 500; ++n) {
    lab.address = "2001:db8:1:2::" + std::to_string(n);
    lab.log_in(kAdmin, "wrong");
  }
  lab.address = "192.0.2.1";
  EXPECT_EQ(lab.log_in().status, 200);
}

TEST(Login, IsLoggedWithoutThePassword) {
  ServiceLab lab;
  ::testing::internal::CaptureStderr();
  lab.log_in("somebody\n06:00:00 info: forged", "a wrong password");
  const std::string log = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(log.find("login failed: account \"somebody?06:00:00 info: forged\" from 127.0.0.1"), std::string::npos)
      << log;
  EXPECT_EQ(log.find("wrong password"), std::string::npos) << log;
  EXPECT_EQ(std::count(log.begin(), log.end(), '\n'), 1) << log;
}

TEST(Login, ReplacesTheCurrentSession) {
  ServiceLab lab;
  lab.log_in();
  const std::string first = lab.cookie;
  lab.log_in();
  EXPECT_NE(lab.cookie, first);
  lab.cookie = first;
  EXPECT_EQ(lab.get("/api/me").status, 401);
}

TEST(Login, MalformedBodiesAreRefused) {
  ServiceLab lab;
  for (const Json& body : {Json::object(), Json{{"name", 1}, {"password", 2}}, Json{{"name", kAdmin}}, Json::array(),
                           Json("text"), Json{{"name", {{"$ne", ""}}}, {"password", {{"$ne", ""}}}},
                           Json{{"name", std::string(5000, 'x')}, {"password", "x"}}})
    EXPECT_EQ(lab.post("/api/login", body).status, 400) << body.dump();
  HttpRequest broken = lab.request("POST", "/api/login");
  for (const std::string& text : {std::string("{"), std::string("{\"name\":\"\xff\"}"), std::string(1000, '['),
                                  fmt::format(R"({{"name":"{0}","name":"{0}","password":"{1}"}})", kAdmin, kPassword),
                                  fmt::format(R"({{"name":"{}","password":"{}","role":"admin"}})", kAdmin, kPassword),
                                  fmt::format(R"({{"name":"{}","password":"{}"}} trailing)", kAdmin, kPassword),
                                  fmt::format(R"({{"name":"{}","password":NaN}})", kAdmin)}) {
    broken.body = text;
    EXPECT_EQ(lab.send(broken).status, 400) << text;
  }
}

/// The pattern of a route with a key in place of each '*'.
std::string target_of(const Route& route) {
  std::string target(route.pattern);
  for (std::size_t at = target.find('*'); at != std::string::npos; at = target.find('*'))
    target.replace(at, 1, std::string(32, '0'));
  return target;
}

int status_of(ServiceLab& lab, const Route& route) {
  return lab.send(lab.request(std::string(route.method), target_of(route))).status;
}

TEST(Session, IsRequiredExceptForPublicPaths) {
  ServiceLab lab;
  std::size_t closed = 0;
  for (const Route& route : all_routes()) {
    if (route.access == Access::kPublic) continue;
    EXPECT_EQ(status_of(lab, route), 401) << route.method << " " << route.pattern;
    ++closed;
  }
  EXPECT_GT(closed, 25U);
  EXPECT_EQ(lab.get("/api/health").status, 204);
  EXPECT_EQ(lab.get("/api/public/forms/x").status, 404);
}

TEST(Session, RejectsForgedCookies) {
  ServiceLab lab;
  lab.log_in();
  const std::string own = lab.cookie;
  std::string other = own;
  other.back() = other.back() == 'A' ? 'B' : 'A';
  for (const std::string& cookie : {other, own + "x", std::string("trocar_session="),
                                    std::string("trocar_session=' OR 1=1 --"), "__Host-" + own, own + "; " + own}) {
    lab.cookie = cookie;
    EXPECT_EQ(lab.get("/api/me").status, 401) << cookie;
  }
  lab.cookie = own;
  EXPECT_EQ(lab.get("/api/me").status, 200);
}

TEST(Session, EndsWhenIdleOldOrFromTheFuture) {
  ServiceLab idle;
  idle.log_in();
  idle.pass(29min);
  EXPECT_EQ(idle.get("/api/me").status, 200) << "and a request keeps it";
  idle.pass(29min);
  EXPECT_EQ(idle.get("/api/me").status, 200);
  idle.pass(30min);
  EXPECT_EQ(idle.get("/api/me").status, 401);
  idle.pass(-30min);
  EXPECT_EQ(idle.get("/api/me").status, 401) << "an ended login does not come back";

  ServiceLab old;
  old.log_in();
  for (int n = 0; n < 35; ++n) {
    old.pass(20min);
    EXPECT_EQ(old.get("/api/me").status, 200);
  }
  old.pass(20min);
  EXPECT_EQ(old.get("/api/me").status, 401) << "12 h after the login, whatever its use";

  ServiceLab back;
  back.log_in();
  back.now.utc -= 1h;
  EXPECT_EQ(back.get("/api/me").status, 401) << "the clock was set back";
}

TEST(Session, LogoutEndsIt) {
  ServiceLab lab;
  lab.log_in();
  const HttpAnswer out = lab.post("/api/logout", {});
  EXPECT_EQ(out.status, 204);
  EXPECT_NE(header_of(out, "Set-Cookie").find("Max-Age=0"), std::string::npos);
  EXPECT_EQ(lab.get("/api/me").status, 401);
}

TEST(Session, CookieIsHostOnlyOverTls) {
  ServiceLab lab(true);
  HttpRequest request = lab.request("POST", "/api/login", {{"name", kAdmin}, {"password", kPassword}});
  for (auto& [name, value] : request.headers)
    if (name == "Origin") value = "https://localhost:8080";
  const std::string cookie = header_of(lab.send(request), "Set-Cookie");
  EXPECT_TRUE(cookie.starts_with("__Host-trocar_session=")) << cookie;
  EXPECT_NE(cookie.find("; Secure"), std::string::npos);
}

TEST(Csrf, ChangesNeedTheTokenOfThePage) {
  ServiceLab lab;
  lab.log_in();
  const std::string own = lab.csrf;
  for (const std::string& token : {std::string(), std::string("x"), own + "x", own.substr(1) + "A"}) {
    lab.csrf = token;
    EXPECT_EQ(lab.post("/api/forms", {{"title", "x"}}).status, 403) << token;
    EXPECT_EQ(lab.post("/api/logout", {}).status, 403);
  }
  ServiceLab other;
  other.log_in();
  lab.csrf = other.csrf;
  EXPECT_EQ(lab.post("/api/logout", {}).status, 403) << "the token of another session";
  lab.csrf = own;
  EXPECT_EQ(lab.post("/api/forms", {{"title", "x"}}).status, 201);
}

TEST(Csrf, RequestsFromAnotherSiteAreRefused) {
  ServiceLab lab;
  lab.log_in();
  for (const auto& [header, value] : TextPairs{{"Origin", "http://evil.example"},
                                               {"Origin", "null"},
                                               {"Origin", "https://localhost:8080"},
                                               {"Sec-Fetch-Site", "cross-site"},
                                               {"Sec-Fetch-Site", "same-site"}}) {
    for (const char* method : {"GET", "POST"}) {
      HttpRequest request = lab.request(method, method == std::string("GET") ? "/api/me" : "/api/logout");
      std::erase_if(request.headers, [&](const auto& h) { return h.first == header; });
      request.headers.emplace_back(header, value);
      EXPECT_EQ(lab.send(request).status, 403) << method << " " << value;
    }
  }
  EXPECT_EQ(lab.get("/api/me").status, 200);
}

TEST(Csrf, EveryChangeNeedsTheToken) {
  for (const Route& route : all_routes()) {
    if (route.access == Access::kPublic || route.method == "GET") continue;
    ServiceLab lab;
    lab.log_in();
    lab.csrf = "x";
    EXPECT_EQ(status_of(lab, route), 403) << route.method << " " << route.pattern;
  }
}

/// A form of HTML can send these types across sites without asking first.
TEST(Csrf, BodiesOfFormsAreRefused) {
  ServiceLab lab;
  lab.log_in();
  for (const char* type : {"text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x", "",
                           "application/json-patch", "text/json"}) {
    HttpRequest request = lab.request("POST", "/api/forms", {{"title", "x"}});
    for (auto& [name, value] : request.headers)
      if (name == "Content-Type") value = type;
    EXPECT_EQ(lab.send(request).status, 415) << type;
  }
}

TEST(Password, ChangeEndsOnlyOtherSessions) {
  ServiceLab lab;
  lab.log_in();
  const std::string other_cookie = lab.cookie, other_csrf = lab.csrf;
  lab.cookie.clear();
  lab.csrf.clear();
  lab.log_in();
  EXPECT_EQ(lab.post("/api/password", {{"old", "wrong"}, {"new", "seven quiet otters"}}).status, 403);
  EXPECT_EQ(lab.post("/api/password", {{"old", kPassword}, {"new", "short"}}).status, 400);
  EXPECT_EQ(lab.post("/api/password", {{"old", kPassword}, {"new", "Dr. Weber 2026"}}).status, 400);
  EXPECT_EQ(lab.post("/api/password", {{"old", kPassword}, {"new", "passwordpassword"}}).status, 400);
  const std::string before = lab.cookie;
  const HttpAnswer changed = lab.post("/api/password", {{"old", kPassword}, {"new", "seven quiet otters"}});
  ASSERT_EQ(changed.status, 204) << body_of(changed);
  const std::string set = header_of(changed, "Set-Cookie");
  lab.cookie = set.substr(0, set.find(';'));
  EXPECT_NE(lab.cookie, before);
  EXPECT_EQ(json_of(lab.get("/api/me"))["csrf"], lab.csrf) << "the page goes on";
  for (const std::string& ended : {other_cookie, before}) {
    lab.cookie = ended;
    EXPECT_EQ(lab.get("/api/me").status, 401);
  }
  lab.cookie.clear();
  EXPECT_EQ(lab.log_in().status, 401);
  EXPECT_EQ(lab.log_in(kAdmin, "seven quiet otters").status, 200);
}

TEST(Password, LoginRenewsAnOldHash) {
  ServiceLab lab;
  const std::string weak = signing::hash_password(kPassword, {1, std::size_t{8} << 10}).value();
  ASSERT_TRUE(results::add_account(lab.repository(), "old", results::Role::kInstructor, weak, lab.now.utc));
  EXPECT_EQ(lab.log_in("old").status, 200);
  EXPECT_EQ(lab.get("/api/me").status, 200);
  const auto account = results::find_account(lab.repository(), "old").value();
  EXPECT_FALSE(signing::needs_rehash(account->password_hash, kQuickWork));
}

TEST(Accounts, AreManagedOnlyByAdmins) {
  ServiceLab lab;
  lab.log_in(kInstructor);
  std::set<std::string> of_admins;
  for (const Route& route : all_routes()) {
    if (route.access != Access::kAdmin) continue;
    EXPECT_EQ(status_of(lab, route), 403) << route.method << " " << route.pattern;
    of_admins.insert(fmt::format("{} {}", route.method, route.pattern));
  }
  EXPECT_EQ(of_admins,
            (std::set<std::string>{"GET /api/accounts", "POST /api/accounts", "DELETE /api/accounts/*",
                                   "PUT /api/accounts/*/password", "DELETE /api/people/*", "PUT /api/pins"}));
  EXPECT_EQ(lab.get("/api/accounts").status, 403);
  EXPECT_EQ(lab.post("/api/accounts", {{"name", "x"}, {"password", kPassword}, {"role", "admin"}}).status, 403);
  EXPECT_EQ(lab.send(lab.request("DELETE", "/api/accounts/Dr. Weber")).status, 403);
  EXPECT_EQ(lab.send(lab.request("DELETE", "/api/people/" + lab.add_person("Anna").id, {{"confirm", "Anna"}})).status,
            403);
  EXPECT_EQ(lab.get("/api/overview").status, 200);
}

TEST(Accounts, AreAddedListedAndRemoved) {
  ServiceLab lab;
  lab.log_in();
  const Json good = {
      {"name", " Prof.  <b>X<b>'; DROP TABLE accounts "}, {"password", "seven quiet otters"}, {"role", "instructor"}};
  const HttpAnswer added = lab.post("/api/accounts", good);
  ASSERT_EQ(added.status, 201) << body_of(added);
  EXPECT_EQ(json_of(added)["name"], "Prof. <b>X<b>'; DROP TABLE accounts");
  EXPECT_EQ(lab.post("/api/accounts", good).status, 409);
  for (const auto& [field, value] : TextPairs{{"role", "root"},
                                              {"password", "short"},
                                              {"name", "a\nb"},
                                              {"name", ""},
                                              {"name", "a/b"},
                                              {"name", ".."},
                                              {"name", "."},
                                              {"name", "a\\b"}}) {
    Json bad = good;
    bad[field] = value;
    EXPECT_EQ(lab.post("/api/accounts", bad).status, 400) << field << value;
  }
  EXPECT_EQ(json_of(lab.get("/api/accounts"))["accounts"].size(), 3U);
  EXPECT_EQ(body_of(lab.get("/api/accounts")).find("argon2"), std::string::npos);
  EXPECT_EQ(lab.send(lab.request("DELETE", "/api/accounts/nobody")).status, 404);
  EXPECT_EQ(lab.send(lab.request("DELETE", "/api/accounts/huber")).status, 204);
  EXPECT_EQ(lab.send(lab.request("DELETE", "/api/accounts/Dr. Weber")).status, 409) << "the last admin";
  EXPECT_EQ(json_of(lab.get("/api/accounts"))["accounts"].size(), 2U);
}

/// A path is split before it is decoded: an older program took names with a slash.
TEST(Accounts, WithAnyNameAreRemoved) {
  ServiceLab lab;
  lab.log_in();
  ASSERT_TRUE(lab.repository().database().transaction("x", [](soci::session& session) {
    for (const std::string name : {"a/b", "50%", "c%2Fd", "e?f#g"}) {
      const std::string key = results::name_key(name);  // must outlive the statement
      session << "INSERT INTO accounts (id, name, name_key, is_admin, password_hash, added_s) VALUES (:i, :n, :k, 0, "
                 "'', 0)",
          soci::use(name), soci::use(name), soci::use(key);
    }
  }));
  for (const char* path : {"a%2Fb", "50%25", "c%252Fd", "e%3Ff%23g", "%68uber"})
    EXPECT_EQ(lab.send(lab.request("DELETE", std::string("/api/accounts/") + path)).status, 204) << path;
  EXPECT_EQ(lab.send(lab.request("DELETE", "/api/accounts/a%2")).status, 400) << "malformed";
  EXPECT_EQ(lab.send(lab.request("DELETE", "/api%2Faccounts/a")).status, 404);
  EXPECT_EQ(json_of(lab.get("/api/accounts"))["accounts"].size(), 1U);
}

TEST(Accounts, RemovalEndsTheirLogins) {
  ServiceLab lab;
  lab.log_in(kInstructor);
  EXPECT_EQ(lab.get("/api/me").status, 200);
  ASSERT_TRUE(results::remove_account(lab.repository(), kInstructor));
  lab.pass(1s);  // another program's change
  EXPECT_EQ(lab.get("/api/me").status, 401);

  ServiceLab own;
  own.log_in(kInstructor);
  const std::string cookie = own.cookie, csrf = own.csrf;
  own.cookie.clear();
  own.csrf.clear();
  own.log_in();
  EXPECT_EQ(own.send(own.request("DELETE", "/api/accounts/huber")).status, 204);
  own.cookie = cookie;
  own.csrf = csrf;
  EXPECT_EQ(own.get("/api/me").status, 401) << "at once";
}

}  // namespace
}  // namespace trocar::web
