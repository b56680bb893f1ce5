// TLS: the certificate of a server is checked, whatever the content.
#include "dicom/pacs/detail/http_client.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <thread>

#include "core/files/folders.h"
#include "dicom/pacs/detail/guarded_stream.h"

namespace trocar::dicom::detail {
namespace {

/// A server on the loopback interface with a certificate that nobody has signed, for "localhost".
class TlsServer : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::string line = fmt::format(
        "openssl req -x509 -newkey rsa:2048 -nodes -days 2 -subj /CN=localhost -addext subjectAltName=DNS:localhost "
        "-keyout '{}' -out '{}' 2>/dev/null",
        (folder_ / "key").string(), certificate());
    if (std::system(line.c_str()) != 0) GTEST_SKIP() << "the program openssl is missing";
    server_ = std::make_unique<httplib::SSLServer>(certificate().c_str(), (folder_ / "key").c_str());
    ASSERT_TRUE(server_->is_valid());
    server_->Get("/list", [this](const httplib::Request& request, httplib::Response& answer) {
      authorization_ = request.get_header_value("Authorization");
      answer.set_content("[]", "application/dicom+json");
    });
    port_ = server_->bind_to_any_port("127.0.0.1");
    ASSERT_GT(port_, 0);
    thread_ = std::thread([this] { server_->listen_after_bind(); });
    while (!server_->is_running()) std::this_thread::yield();
  }
  void TearDown() override {
    ::unsetenv("SSL_CERT_FILE");
    if (server_) server_->stop();
    if (thread_.joinable()) thread_.join();
  }

  std::string certificate() const { return (folder_ / "certificate").string(); }

  Result<std::string> get(const std::string& host) const {
    DicomWebOptions server;
    server.is_secure = true;
    server.host = host;
    server.port = port_;
    server.user = "me";
    server.password = "secret";
    server.timeout_s = 5;
    std::string content;
    HttpRequest request;
    request.path = "/list";
    request.accept = "application/dicom+json";
    request.on_answer = [](int, const std::string&) { return Status(); };
    request.on_content = [&](std::string_view bytes) {
      content += bytes;
      return Status();
    };
    TROCAR_TRY_STATUS(http_get(server, request));
    return content;
  }

  TemporaryFolder folder_;
  std::unique_ptr<httplib::SSLServer> server_;
  std::string authorization_;
  std::thread thread_;
  int port_ = 0;
};

TEST_F(TlsServer, RefusesAnUnknownCertificateBeforeSendingThePassword) {
  const auto content = get("localhost");
  ASSERT_FALSE(content);
  EXPECT_NE(content.error().what.find("certificate"), std::string::npos) << content.error().text();
  EXPECT_EQ(authorization_, "");
}

TEST_F(TlsServer, CertificateOfTheHospitalIsAccepted) {
  ::setenv("SSL_CERT_FILE", certificate().c_str(), 1);
  const auto content = get("localhost");
  ASSERT_TRUE(content) << content.error().text();
  EXPECT_EQ(*content, "[]");
  EXPECT_FALSE(authorization_.empty());
}

TEST_F(TlsServer, CertificateOfAnotherNameIsRefused) {
  ::setenv("SSL_CERT_FILE", certificate().c_str(), 1);
  const auto content = get("127.0.0.1");
  ASSERT_FALSE(content);
  EXPECT_NE(content.error().what.find("certificate"), std::string::npos) << content.error().text();
}

}  // namespace
}  // namespace trocar::dicom::detail
