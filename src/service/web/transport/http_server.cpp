#include "web/transport/http_server.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include <cerrno>
#include <cstring>
#include <thread>
#include <utility>

#include "core/files/input_file.h"
#include "core/start_thread.h"
#include "core/text.h"
#include "web/transport/detail/library_server.h"

namespace trocar::web {

struct HttpServer::State {
  State(ServerOptions server_options, Handler handler)
      : options(std::move(server_options)), server(options, std::move(handler)) {}
  ~State() {
    server.end();
    if (thread.joinable()) thread.join();
  }

  ServerOptions options;
  detail::LibraryServer server;
  int port = 0;
  std::thread thread;
};

HttpServer::HttpServer(std::unique_ptr<State> state) : state_(std::move(state)) {}
HttpServer::HttpServer(HttpServer&&) noexcept = default;
HttpServer& HttpServer::operator=(HttpServer&&) noexcept = default;
HttpServer::~HttpServer() = default;

Result<HttpServer> HttpServer::start(ServerOptions options, Handler handler) {
  auto state = std::make_unique<State>(std::move(options), std::move(handler));
  errno = 0;
  const auto port = state->server.bind();
  if (!port) {
    const ListenAddress& listen = state->options.listen;
    const std::string where = fmt::format("{}:{}", url_host(listen.host), listen.port);
    if (errno == EADDRINUSE)
      return fail("another program listens there", where, "choose another port with --listen, or end that program");
    if (errno == EACCES)
      return fail("ports below 1024 need more rights", where, "choose a port from 1024 on with --listen");
    return fail(errno == EADDRNOTAVAIL ? "not an address of this machine" : "cannot listen there", where,
                "choose an address of this machine with --listen");
  }
  state->port = *port;
  TROCAR_TRY(state->thread, start_thread("server", [server = &state->server] { server->serve(); }));
  while (!state->server.is_running()) std::this_thread::yield();
  return HttpServer(std::move(state));
}

void HttpServer::stop() {
  state_->server.end();
  if (state_->thread.joinable()) state_->thread.join();
}

int HttpServer::port() const noexcept {
  return state_->port;
}

std::string HttpServer::url() const {
  return fmt::format("{}://{}:{}", state_->options.tls ? "https" : "http", url_host(state_->options.listen.host),
                     state_->port);
}

namespace {

constexpr int kMostPort = 65535;
constexpr const char* kAdvice = "write HOST:PORT, such as 127.0.0.1:8080 or [::1]:8080";

bool is_ipv4(const std::string& host) {
  in_addr address{};
  return ::inet_pton(AF_INET, host.c_str(), &address) == 1;
}

bool is_ipv6(const std::string& host) {
  in6_addr address{};
  return ::inet_pton(AF_INET6, host.c_str(), &address) == 1;
}

}  // namespace

bool ListenAddress::is_loopback() const noexcept {
  in_addr v4{};
  if (::inet_pton(AF_INET, host.c_str(), &v4) == 1) return (ntohl(v4.s_addr) >> 24) == 127;
  in6_addr v6{};
  if (::inet_pton(AF_INET6, host.c_str(), &v6) == 1) return IN6_IS_ADDR_LOOPBACK(&v6);
  return host == "localhost";
}

bool ListenAddress::is_any() const noexcept {
  in6_addr v6{};
  if (::inet_pton(AF_INET6, host.c_str(), &v6) == 1) return IN6_IS_ADDR_UNSPECIFIED(&v6);
  return host == "0.0.0.0";
}

Result<ListenAddress> parse_listen_address(std::string_view text) {
  ListenAddress address;
  const std::size_t colon = text.rfind(':');
  std::string_view port = text;
  if (colon != std::string_view::npos) {
    std::string_view host = text.substr(0, colon);
    port = text.substr(colon + 1);
    const bool has_brackets = host.starts_with('[') && host.ends_with(']');
    if (has_brackets) host = host.substr(1, host.size() - 2);
    address.host = std::string(host);
    const bool is_host = has_brackets ? is_ipv6(address.host) : is_ipv4(address.host) || host == "localhost";
    if (!is_host) return fail_usage("not an address to listen on", std::string(text), kAdvice);
  }
  const auto number = parse_number<int>(port);
  if (!number || *number < 0 || *number > kMostPort)
    return fail_usage("not a port from 0 to 65535", std::string(text), kAdvice);
  address.port = *number;
  return address;
}

std::string url_host(const std::string& host) {
  return is_ipv6(host) ? "[" + host + "]" : host;
}

namespace {

/// TLS 1.2: forward secrecy and authenticated encryption; TLS 1.3 has nothing else.
constexpr const char* kCiphers = "ECDHE+AESGCM:ECDHE+CHACHA20";

constexpr FileLimit kPem{FileKind::kOther, "PEM file", std::uint64_t{1} << 20};

}  // namespace

Result<TlsContext> TlsContext::load(const TlsFiles& files) {
  std::error_code error;
  TROCAR_TRY_STATUS(InputFile::open(files.certificate, kPem));
  TROCAR_TRY_STATUS(InputFile::open(files.key, kPem));
  if ((std::filesystem::status(files.key, error).permissions() & std::filesystem::perms::others_all) !=
      std::filesystem::perms::none)
    return fail("every user of this machine may read the key", files.key.string(), "chmod o-rwx it, or make a new key");
  const std::shared_ptr<SSL_CTX> context(SSL_CTX_new(TLS_server_method()), SSL_CTX_free);
  if (!context || SSL_CTX_set_min_proto_version(context.get(), TLS1_2_VERSION) != 1 ||
      SSL_CTX_set_cipher_list(context.get(), kCiphers) != 1)
    return fail("TLS cannot be used", "OpenSSL", "reinstall OpenSSL");
  SSL_CTX_set_options(context.get(), SSL_OP_NO_COMPRESSION | SSL_OP_NO_RENEGOTIATION | SSL_OP_CIPHER_SERVER_PREFERENCE);
  SSL_CTX_set_mode(context.get(), SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  ERR_clear_error();
  if (SSL_CTX_use_certificate_chain_file(context.get(), files.certificate.c_str()) != 1)
    return fail("not a certificate in PEM", files.certificate.string(),
                "give the file that begins with -----BEGIN CERTIFICATE-----");
  // An encrypted key would ask on the terminal of a server that may have none.
  SSL_CTX_set_default_passwd_cb(context.get(), [](char*, int, int, void*) { return -1; });
  if (SSL_CTX_use_PrivateKey_file(context.get(), files.key.c_str(), SSL_FILETYPE_PEM) != 1) {
    const bool is_other = ERR_GET_REASON(ERR_peek_last_error()) == X509_R_KEY_VALUES_MISMATCH;
    ERR_clear_error();
    if (is_other)
      return fail("the key does not belong to the certificate", files.key.string(),
                  "give the key of " + files.certificate.string());
    return fail("not a private key in PEM without a password", files.key.string(),
                "give the file that begins with -----BEGIN PRIVATE KEY-----");
  }
  const X509* const certificate = SSL_CTX_get0_certificate(context.get());
  if (X509_cmp_current_time(X509_get0_notAfter(certificate)) < 0)
    return fail("the certificate has expired", files.certificate.string(), "renew it");
  return TlsContext(context);
}

bool TlsContext::names(const std::string& host) const {
  X509* const certificate = SSL_CTX_get0_certificate(context_.get());
  return X509_check_ip_asc(certificate, host.c_str(), 0) == 1 ||
         X509_check_host(certificate, host.data(), host.size(), 0, nullptr) == 1;
}

}  // namespace trocar::web
