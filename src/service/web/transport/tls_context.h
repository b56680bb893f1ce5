#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "core/result.h"

struct ssl_ctx_st;

namespace trocar::web {

struct TlsFiles {
  std::filesystem::path certificate;  ///< PEM: the server's certificate, then those between it and the root.
  std::filesystem::path key;          ///< PEM, not encrypted.
};

/// The server's side of TLS 1.2 and 1.3, with forward secrecy and authenticated encryption only.
class TlsContext {
 public:
  /// Errors: a file is missing or is no PEM file, the key is another one, other users may read the key, the
  /// certificate has expired.
  static Result<TlsContext> load(const TlsFiles& files);

  /// Whether the certificate names this host (subjectAltName, wildcards too); `host` is a name or a number.
  bool names(const std::string& host) const;

  ssl_ctx_st* get() const noexcept { return context_.get(); }

 private:
  explicit TlsContext(std::shared_ptr<ssl_ctx_st> context) : context_(std::move(context)) {}
  std::shared_ptr<ssl_ctx_st> context_;
};

}  // namespace trocar::web
