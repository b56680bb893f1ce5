#include "dicom/pacs/dicomweb_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "config/json.h"
#include "core/result.h"
#include "core/text.h"
#include "dicom/pacs/detail/data_set.h"
#include "dicom/pacs/detail/http_client.h"

namespace trocar::dicom {
namespace {

using namespace detail;

constexpr std::size_t kMaxJson = std::size_t{8} << 20;
constexpr int kOk = 200;
constexpr int kNoContent = 204;
constexpr int kNotFound = 404;

Status check_status(int status, const DicomWebOptions& server) {
  const std::string place = place_of(server);
  if (status == kOk) return {};
  if (status == 401 && server.user.empty())
    return fail("the server asks for a user and a password", place, "name the user with --user");
  if (status == 401) return fail("the server refuses user or password", place, "check both");
  if (status == 403)
    return fail("the server does not permit this user to read the study", place, "ask its administrator");
  if (status == kNotFound)
    return fail("the server does not have this study, or no DICOMweb service at this address", place,
                "check the UID and the path of the address");
  if (status >= 300 && status < 400)
    return fail(fmt::format("the server redirects to another address (status {})", status), place,
                "give the address of the DICOMweb service itself");
  if (status == 406 || status == 415)
    return fail("the server does not send DICOM files", place, "retrieve with --pacs");
  return fail(fmt::format("the server could not answer: status {}", status), place,
              "try again, or ask its administrator");
}

/// Percent-encodes all but letters, digits and "-._~" (RFC 3986).
std::string url_encoded(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = ascii::is_letter_or_digit(c) || std::string_view("-._~").find(c) != std::string_view::npos;
    result += is_plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return result;
}

/// All values of an attribute in DICOM's JSON model (PS3.18, F.2), separated by "\"; empty if it is missing.
std::string text_of(const config::Json& object, const char* tag) {
  std::string result;
  const auto attribute = object.find(tag);
  if (attribute == object.end() || !attribute->is_object()) return result;
  const auto values = attribute->find("Value");
  if (values == attribute->end() || !values->is_array()) return result;
  for (const config::Json& value : *values) {
    if (!result.empty()) result += '\\';
    if (value.is_string()) result += value.get<std::string>();
    if (value.is_number_integer()) result += std::to_string(value.get<std::int64_t>());
  }
  return result;
}

SeriesEntry series_of_json(const config::Json& object) {
  return {text_of(object, "0020000E"), shown_text(text_of(object, "00080060")), shown_text(text_of(object, "0008103E")),
          parse_number<int>(text_of(object, "00200011")), parse_number<std::size_t>(text_of(object, "00201209"))};
}

StudyEntry study_of_json(const config::Json& object) {
  return {text_of(object, "0020000D"), shown_text(text_of(object, "00080020")), shown_text(text_of(object, "00081030")),
          shown_text(text_of(object, "00080061"))};
}

class DicomWebSource final : public PacsSource {
 public:
  explicit DicomWebSource(DicomWebOptions server) : server_(std::move(server)) {}

  Result<std::vector<StudyEntry>> list_studies(const std::string& patient_id) override {
    TROCAR_TRY(const config::Json answer,
               query("/studies?PatientID=" + url_encoded(patient_id) + "&includefield=00081030&includefield=00080061"));
    std::vector<StudyEntry> studies;
    for (const config::Json& object : answer)
      if (object.is_object()) studies.push_back(study_of_json(object));
    return studies;
  }

  Result<std::vector<SeriesEntry>> list_series(const std::string& study_uid) override {
    TROCAR_TRY(const config::Json answer,
               query("/studies/" + study_uid + "/series?includefield=0008103E&includefield=00201209"));
    std::vector<SeriesEntry> series;
    for (const config::Json& object : answer)
      if (object.is_object()) series.push_back(series_of_json(object));
    return series;
  }

