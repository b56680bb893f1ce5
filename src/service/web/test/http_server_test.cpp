// The transport, over loopback sockets: limits of what a client may send, and how connections end.
#include "web/transport/http_server.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <thread>

#include "core/testing/no_threads.h"
#include "raw_client.h"

namespace trocar::web {
namespace {

using testing::answer_to;
using testing::RawClient;
using testing::status_of;
using namespace std::chrono_literals;

class Transport : public ::testing::Test {
 protected:
  ServerOptions options() const {
    ServerOptions options;
    options.listen = {"127.0.0.1", 0};
    options.body_bytes = 1000;
    options.header_time = 300ms;
    options.body_time = 300ms;
    options.idle_time = 300ms;
    options.default_headers = {{"X-Default", "here"}};
    return options;
  }
  void start(const ServerOptions& options) {
    auto server = HttpServer::start(options, [this](const HttpRequest& request) {
      ++requests_;
      return text_answer(200, "text/plain", request.method + " " + request.path + " [" + request.body + "]");
    });
    ASSERT_TRUE(server) << server.error().text();
    server_.emplace(std::move(*server));
  }
  void SetUp() override { start(options()); }
  int port() const { return server_->port(); }

  std::optional<HttpServer> server_;
  std::atomic<int> requests_{0};
};

TEST_F(Transport, AnswersSeveralRequestsOnOneConnection) {
  RawClient client(port());
  for (int n = 0; n < 3; ++n) {
    client.send("GET /a%20b?c=d HTTP/1.1\r\nHost: x\r\n\r\n");
    const std::string answer = client.read_until("[]");
    EXPECT_EQ(status_of(answer), 200) << answer;
    EXPECT_NE(answer.find("GET /a%20b []"), std::string::npos) << "as it was sent\n" << answer;
    EXPECT_NE(answer.find("X-Default: here\r\n"), std::string::npos) << answer;
  }
  client.send("POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 4\r\nConnection: close\r\n\r\nbody");
  EXPECT_NE(client.read_to_end().find("POST / [body]"), std::string::npos);
}

class StreamedContent : public Transport {
 protected:
  void SetUp() override {
    auto server = HttpServer::start(options(), [](const HttpRequest& request) {
      HttpAnswer answer = text_answer(200, "text/csv", {});
      answer.body.reset();
      answer.source = [n = 0, does_fail = request.path == "/fails"]() mutable -> Result<std::string> {
        if (++n <= 3) return std::string(100'000, static_cast<char>('a' + n));
        if (does_fail) return fail("the disk failed");
        return std::string();
      };
      return answer;
    });
    ASSERT_TRUE(server) << server.error().text();
    server_.emplace(std::move(*server));
  }
  std::string get(const std::string& path, const std::string& version) {
    return answer_to(port(), "GET " + path + " HTTP/" + version + "\r\nHost: x\r\nConnection: close\r\n\r\n");
  }
};

TEST_F(StreamedContent, ArrivesInChunksWithATerminator) {
  const std::string answer = get("/", "1.1");
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_NE(answer.find("Transfer-Encoding: chunked\r\n"), std::string::npos);
  EXPECT_EQ(std::ranges::count(answer, 'c'),
            100'000 + std::ranges::count(answer.substr(0, answer.find("\r\n\r\n")), 'c'));
  EXPECT_TRUE(answer.ends_with("\r\n0\r\n\r\n")) << answer.substr(answer.size() - 20);
  const std::string head = answer_to(port(), "HEAD / HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
  EXPECT_TRUE(head.ends_with("\r\n\r\n")) << head;
}

TEST_F(StreamedContent, EndsWithTheConnectionForHttp10) {
  const std::string answer = get("/", "1.0");
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_EQ(answer.find("chunked"), std::string::npos);
  EXPECT_EQ(answer.size() - answer.find("\r\n\r\n") - 4, 300'000U);
}

TEST_F(StreamedContent, EndsWithoutTerminatorAfterAFailure) {
  const std::string answer = get("/fails", "1.1");
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_FALSE(answer.ends_with("0\r\n\r\n"));
  EXPECT_EQ(status_of(get("/", "1.1")), 200) << "the next connection";
}

TEST_F(Transport, PipelinedRequestsAreAnsweredInOrder) {
  const std::string answer =
      answer_to(port(), "GET /1 HTTP/1.1\r\nHost: x\r\n\r\nGET /2 HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
  EXPECT_LT(answer.find("GET /1"), answer.find("GET /2"));
  EXPECT_NE(answer.find("GET /2"), std::string::npos);
}

TEST_F(Transport, AnswersHeadWithoutContent) {
  const std::string answer = answer_to(port(), "HEAD /x HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
  EXPECT_EQ(status_of(answer), 200);
  EXPECT_TRUE(answer.ends_with("\r\n\r\n")) << answer;
}

TEST_F(Transport, RefusesATooLargeBodyBeforeItIsSent) {
  const std::string answer = answer_to(port(), "POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 1001\r\n\r\n");
  EXPECT_EQ(status_of(answer), 413) << answer;
  EXPECT_NE(answer.find("Connection: close"), std::string::npos) << answer;
  EXPECT_EQ(status_of(answer_to(port(), "POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 99999999999999999999\r\n\r\n")),
            413);
  EXPECT_EQ(requests_, 0);
}

TEST_F(Transport, AnswersWhileATooLargeBodyIsSent) {
  const std::string body(200000, 'x');
  EXPECT_EQ(status_of(answer_to(port(), "POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 200000\r\n\r\n" + body)), 413);
}

/// Two lengths, a chunked body and a body of GET would let two servers disagree where a request ends.
TEST_F(Transport, AmbiguousEndsOfARequestAreRefused) {
  const std::string hidden = "GET /hidden HTTP/1.1\r\nHost: x\r\n\r\n";
  for (const auto& [header, status] :
       std::vector<std::pair<std::string, int>>{{"Transfer-Encoding: chunked\r\n", 411},
                                                {"Transfer-Encoding: chunked\r\nContent-Length: 3\r\n", 411},
                                                {"Content-Length: 3\r\nContent-Length: 30\r\n", 400},
                                                {"Content-Length: -1\r\n", 400},
                                                {"Content-Length: +3\r\n", 400},
                                                {"Content-Length: 0x3\r\n", 400},
                                                {"Content-Length: 3\r\nContent-Encoding: gzip\r\n", 415}}) {
    const std::string answer = answer_to(port(), "POST / HTTP/1.1\r\nHost: x\r\n" + header + "\r\n" + hidden);
    EXPECT_EQ(status_of(answer), status) << header << answer;
    EXPECT_EQ(answer.find("hidden"), std::string::npos) << header << answer;
    EXPECT_NE(answer.find("X-Default: here\r\n"), std::string::npos) << answer;
  }
  const std::string get = answer_to(port(), "GET / HTTP/1.1\r\nHost: x\r\nContent-Length: 30\r\n\r\n" + hidden);
  EXPECT_EQ(status_of(get), 400) << get;
  EXPECT_EQ(get.find("hidden"), std::string::npos) << get;
}

TEST_F(Transport, LimitsHeaderSize) {
  EXPECT_EQ(status_of(answer_to(port(), "GET /" + std::string(1100, 'a') + " HTTP/1.1\r\nHost: x\r\n\r\n")), 414);
  EXPECT_NE(status_of(answer_to(port(), "GET / HTTP/1.1\r\nX: " + std::string(20000, 'a') + "\r\n\r\n")), 200);
  std::string many = "GET / HTTP/1.1\r\n";
  for (int n = 0; n < 5000; ++n) many += "X-Header: value\r\n";
  EXPECT_NE(status_of(answer_to(port(), many + "\r\n")), 200);
  EXPECT_NE(status_of(answer_to(port(), "GET /" + std::string(1000000, 'a'))), 200);
  EXPECT_EQ(requests_, 0);
}

TEST_F(Transport, MalformedRequestsHaveAnErrorInJson) {
  for (const char* bad : {"NONSENSE\r\n\r\n", "GET\r\n\r\n", "BREW / HTTP/1.1\r\n\r\n", "GET / HTTP/9.9\r\n\r\n",
                          "\x16\x03\x01\x02\r\n\r\n"}) {
    const std::string answer = answer_to(port(), bad);
    EXPECT_EQ(status_of(answer), 400) << bad << answer;
    EXPECT_NE(answer.find("{\"error\":"), std::string::npos) << answer;
    EXPECT_NE(answer.find("X-Default: here"), std::string::npos) << answer;
  }
  EXPECT_EQ(requests_, 0);
}

TEST_F(Transport, UnusualMethodsReachTheHandlerOrAreRefused) {
  EXPECT_EQ(status_of(answer_to(port(), "OPTIONS /x HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")), 200);
  EXPECT_EQ(status_of(answer_to(port(), "TRACE /x HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")), 400);
  EXPECT_EQ(status_of(answer_to(port(), "CONNECT x:1 HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")), 400);
}

/// A header that comes byte by byte ends at the deadline of the whole header, not of each byte.
TEST_F(Transport, SlowHeadersEndAtTheirDeadline) {
  RawClient client(port());
  const auto begin = std::chrono::steady_clock::now();
  int sent = 0;
  const std::string header = "GET /" + std::string(900, 'a');
  while (sent < 200 && client.send(header.substr(static_cast<std::size_t>(sent), 1))) {
    ++sent;
    std::this_thread::sleep_for(20ms);
  }
  EXPECT_LT(sent, 200) << "the server must close within 4 s";
  EXPECT_GE(std::chrono::steady_clock::now() - begin, 300ms);
  EXPECT_EQ(requests_, 0);
}

TEST_F(Transport, IdleAndUnfinishedConnectionsEnd) {
  RawClient idle(port()), unfinished(port());
  unfinished.send("POST / HTTP/1.1\r\nHost: x\r\nContent-Length: 10\r\n\r\nabc");
  EXPECT_EQ(idle.read_to_end(), "");
  EXPECT_NE(status_of(unfinished.read_to_end()), 200);
  EXPECT_EQ(requests_, 0);
}

TEST_F(Transport, IdleConnectionsMakeRoomForOthers) {
  server_.reset();
  ServerOptions few = options();
  few.threads = 4;
  few.idle_time = 60s;
  start(few);
  std::vector<std::unique_ptr<RawClient>> idle;
  for (int n = 0; n < 8; ++n) idle.push_back(std::make_unique<RawClient>(port()));
  EXPECT_EQ(status_of(answer_to(port(), "GET / HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n")), 200);
}

TEST_F(Transport, StopFinishesRunningRequests) {
  server_.reset();
  std::atomic<bool> is_inside{false}, may_end{false};
  auto server = HttpServer::start(options(), [&](const HttpRequest&) {
    is_inside = true;
    while (!may_end) std::this_thread::yield();
    return text_answer(200, "text/plain", "finished");
  });
  ASSERT_TRUE(server);
  RawClient client(server->port());
  client.send("GET / HTTP/1.1\r\nHost: x\r\n\r\n");
  while (!is_inside) std::this_thread::yield();
  std::thread stopper([&] { server->stop(); });
  may_end = true;
  EXPECT_NE(client.read_to_end().find("finished"), std::string::npos);
  stopper.join();
}

TEST_F(Transport, APortInUseIsNamed) {
  ServerOptions same = options();
  same.listen.port = port();
  const auto second = HttpServer::start(same, [](const HttpRequest&) { return empty_answer(204); });
  ASSERT_FALSE(second);
  EXPECT_EQ(second.error().what, "another program listens there");
  same.listen = {"192.0.2.1", 0};  // RFC 5737: for documentation, of no machine
  const auto foreign = HttpServer::start(same, [](const HttpRequest&) { return empty_answer(204); });
  ASSERT_FALSE(foreign);
  EXPECT_EQ(foreign.error().what, "not an address of this machine");
}

TEST_F(Transport, AnswersAnExceptionWithoutDetails) {
  server_.reset();
  auto server = HttpServer::start(
      options(), [](const HttpRequest&) -> HttpAnswer { throw std::runtime_error("SELECT secret FROM accounts"); });
  const std::string answer = answer_to(server->port(), "GET / HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n");
  EXPECT_EQ(status_of(answer), 500);
  EXPECT_EQ(answer.find("SELECT"), std::string::npos) << answer;
}

TEST(ListenAddress, ReadsHostsAndPorts) {
  EXPECT_EQ(parse_listen_address("9000").value().host, "127.0.0.1");
  EXPECT_EQ(parse_listen_address("9000").value().port, 9000);
  EXPECT_EQ(parse_listen_address("[::1]:80").value().host, "::1");
  EXPECT_TRUE(parse_listen_address("[::1]:80").value().is_loopback());
  EXPECT_TRUE(parse_listen_address("127.8.8.8:80").value().is_loopback());
  EXPECT_TRUE(parse_listen_address("localhost:80").value().is_loopback());
  EXPECT_FALSE(parse_listen_address("0.0.0.0:80").value().is_loopback());
  EXPECT_TRUE(parse_listen_address("[::]:80").value().is_any());
  EXPECT_FALSE(parse_listen_address("10.0.0.1:80").value().is_any());
  for (const char* bad : {"", ":", "host.example:80", "127.0.0.1:", "127.0.0.1:65536", "127.0.0.1:-1", "::1:80",
                          "1.2.3:80", "127.0.0.1:80x"}) {
    const auto address = parse_listen_address(bad);
    ASSERT_FALSE(address) << bad;
    EXPECT_EQ(address.error().exit_status, 2);
  }
}

TEST_F(Transport, WithoutAThreadDoesNotStart) {
  const trocar::testing::NoThreads none;
  const auto server = HttpServer::start(options(), [](const HttpRequest&) { return HttpAnswer(); });
  ASSERT_FALSE(server);
  EXPECT_NE(server.error().what.find("does not start"), std::string::npos);
}

}  // namespace
}  // namespace trocar::web
