#include "dicom/pacs/detail/http_client.h"

#include <fmt/format.h>

#include "dicom/pacs/detail/dcmtk_setup.h"
#include "dicom/pacs/detail/guarded_stream.h"

namespace trocar::dicom::detail {
namespace {

tl::unexpected<Error> explain(httplib::Error error, StreamTrouble trouble, const DicomWebOptions& server) {
  const std::string place = place_of(server);
  if (trouble == StreamTrouble::kCancelled) return fail("cancelled", place, "fetch it again");
  if (trouble == StreamTrouble::kStalled || error == httplib::Error::ConnectionTimeout)
    return fail(fmt::format("the server sent nothing for {} s", server.timeout_s), place,
                "try again, or allow more time with --timeout");
  if (trouble == StreamTrouble::kEndlessHeader)
    return fail("the server sends an endless header", place, "check that this is the address of its DICOMweb service");
  if (trouble == StreamTrouble::kUntrusted)
    return fail("the certificate of the server is not trusted", place,
                "install the certificate of your hospital, or name it in the environment variable SSL_CERT_FILE");
  if (trouble == StreamTrouble::kNotTls)
    return fail("the server does not answer in TLS", place, "check the port, or use http://");
  if (error == httplib::Error::Connection)
    return fail("cannot connect to the server", place, "check address and port, and that the server is running");
  return fail("the server has closed the connection in the middle, or sent no HTTP", place,
              "try again, and check that this is the address of its DICOMweb service");
}

/// As a browser names it: without the usual port.
std::string host_header(const DicomWebOptions& server) {
  constexpr int kHttp = 80, kHttps = 443;
  const std::string host = server.host.find(':') == std::string::npos ? server.host : fmt::format("[{}]", server.host);
  return server.port == (server.is_secure ? kHttps : kHttp) ? host : fmt::format("{}:{}", host, server.port);
}

/// May throw exceptions of the library.
Status get_throwing(const DicomWebOptions& server, const HttpRequest& request) {
  GuardedClient client(server.host, server.port,
                       {server.is_secure ? server.host : "", server.timeout_s, request.is_cancelled});
  client.set_connection_timeout(server.timeout_s);
  client.set_read_timeout(server.timeout_s);
  client.set_write_timeout(server.timeout_s);
  client.set_tcp_nodelay(true);
  client.set_url_encode(false);
  client.set_follow_location(false);
  if (!server.user.empty()) client.set_basic_auth(server.user, server.password);
  Status status;
  const httplib::Headers headers = {
      {"Host", host_header(server)}, {"Accept", request.accept}, {"Accept-Encoding", "identity"}};
  const auto on_answer = [&](const httplib::Response& answer) {
    status = request.on_answer(answer.status, answer.get_header_value("Content-Type"));
    return status.has_value();
  };
  const auto on_content = [&](const char* bytes, std::size_t size) {
    status = request.on_content(std::string_view(bytes, size));
    return status.has_value();
  };
  const httplib::Result result = client.Get(request.path, headers, on_answer, on_content);
  TROCAR_TRY_STATUS(status);
  if (result) return {};
  return explain(result.error(), client.trouble(), server);
}

}  // namespace

std::string place_of(const DicomWebOptions& server) {
  return fmt::format("{}://{}:{}{}", server.is_secure ? "https" : "http", server.host, server.port, server.path);
}

Status http_get(const DicomWebOptions& server, const HttpRequest& request) {
  const BrokenPipesIgnored guard;
  try {
    return get_throwing(server, request);
  } catch (const std::exception&) {  // of the library, for headers that it cannot parse
    return explain(httplib::Error::Read, StreamTrouble::kNone, server);
  }
}

}  // namespace trocar::dicom::detail
