#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "core/result.h"
#include "dicom/pacs/dicomweb_source.h"
#include "dicom/pacs/pacs_source.h"

namespace trocar::dicom::detail {

/// Address of the service, for messages.
std::string place_of(const DicomWebOptions& server);

struct HttpRequest {
  std::string path;    ///< Encoded, with the path of the service.
  std::string accept;  ///< Media type.
  /// Called with status and content type before the content; an error ends the request.
  std::function<Status(int status, const std::string& content_type)> on_answer;
  std::function<Status(std::string_view)> on_content;
  std::function<bool()> is_cancelled;
};

/// GET. The content passes on in small parts, unpacked (gzip) and without chunk marks; memory does not grow with it.
/// Errors: no connection, certificate refused, closed early, no data for the time limit, endless header, those of the
/// callbacks. A redirection is not followed: the password belongs to this server.
Status http_get(const DicomWebOptions& server, const HttpRequest& request);

/// The boundary of a content type "multipart/related; boundary=…"; empty: another type, or a boundary that RFC 2046
/// does not allow.
std::optional<std::string> multipart_boundary(std::string_view content_type);

/// Splits a multipart content (RFC 2046, 5.1) while it arrives, and passes each part to the sink as one DICOM file.
class MultipartReader {
 public:
  MultipartReader(const std::string& boundary, ObjectSink& sink);

  /// The next bytes of the content. Errors: those of the sink; an endless header.
  Status push(std::string_view bytes);
  /// After the last byte. Error: the end is missing.
  Status finish() const;

 private:
  enum class State { kBefore, kAfterBoundary, kHeader, kPart, kDone };

  Result<bool> step();
  Status pass_on(std::size_t size);

  ObjectSink& sink_;
  std::string delimiter_;  ///< Line end, two dashes and the boundary.
  std::string buffer_;     ///< Not yet passed on: at most one delimiter or header, and the bytes pushed last.
  State state_ = State::kBefore;
};

}  // namespace trocar::dicom::detail
