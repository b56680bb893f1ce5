// The whole server over loopback sockets, plain and with TLS.
#include <gtest/gtest.h>
#include <netinet/tcp.h>

#include <fstream>

#include "raw_client.h"
#include "service_lab.h"
#include "web/security/request_guards.h"
#include "web/transport/detail/httplib_include.h"
#include "web/transport/http_server.h"

namespace trocar::web {
namespace {

using namespace testing;

ServerOptions on_any_port(bool is_secure) {
  ServerOptions options;
  options.listen = {"127.0.0.1", 0};
  options.default_headers = security_headers(is_secure);
  return options;
}

class Loopback : public ::testing::Test {
 protected:
  void SetUp() override {
    auto server =
        HttpServer::start(on_any_port(false), [this](const HttpRequest& request) { return lab_.send(request); });
    ASSERT_TRUE(server) << server.error().text();
    server_.emplace(*std::move(server));
  }
  std::string get(const std::string& target, const std::string& more = {}) {
    return answer_to(server_->port(),
                     "GET " + target + " HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n" + more + "\r\n");
  }

  ServiceLab lab_;
  std::optional<HttpServer> server_;
};

TEST_F(Loopback, ABrowserLogsInReadsAndLogsOut) {
  httplib::Client browser("127.0.0.1", server_->port());
  browser.set_keep_alive(true);
  const auto login =
      browser.Post("/api/login", config::json_text({{"name", kAdmin}, {"password", kPassword}}), "application/json");
  ASSERT_TRUE(login);
  ASSERT_EQ(login->status, 200) << login->body;
  const std::string cookie = login->get_header_value("Set-Cookie");
  const httplib::Headers headers = {
      {"Cookie", cookie.substr(0, cookie.find(';'))},
      {"X-CSRF-Token", config::parse_json(login->body, "answer").value()["csrf"].get<std::string>()}};
  const auto me = browser.Get("/api/me", headers);
  ASSERT_TRUE(me);
  EXPECT_EQ(me->status, 200);
  EXPECT_EQ(me->get_header_value("Cache-Control"), "no-store");
  const auto out = browser.Post("/api/logout", headers, "{}", "application/json");
  ASSERT_TRUE(out);
  EXPECT_EQ(out->status, 204);
  EXPECT_EQ(browser.Get("/api/me", headers)->status, 401);
}

TEST_F(Loopback, EveryAnswerHasTheSecurityHeaders) {
  for (const char* target : {"/", "/assets/index-1.js", "/missing.js", "/api/health", "/api/me", "/api/nothing"}) {
    const std::string answer = get(target);
    for (const char* header : {"Content-Security-Policy: default-src 'none'", "X-Content-Type-Options: nosniff",
                               "Referrer-Policy: no-referrer", "Cross-Origin-Opener-Policy: same-origin",
                               "Cross-Origin-Resource-Policy: same-origin", "Cache-Control: "})
      EXPECT_NE(answer.find(header), std::string::npos) << target << "\n" << answer;
    for (const char* told : {"\r\nServer:", "X-Powered-By", "Access-Control-Allow"})
      EXPECT_EQ(answer.find(told), std::string::npos) << answer;
    EXPECT_EQ(answer.find("Cache-Control", answer.find("Cache-Control") + 1), std::string::npos) << "twice\n" << answer;
  }
}

TEST_F(Loopback, PathsCannotLeaveTheWebRoot) {
  for (const char* target :
       {"/../results.sqlite", "/%2e%2e/results.sqlite", "/..%2fresults.sqlite", "/%2e%2e%5cresults.sqlite",
        "/assets/../../results.sqlite", "/assets/%2e%2e/%2e%2e/results.sqlite", "//etc/passwd.txt",
        "/etc/passwd%00.html", "/%c0%ae%c0%ae/results.sqlite"}) {
    const std::string answer = get(target);
    EXPECT_NE(status_of(answer), 200) << target;
    EXPECT_EQ(answer.find("SQLite"), std::string::npos) << target;
  }
}

TEST_F(Loopback, EnforcesInterfaceLimits) {
  const std::string head = "POST /api/login HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n";
  const auto post = [&](const std::string& type, const std::string& body) {
    return status_of(answer_to(server_->port(), head + "Content-Type: " + type + "\r\nContent-Length: " +
                                                    std::to_string(body.size()) + "\r\n\r\n" + body));
  };
  EXPECT_EQ(post("application/json", std::string((256 << 10) + 1, ' ')), 413);
  EXPECT_EQ(post("text/plain", "{}"), 415);
  EXPECT_EQ(post("application/json", "{\"a\":" + std::string(100, '[') + std::string(100, ']') + "}"), 400);
  EXPECT_EQ(post("application/json", std::string(100000, '[')), 400);
  EXPECT_EQ(post("multipart/form-data; boundary=b",
                 "--b\r\nContent-Disposition: form-data; name=\"name\"\r\n\r\nx\r\n--b--\r\n"),
            415);
  EXPECT_EQ(post("application/x-www-form-urlencoded", "name=x&password=y"), 415);
}

TEST_F(Loopback, RequestsForOtherHostsAreRefused) {
  EXPECT_EQ(
      status_of(answer_to(server_->port(), "GET /api/me HTTP/1.1\r\nHost: evil.example\r\nConnection: close\r\n\r\n")),
      421);
  EXPECT_EQ(status_of(answer_to(server_->port(), "GET /api/me HTTP/1.1\r\nConnection: close\r\n\r\n")), 421);
  EXPECT_EQ(
      status_of(answer_to(server_->port(),
                          "GET http://evil.example/api/me HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n")),
      400);
  EXPECT_EQ(status_of(get("/api/me", "X-Forwarded-Host: evil.example\r\nX-Forwarded-For: 1.2.3.4\r\n")), 401);
}

class OverTls : public ::testing::Test {
 protected:
  void SetUp() override {
    make_certificate("key", "certificate", "-days 2");
    const auto tls = TlsContext::load(files());
    ASSERT_TRUE(tls) << tls.error().text();
    ServerOptions options = on_any_port(true);
    options.tls = *tls;
    auto server = HttpServer::start(options, [this](const HttpRequest& request) { return lab_.send(request); });
    ASSERT_TRUE(server) << server.error().text();
    server_.emplace(*std::move(server));
  }
  void make_certificate(const std::string& key, const std::string& certificate, const std::string& more) {
    const std::string line =
        "openssl req -x509 -newkey rsa:2048 -nodes -subj /CN=localhost -addext "
        "subjectAltName=DNS:trainer.example,DNS:*.ward.example,IP:10.0.0.7 " +
        more + " -keyout '" + (folder_ / key).string() + "' -out '" + (folder_ / certificate).string() +
        "' 2>/dev/null && chmod 600 '" + (folder_ / key).string() + "'";
    ASSERT_EQ(std::system(line.c_str()), 0) << "the program openssl is missing";
  }
  TlsFiles files() const { return {folder_ / "certificate", folder_ / "key"}; }

