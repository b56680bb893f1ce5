#include "dicom/pacs/detail/http_client.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text.h"
#include "dicom/pacs/detail/data_set.h"
#include "dicom/pacs/detail/dimse_command.h"
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

namespace {

constexpr std::size_t kMaxPartHeader = std::size_t{1} << 14;
constexpr std::size_t kMaxBoundary = 70;  // RFC 2046
constexpr std::string_view kEndOfHeader = "\r\n\r\n";

tl::unexpected<Error> not_multipart() {
  return fail("the answer of the server is no series of DICOM objects", "WADO-RS",
              "check that this is the address of its DICOMweb service");
}

}  // namespace

std::optional<std::string> multipart_boundary(std::string_view content_type) {
  const std::string small = ascii::lower_case(content_type);
  const std::size_t at = small.find("boundary=");
  if (!small.starts_with("multipart/related") || at == std::string::npos) return std::nullopt;
  std::string_view value = content_type.substr(at + std::string_view("boundary=").size());
  if (value.starts_with('"')) {
    value.remove_prefix(1);
    value = value.substr(0, value.find('"'));
  } else {
    value = value.substr(0, value.find_first_of("; \t"));
  }
  const bool is_printable = std::ranges::all_of(value, [](char c) { return c >= ' ' && c < 0x7f; });
  if (value.empty() || value.size() > kMaxBoundary || !is_printable) return std::nullopt;
  return std::string(value);
}

MultipartReader::MultipartReader(const std::string& boundary, ObjectSink& sink)
    : sink_(sink), delimiter_("\r\n--" + boundary), buffer_("\r\n") {}  // the first delimiter may begin the content

Status MultipartReader::push(std::string_view bytes) {
  if (state_ == State::kDone) return {};  // RFC 2046: what follows is ignored
  buffer_ += bytes;
  while (true) {
    TROCAR_TRY(const bool has_more, step());
    if (!has_more) return {};
  }
}

Status MultipartReader::finish() const {
  if (state_ == State::kDone) return {};
  return fail("the answer of the server ends too early", "WADO-RS", "try again");
}

Status MultipartReader::pass_on(std::size_t size) {
  if (state_ == State::kPart && size > 0) TROCAR_TRY_STATUS(sink_.append(std::string_view(buffer_).substr(0, size)));
  buffer_.erase(0, size);
  return {};
}

/// False: more bytes are needed.
Result<bool> MultipartReader::step() {
  if (state_ == State::kBefore || state_ == State::kPart) {
    const std::size_t found = buffer_.find(delimiter_);
    if (found == std::string::npos) {  // the end of the buffer may be the start of a delimiter
      TROCAR_TRY_STATUS(pass_on(buffer_.size() - std::min(buffer_.size(), delimiter_.size() - 1)));
      return false;
    }
    TROCAR_TRY_STATUS(pass_on(found));
    if (state_ == State::kPart) TROCAR_TRY_STATUS(sink_.end({}));
    buffer_.erase(0, delimiter_.size());
    state_ = State::kAfterBoundary;
    return true;
  }
  if (state_ == State::kAfterBoundary) {
    if (buffer_.size() < 2) return false;
    state_ = buffer_.starts_with("--") ? State::kDone : State::kHeader;
    if (state_ == State::kDone) buffer_.clear();
    return state_ == State::kHeader;
  }
  if (state_ == State::kHeader) {  // from the end of the boundary's line to an empty line
    const std::size_t end = buffer_.find(kEndOfHeader);
    if (std::min(end, buffer_.size()) > kMaxPartHeader) return not_multipart();
    if (end == std::string::npos) return false;
    buffer_.erase(0, end + kEndOfHeader.size());
    state_ = State::kPart;
    TROCAR_TRY_STATUS(sink_.begin());
    return true;
  }
  return false;
}

}  // namespace trocar::dicom::detail
