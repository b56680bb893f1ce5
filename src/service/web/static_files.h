#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "core/result.h"
#include "web/message.h"

namespace trocar::web {

/// The files of the page, read once into memory: no path of a request reaches the file system.
class StaticFiles {
 public:
  /// Reads a folder and its subfolders. Errors: no index.html, a file above 8 MiB, a file of an unknown type.
  static Result<StaticFiles> load(const std::filesystem::path& folder);

  /// The file of a path; index.html for a path whose last part has no ending, so that the page's own addresses work.
  /// With If-None-Match of the same content 304. Files in /assets/ have their digest in their name and never change.
  HttpAnswer answer(const HttpRequest& request) const;

 private:
  struct File {
    std::string content_type, etag;
    std::shared_ptr<const std::string> bytes;
  };
  std::map<std::string, File, std::less<>> files_;  ///< By path: "/assets/index.js".
};

}  // namespace trocar::web
