#pragma once

#include <memory>
#include <string>

#include "dicom/pacs/pacs_source.h"

namespace trocar::dicom {

/// A PACS that speaks DICOMweb (PS3.18).
struct DicomWebOptions {
  bool is_secure = false;  ///< https; certificates are checked against those of the system.
  std::string host;
  int port = 80;
  std::string path;      ///< "/dicom-web", without a slash at the end; may be empty.
  std::string user;      ///< Basic authentication; empty: none.
  std::string password;  ///< Belongs to `user`.
  int timeout_s = 30;    ///< Longest time without data.
};

/// Parses "https://HOST[:PORT]/PATH" into the first four fields. Errors (exit status 2): another form; a user or a
/// password in the address.
Result<DicomWebOptions> parse_dicomweb_url(const std::string& url);

/// QIDO-RS lists; WADO-RS retrieves a series as one multipart answer, whose objects pass on while they arrive.
std::unique_ptr<PacsSource> make_dicomweb_source(DicomWebOptions options);

}  // namespace trocar::dicom
