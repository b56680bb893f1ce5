// A DICOMweb server that makes mistakes: one clear line, nothing written.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "cli/program.h"
#include "dicom/pacs/testing/made_object.h"
#include "pacs/sockets.h"

namespace trocar::pacs_test {
namespace {
namespace fs = std::filesystem;
namespace made = dicom::testing;

using cli_test::Outcome;

/// A server that reads a request, sends bytes and closes.
FakeServer::Serve answers(std::string bytes) {
  return [bytes = std::move(bytes)](int socket) {
    receive_header(socket);
    send_all(socket, bytes);
  };
}

std::string answer(const std::string& type, const std::string& content) {
  return fmt::format("HTTP/1.1 200 OK\r\nContent-Type: {}\r\nContent-Length: {}\r\n\r\n{}", type, content.size(),
                     content);
}

std::string list_of_series(int images) {
  return fmt::format(R"([{{"00080060": {{"vr": "CS", "Value": ["CT"]}}, "0020000E": {{"vr": "UI", "Value": ["{}"]}},)"
                     R"( "00201209": {{"vr": "IS", "Value": [{}]}}}}])",
                     made::kCtSeriesUid, images);
}

FakeServer::Serve lists(int images) {
  return answers(answer("application/dicom+json", list_of_series(images)));
}

const std::string kMultipart = "multipart/related; type=\"application/dicom\"; boundary=frontier";

std::string dicom_part(const std::string& file) {
  return "--frontier\r\nContent-Type: application/dicom\r\n\r\n" + file + "\r\n";
}

class FromFakeServer : public ::testing::Test {
 protected:
  std::string arguments(int port, int timeout_s = 20) const {
    return fmt::format("patient fetch --dicomweb http://127.0.0.1:{}/web --timeout {} --study {} --out '{}'", port,
                       timeout_s, made::kStudyUid, folder_ / "a");
  }

  void expect_refused(std::vector<FakeServer::Serve> serve, const std::string& message, int timeout_s = 20) {
    const FakeServer server(std::move(serve));
    const Outcome outcome = cli_test::trocar(arguments(server.port(), timeout_s));
    EXPECT_EQ(outcome.exit_status, 1) << outcome.err;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << outcome.err;
    EXPECT_EQ(cli_test::line_count(outcome.err), 1) << outcome.err;
    EXPECT_TRUE(folder_.is_empty());
  }

  void expect_fetched(std::vector<FakeServer::Serve> serve) {
    const FakeServer server(std::move(serve));
    const Outcome outcome = cli_test::trocar(arguments(server.port()));
    EXPECT_EQ(outcome.exit_status, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("2 images of 1 series"), std::string::npos) << outcome.out;
    EXPECT_TRUE(fs::exists(folder_.path() / "a" / "series_001_CT" / "00002.dcm"));
    fs::remove_all(folder_.path() / "a");
  }