  TemporaryFolder folder_;
  ServiceLab lab_{true};
  std::optional<HttpServer> server_;
};

/// A client that trusts every certificate.
struct TrustingClient {
  explicit TrustingClient(int port) : http("127.0.0.1", port) { http.enable_server_certificate_verification(false); }
  httplib::Result get() { return http.Get("/", {{"Host", "localhost"}}); }
  SSL_CTX* context() { return http.ssl_context(); }

  httplib::SSLClient http;
};

TEST_F(OverTls, AnswersWithStrictTransportSecurity) {
  TrustingClient client(server_->port());
  const auto answer = client.get();
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 200);
  EXPECT_EQ(answer->get_header_value("Strict-Transport-Security"), "max-age=31536000");
  EXPECT_TRUE(server_->url().starts_with("https://127.0.0.1:"));
}

TEST_F(OverTls, OldVersionsAndWeakCiphersAreRefused) {
  for (const int version : {TLS1_VERSION, TLS1_1_VERSION}) {
    TrustingClient client(server_->port());
    SSL_CTX_set_security_level(client.context(), 0);
    SSL_CTX_set_min_proto_version(client.context(), version);
    SSL_CTX_set_max_proto_version(client.context(), version);
    EXPECT_FALSE(client.get()) << version;
  }
  for (const char* cipher : {"AES128-SHA", "AES256-GCM-SHA384", "ECDHE-RSA-AES128-SHA", "NULL-SHA256"}) {
    TrustingClient client(server_->port());
    SSL_CTX_set_security_level(client.context(), 0);
    SSL_CTX_set_max_proto_version(client.context(), TLS1_2_VERSION);
    ASSERT_EQ(SSL_CTX_set_cipher_list(client.context(), cipher), 1) << cipher;
    EXPECT_FALSE(client.get()) << cipher;
  }
  TrustingClient client(server_->port());
  SSL_CTX_set_max_proto_version(client.context(), TLS1_2_VERSION);
  EXPECT_TRUE(client.get()) << "TLS 1.2 itself is served";
}

TEST_F(OverTls, PlainTextIsNotAnswered) {
  EXPECT_EQ(status_of(answer_to(server_->port(), "GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")), 0);
}

TEST_F(OverTls, CertificateNamesTheServer) {
  const TlsContext tls = TlsContext::load(files()).value();
  for (const char* name : {"trainer.example", "TRAINER.example", "a.ward.example", "10.0.0.7"})
    EXPECT_TRUE(tls.names(name)) << name;
  for (const char* name : {"evil.example", "ward.example", "a.b.ward.example", "10.0.0.8", ""})
    EXPECT_FALSE(tls.names(name)) << name;
}

TEST_F(OverTls, UnusableFilesAreNamed) {
  make_certificate("other key", "other certificate", "-days 2");
  std::ofstream(folder_ / "text") << "no certificate";
  const auto what = [](const TlsFiles& unusable) {
    const auto loaded = TlsContext::load(unusable);
    return loaded ? std::string() : loaded.error().what;
  };
  EXPECT_EQ(what({folder_ / "certificate", folder_ / "other key"}), "the key does not belong to the certificate");
  EXPECT_EQ(what({folder_ / "text", folder_ / "key"}), "not a certificate in PEM");
  EXPECT_EQ(what({folder_ / "certificate", folder_ / "certificate"}), "every user of this machine may read the key");
  std::filesystem::permissions(folder_ / "text", std::filesystem::perms::owner_read);
  EXPECT_EQ(what({folder_ / "certificate", folder_ / "text"}), "not a private key in PEM without a password");
  EXPECT_NE(what({folder_ / "missing", folder_ / "key"}), "");
  std::filesystem::permissions(folder_ / "key", std::filesystem::perms::others_read,
                               std::filesystem::perm_options::add);
  EXPECT_EQ(what(files()), "every user of this machine may read the key");
}

}  // namespace
}  // namespace trocar::web
