// trocar serve: the instructor's page and its accounts.
#include <fmt/format.h>

#include <chrono>
#include <thread>

#include "cli/commands.h"
#include "cli/results/serve_accounts.h"
#include "core/interruption.h"
#include "core/log.h"
#include "database/database_url.h"
#include "results/repository.h"
#include "web/security/request_guards.h"
#include "web/service.h"
#include "web/transport/http_server.h"

namespace trocar::cli {
namespace {

struct ServeArguments {
  std::string database, listen = "127.0.0.1:8080", certificate, key;
  std::vector<std::string> names;
  bool is_behind_proxy = false;
};

Result<std::optional<web::TlsContext>> load_tls(const ServeArguments& arguments) {
  if (arguments.certificate.empty() != arguments.key.empty())
    return fail_usage("TLS needs a certificate and its key", arguments.key.empty() ? "--key" : "--certificate",
                      "give both, or none");
  if (arguments.certificate.empty()) return std::optional<web::TlsContext>();
  TROCAR_TRY(web::TlsContext tls, web::TlsContext::load({arguments.certificate, arguments.key}));
  return std::optional(std::move(tls));
}

/// Passwords must not cross a network in the clear.
Status check_exposure(const ServeArguments& arguments, const web::ListenAddress& listen, bool has_tls) {
  if (listen.is_loopback() || has_tls || arguments.is_behind_proxy) return {};
  return fail_usage("other machines would send passwords without encryption", "--listen " + arguments.listen,
                    "give --certificate and --key, or --behind-proxy if a proxy in front of this server uses TLS");
}

/// Names of this server beside those of its loopback.
std::function<bool(const std::string&)> served_names(const ServeArguments& arguments, const web::ListenAddress& listen,
                                                     const std::optional<web::TlsContext>& tls) {
  return
      [names = arguments.names, host = listen.is_any() ? std::string() : listen.host, tls](const std::string& asked) {
        for (const std::string& name : names)
          if (web::is_same_name(name, asked)) return true;
        return (!host.empty() && asked == host) || (tls && tls->names(asked));
      };
}

Status serve(const ServeArguments& arguments) {
  TROCAR_TRY(const database::DatabaseUrl database, database_of(arguments.database));
  TROCAR_TRY(const web::ListenAddress listen, web::parse_listen_address(arguments.listen));
  TROCAR_TRY(const std::optional<web::TlsContext> tls, load_tls(arguments));
  TROCAR_TRY_STATUS(check_exposure(arguments, listen, tls.has_value()));
  web::ServiceOptions options;
  options.database = database;
  TROCAR_TRY(options.page_folder, find_data("web"));
  options.data_folder = options.page_folder.parent_path();
  options.is_secure = tls || arguments.is_behind_proxy;
  options.is_behind_proxy = arguments.is_behind_proxy;
  options.is_loopback = listen.is_loopback() || listen.is_any();
  options.is_served = served_names(arguments, listen, tls);
  const bool is_secure = options.is_secure;
  TROCAR_TRY(web::Service service, web::Service::open(std::move(options)));

  const InterruptibleWork work;
  set_log_level(LogLevel::kInfo);
  web::ServerOptions server_options;
  server_options.listen = listen;
  server_options.tls = tls;
  server_options.default_headers = web::security_headers(is_secure);
  if (arguments.is_behind_proxy) server_options.connections_per_address = server_options.threads;
  TROCAR_TRY(web::HttpServer server,
             web::HttpServer::start(std::move(server_options),
                                    [&](const web::HttpRequest& request) { return service.answer(request); }));
  fmt::print("{}\n", server.url());
  std::fflush(stdout);
  log_info("results: {}", database.shown());
  if (listen.is_any())
    log_info("listens on every address of this machine; browsers have to use a name of the certificate or of --name");
  if (const std::string note = service.database_note(); !note.empty()) log_warning("{}", note);
  TROCAR_TRY(const std::size_t accounts, service.count_accounts());
  if (accounts == 0) log_warning("there is no account yet: run \"trocar serve account add NAME --role admin\"");
  while (!is_interrupted()) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  server.stop();
  log_info("stopped");
  return {};
}

}  // namespace

void add_serve_command(Command& program, Action& action) {
  Command command = program.add_command("serve", "Serve the instructor's page and the web questionnaire");
  const auto a = std::make_shared<ServeArguments>();
  command.add_option("--db", a->database, kDatabaseHelp);
  command.add_option("--listen", a->listen, "Address and port, HOST:PORT").show_default();
  command.add_option("--certificate", a->certificate, "Certificate for TLS, with its chain (PEM)");
  command.add_option("--key", a->key, "Its private key (PEM, without a password)");
  command.add_option("--name", a->names, "A name of this server in its address, beside those of the certificate")
      .one_value_each();
  command.add_flag("--behind-proxy", a->is_behind_proxy,
                   "A proxy in front uses TLS, passes Host and adds X-Forwarded-For");
  command.footer(
      "The page is at the printed address. Ctrl+C ends the server after its running requests.\n"
      "Examples:\n"
      "  trocar serve account add \"Dr. Weber\" --role admin\n"
      "  trocar serve\n"
      "  trocar serve --db postgresql://trocar@db/results --listen 0.0.0.0:8443 --certificate server.pem --key "
      "server.key\n");
  command.when_parsed([&action, a, command] {
    if (!command.has_given_command()) action = [a] { return serve(*a); };
  });
  add_serve_account_commands(command, action);
}

}  // namespace trocar::cli