  cli_test::TemporaryFolder folder_;
  const std::string two_ =
      dicom_part(made::made_ct(0).file()) + dicom_part(made::made_ct(1).file()) + "--frontier--\r\n";
};

/// In chunks of `size` bytes (RFC 9112, 7.1).
std::string chunked(const std::string& type, const std::string& content, std::size_t size,
                    const std::string& encoding = {}) {
  std::string bytes =
      "HTTP/1.1 200 OK\r\nContent-Type: " + type + "\r\nTransfer-Encoding: chunked\r\n" + encoding + "\r\n";
  for (std::size_t at = 0; at < content.size(); at += size) {
    const std::string chunk = content.substr(at, size);
    bytes += fmt::format("{:x}\r\n{}\r\n", chunk.size(), chunk);
  }
  return bytes + "0\r\n\r\n";
}

TEST_F(FromFakeServer, EveryTransferEncodingIsRead) {
  expect_fetched({lists(2), answers(answer(kMultipart, two_))});
  expect_fetched({lists(2), answers(chunked(kMultipart, two_, 1000))});
  expect_fetched({lists(2), answers("HTTP/1.1 200 OK\r\nContent-Type: " + kMultipart + "\r\n\r\n" + two_)});
}

TEST_F(FromFakeServer, CompressedContentIsRead) {
  const cli_test::TemporaryFolder temporary;
  { std::ofstream(temporary / "content", std::ios::binary) << two_; }
  if (cli_test::run_shell("gzip '" + (temporary / "content") + "'").exit_status != 0) GTEST_SKIP() << "gzip is missing";
  const std::string packed = cli_test::read_text(temporary / "content.gz");
  expect_fetched({lists(2), answers(chunked(kMultipart, packed, 1000, "Content-Encoding: gzip\r\n"))});
}

TEST_F(FromFakeServer, ExplainsTheHttpStatus) {
  const auto status = [](const std::string& line) {
    return std::vector<FakeServer::Serve>{answers("HTTP/1.1 " + line + "\r\nContent-Length: 5\r\n\r\noops\n")};
  };
  expect_refused(status("401 Unauthorized"), "asks for a user");
  expect_refused(status("403 Forbidden"), "does not permit");
  expect_refused(status("404 Not Found"), "does not have this study");
  expect_refused(status("500 Internal Server Error"), "status 500");
  expect_refused(status("302 Found\r\nLocation: http://elsewhere.invalid/"), "redirects");
  expect_refused({lists(2), answers("HTTP/1.1 406 Not Acceptable\r\nContent-Length: 0\r\n\r\n")},
                 "does not send DICOM");
}

TEST_F(FromFakeServer, PasswordIsSentToThisServerOnly) {
  std::string header;
  FakeServer server({[&](int socket) {
    header = receive_header(socket);
    send_all(socket, "HTTP/1.1 401 Unauthorized\r\nContent-Length: 0\r\n\r\n");
  }});
  const Outcome outcome = cli_test::trocar(arguments(server.port()) + " --user me", "TROCAR_PACS_PASSWORD=secret");
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_NE(header.find("Authorization: Basic bWU6c2VjcmV0"), std::string::npos) << header;  // base64 of "me:secret"
  EXPECT_NE(outcome.err.find("refuses user or password"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("without encryption"), std::string::npos) << outcome.err;
  EXPECT_EQ(outcome.err.find("secret"), std::string::npos) << outcome.err;
}

TEST_F(FromFakeServer, PasswordFileIsRead) {
  const cli_test::TemporaryFolder temporary;
  { std::ofstream(temporary / "password") << "secret\n"; }
  std::string header;
  FakeServer server({[&](int socket) { header = receive_header(socket); }});
  cli_test::trocar(arguments(server.port()) + " --user me --password-file '" + (temporary / "password") + "'");
  EXPECT_NE(header.find("Authorization: Basic bWU6c2VjcmV0"), std::string::npos) << header;
  const Outcome missing =
      cli_test::trocar(arguments(server.port()) + " --user me </dev/null", "env -u TROCAR_PACS_PASSWORD");
  EXPECT_EQ(missing.exit_status, 2) << missing.err;
}

TEST_F(FromFakeServer, NamesAServerThatDoesNotAnswer) {
  const Outcome outcome = cli_test::trocar(arguments(free_port()));
  EXPECT_EQ(outcome.exit_status, 1);
  EXPECT_NE(outcome.err.find("cannot connect to the server"), std::string::npos) << outcome.err;
}

TEST_F(FromFakeServer, RefusesNonHttpBytes) {
  expect_refused({answers("")}, "closed the connection");
  expect_refused({answers(std::string(5000, '\xff'))}, "no HTTP");
  expect_refused({answers("HTTP/1.1 200")}, "no HTTP");
  expect_refused({answers(answer("text/html", "<html>log in</html>"))}, "does not answer with a list");
  expect_refused({answers(answer("application/dicom+json", std::string(1000, '[')))}, "does not answer with a list");
  expect_refused({answers(answer("application/dicom+json", std::string(std::size_t{9} << 20, ' ')))},
                 "too long a list");
  expect_refused({answers(answer("application/dicom+json", "[1, null, {\"0020000E\": 7}]"))}, "no such study");
  expect_refused({lists(2), answers(answer("text/html", "<html>log in</html>"))}, "not with DICOM objects");
}

TEST_F(FromFakeServer, EndlessHeadersAreRefused) {
  const auto pour = [](const std::string& begin, const std::string& again) {
    return std::vector<FakeServer::Serve>{[=](int socket) {
      receive_header(socket);
      send_all(socket, begin);
      for (int n = 0; n < 1000; ++n) send_all(socket, again);
      wait_for_close(socket);
    }};
  };
  expect_refused(pour("HTTP/1.1 200 OK\r\nX: ", std::string(10'000, 'x')), "endless header");
  expect_refused(pour("HTTP/1.1 200 OK\r\n", "X: " + std::string(5000, 'x') + "\r\n"), "endless header");
  expect_refused(pour("", std::string(10'000, 'x')), "endless header");
}

TEST_F(FromFakeServer, TimesOutOnSilence) {
  const std::string message = "sent nothing for 1 s";
  expect_refused({wait_for_close}, message, 1);
  const std::string whole = answer(kMultipart, two_);
  expect_refused({lists(2),
                  [&](int socket) {
                    receive_header(socket);
                    send_all(socket, whole.substr(0, whole.size() / 2));
                    wait_for_close(socket);
                  }},
                 message, 1);
}

TEST_F(FromFakeServer, ContentThatEndsEarlyIsRefused) {
  const std::string whole = answer(kMultipart, two_);
  expect_refused({lists(2), answers(whole.substr(0, whole.size() / 2))}, "closed the connection in the middle");
  const std::string cut = two_.substr(0, two_.size() / 2);
  expect_refused({lists(2), answers(answer(kMultipart, cut))}, "ends too early");
  expect_refused({lists(2), answers("HTTP/1.1 200 OK\r\nContent-Type: " + kMultipart + "\r\n\r\n" + cut)},
                 "ends too early");
  expect_refused({lists(2), answers("HTTP/1.1 200 OK\r\nContent-Type: " + kMultipart +
                                    "\r\nContent-Length: 999999999999999999\r\n\r\n" + cut)},
                 "closed the connection in the middle");
}

TEST_F(FromFakeServer, RefusesNonDicomParts) {
  expect_refused({lists(1), answers(answer(kMultipart, dicom_part("<html>") + "--frontier--"))}, "not DICOM");
  expect_refused({lists(1), answers(answer(kMultipart, dicom_part("") + "--frontier--"))}, "not DICOM");
  expect_refused(
      {lists(1), answers(answer(kMultipart, dicom_part(made::made_ct(0).file().substr(0, 900)) + "--frontier--"))},
      "ends too early");
  expect_refused({lists(1), answers(answer(kMultipart, "--frontier--"))}, "sent 0 of 1 image");
  expect_refused({lists(3), answers(answer(kMultipart, two_))}, "sent 2 of 3 images");
}

}  // namespace
}  // namespace trocar::pacs_test
