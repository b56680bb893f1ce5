#pragma once

#include "web/message.h"

namespace trocar::web {

/// Headers of every answer: what a browser may load for the page (scripts, styles, images and data of this server
/// alone; no frame around it), types are not guessed, no address leaks in a Referer, nothing is stored. `is_secure`:
/// the browser uses TLS, and has to for the next year.
TextPairs security_headers(bool is_secure);

}  // namespace trocar::web
