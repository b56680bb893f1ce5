#include "web/transport/tls_context.h"

#include <openssl/err.h>
#include <openssl/ssl.h>
#include <openssl/x509v3.h>

#include "core/files/input_file.h"

namespace trocar::web {
namespace {

/// TLS 1.2: forward secrecy and authenticated encryption; TLS 1.3 has nothing else.
constexpr const char* kCiphers = "ECDHE+AESGCM:ECDHE+CHACHA20";

constexpr FileLimit kPem{FileKind::kOther, "PEM file", std::uint64_t{1} << 20};

}  // namespace

Result<TlsContext> TlsContext::load(const TlsFiles& files) {
  std::error_code error;
  TROCAR_TRY_STATUS(InputFile::open(files.certificate, kPem));
  TROCAR_TRY_STATUS(InputFile::open(files.key, kPem));
  if ((std::filesystem::status(files.key, error).permissions() & std::filesystem::perms::others_all) !=
      std::filesystem::perms::none)
    return fail("every user of this machine may read the key", files.key.string(), "chmod o-rwx it, or make a new key");
  const std::shared_ptr<SSL_CTX> context(SSL_CTX_new(TLS_server_method()), SSL_CTX_free);
  if (!context || SSL_CTX_set_min_proto_version(context.get(), TLS1_2_VERSION) != 1 ||
      SSL_CTX_set_cipher_list(context.get(), kCiphers) != 1)
    return fail("TLS cannot be used", "OpenSSL", "reinstall OpenSSL");
  SSL_CTX_set_options(context.get(), SSL_OP_NO_COMPRESSION | SSL_OP_NO_RENEGOTIATION | SSL_OP_CIPHER_SERVER_PREFERENCE);
  SSL_CTX_set_mode(context.get(), SSL_MODE_ENABLE_PARTIAL_WRITE | SSL_MODE_ACCEPT_MOVING_WRITE_BUFFER);
  ERR_clear_error();
  if (SSL_CTX_use_certificate_chain_file(context.get(), files.certificate.c_str()) != 1)
    return fail("not a certificate in PEM", files.certificate.string(),
                "give the file that begins with -----BEGIN CERTIFICATE-----");
  // An encrypted key would ask on the terminal of a server that may have none.
  SSL_CTX_set_default_passwd_cb(context.get(), [](char*, int, int, void*) { return -1; });
  if (SSL_CTX_use_PrivateKey_file(context.get(), files.key.c_str(), SSL_FILETYPE_PEM) != 1) {
    const bool is_other = ERR_GET_REASON(ERR_peek_last_error()) == X509_R_KEY_VALUES_MISMATCH;
    ERR_clear_error();
    if (is_other)
      return fail("the key does not belong to the certificate", files.key.string(),
                  "give the key of " + files.certificate.string());
    return fail("not a private key in PEM without a password", files.key.string(),
                "give the file that begins with -----BEGIN PRIVATE KEY-----");
  }
  const X509* const certificate = SSL_CTX_get0_certificate(context.get());
  if (X509_cmp_current_time(X509_get0_notAfter(certificate)) < 0)
    return fail("the certificate has expired", files.certificate.string(), "renew it");
  return TlsContext(context);
}

bool TlsContext::names(const std::string& host) const {
  X509* const certificate = SSL_CTX_get0_certificate(context_.get());
  return X509_check_ip_asc(certificate, host.c_str(), 0) == 1 ||
         X509_check_host(certificate, host.data(), host.size(), 0, nullptr) == 1;
}

}  // namespace trocar::web
