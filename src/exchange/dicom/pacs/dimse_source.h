#pragma once

#include <memory>
#include <string>

#include "dicom/pacs/pacs_source.h"

namespace trocar::dicom {

/// A PACS that speaks DICOM's own protocol (PS3.8), and ourselves as it has to know us.
struct DimseOptions {
  std::string host;
  int port = 104;
  std::string called_title;              ///< AE title of the PACS.
  std::string calling_title = "TROCAR";  ///< Our AE title.
  int listen_port = 11112;               ///< Where the PACS sends objects to with C-MOVE. Source: IANA, port "dicom".
  bool uses_get = false;                 ///< C-GET in place of C-MOVE: objects come over our own connection.
  int timeout_s = 30;                    ///< Longest time without data.
};

/// Parses "AET@HOST:PORT" into the first three fields. Errors (exit status 2): another form, an AE title of more than
/// 16 characters (PS3.5, 6.2), a port outside 1 to 65535.
Result<DimseOptions> parse_pacs_address(const std::string& text);
/// Error (exit status 2): not 1 to 16 printable ASCII characters.
Status check_ae_title(const std::string& title, const std::string& option);

/// C-FIND lists; C-MOVE (default) or C-GET retrieves. DCMTK transfers the messages; what the PACS sends is parsed by
/// Trocar's own checked code.
std::unique_ptr<PacsSource> make_dimse_source(DimseOptions options);

}  // namespace trocar::dicom