  Status retrieve(const std::string& study_uid, const std::string& series_uid, ObjectSink& sink) override {
    std::optional<MultipartReader> reader;
    HttpRequest request;
    request.path = server_.path + "/studies/" + study_uid + "/series/" + series_uid;
    // Every encoding as it is stored: the server need not unpack.
    request.accept = "multipart/related; type=\"application/dicom\"; transfer-syntax=*";
    request.is_cancelled = [&] { return sink.is_cancelled(); };
    request.on_answer = [&](int status, const std::string& content_type) -> Status {
      TROCAR_TRY_STATUS(check_status(status, server_));
      const auto boundary = multipart_boundary(content_type);
      if (!boundary)
        return fail(fmt::format("the server answers with \"{}\", not with DICOM objects", shown_text(content_type)),
                    place_of(server_), "check that this is the address of its DICOMweb service");
      reader.emplace(*boundary, sink);
      return {};
    };
    request.on_content = [&](std::string_view bytes) { return reader->push(bytes); };
    TROCAR_TRY_STATUS(http_get(server_, request));
    if (!reader) return fail("the server sent no objects", place_of(server_), "try again");
    if (auto status = reader->finish(); !status) return fail_at(place_of(server_), status.error());
    return {};
  }

 private:
  /// An array of JSON objects; empty if nothing was found.
  Result<config::Json> query(const std::string& path) {
    std::string text;
    int found = 0;
    HttpRequest request;
    request.path = server_.path + path;
    request.accept = "application/dicom+json";
    request.on_answer = [&](int status, const std::string&) -> Status {
      found = status;
      return status == kNoContent || status == kNotFound ? Status() : check_status(status, server_);
    };
    request.on_content = [&](std::string_view bytes) -> Status {
      if (text.size() + bytes.size() > kMaxJson)
        return fail("the server sent too long a list", place_of(server_), "ask for one study");
      text += bytes;
      return {};
    };
    TROCAR_TRY_STATUS(http_get(server_, request));
    if (found == kNoContent || (found == kNotFound && server_.path.empty())) return config::Json::array();
    if (found != kOk) return tl::unexpected(check_status(found, server_).error());
    auto json = config::parse_json(text, "its list");
    if (!json || !json->is_array())
      return fail("the server does not answer with a list in DICOM's JSON", place_of(server_),
                  "check that this is the address of its DICOMweb service");
    return json;
  }

  DicomWebOptions server_;
};

}  // namespace

Result<DicomWebOptions> parse_dicomweb_url(const std::string& url) {
  const auto wrong = [&](const char* advice) {
    return fail_usage("the address of the DICOMweb service cannot be used", "--dicomweb", advice);
  };
  constexpr const char* kForm = "write http(s)://HOST:PORT/PATH, for example https://pacs.example/dicom-web";
  DicomWebOptions server;
  server.is_secure = url.starts_with("https://");
  if (!server.is_secure && !url.starts_with("http://")) return wrong(kForm);
  const std::string_view rest = std::string_view(url).substr(server.is_secure ? 8 : 7);
  const bool is_printable = std::ranges::all_of(rest, [](char c) { return c > ' ' && c < 0x7f && c != '"'; });
  if (!is_printable || rest.find_first_of("?#") != std::string_view::npos) return wrong(kForm);
  const std::string_view authority = rest.substr(0, rest.find('/'));
  if (authority.find('@') != std::string_view::npos)
    return wrong("give the user with --user and the password as the help describes");
  server.path = rest.substr(authority.size());
  while (server.path.ends_with('/')) server.path.pop_back();
  const std::size_t colon = authority.rfind(':');
  const bool has_port = colon != std::string_view::npos && authority.find(']', colon) == std::string_view::npos;
  server.host = authority.substr(0, has_port ? colon : authority.size());
  if (server.host.starts_with('[') && server.host.ends_with(']'))  // IPv6
    server.host = server.host.substr(1, server.host.size() - 2);
  const auto port =
      has_port ? parse_number<int>(authority.substr(colon + 1)) : std::optional(server.is_secure ? 443 : 80);
  if (server.host.empty() || !port || *port < 1 || *port > 65535) return wrong(kForm);
  server.port = *port;
  return server;
}

std::unique_ptr<PacsSource> make_dicomweb_source(DicomWebOptions options) {
  return std::make_unique<DicomWebSource>(std::move(options));
}

}  // namespace trocar::dicom
