#pragma once

#include <functional>
#include <string>
#include <string_view>

#include "core/result.h"
#include "dicom/pacs/dicomweb_source.h"

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

}  // namespace trocar::dicom::detail
