// trocar link keygen.
#include <fmt/format.h>

#include "cli/commands.h"
#include "config/json.h"
#include "link/endpoint.h"

namespace trocar::cli {
namespace {

struct KeygenArguments {
  std::filesystem::path out;
  bool is_json = false;
};

Status make_keys(const KeygenArguments& arguments) {
  TROCAR_TRY_STATUS(check_new(arguments.out));
  TROCAR_TRY_STATUS(link::write_key_folder(arguments.out));
  const auto name = [&](const char* file) { return (arguments.out / file).string(); };
  if (arguments.is_json) {
    print_json({{"server", {{"key", name("server.key")}, {"public_key", name("server.pub")}}},
                {"client", {{"key", name("client.key")}, {"public_key", name("client.pub")}}},
                {"allowed", name("allowed")}});
    return {};
  }
  fmt::print("{}\n  the server keeps server.key and allowed; clients need client.key and server.pub\n",
             arguments.out.string());
  return {};
}

}  // namespace

void add_link_commands(Command& program, Action& action) {
  Command link = program.add_command("link", "Connections to haptic servers on other machines");
  link.require_command();
  link.footer("Example:\n  trocar link keygen --out keys\n");
  Command keygen = link.add_command(
      "keygen", "Create CURVE keys for a server and a client (without keys, a server accepts local connections only)");
  keygen.footer(
      "Example:\n  trocar link keygen --out keys\n"
      "  trocar-hapticd --endpoint tcp://0.0.0.0:5571 --keys keys/server.key --allow keys/allowed\n");
  const auto arguments = std::make_shared<KeygenArguments>();
  keygen.add_option("--out", arguments->out, "New folder for the keys, accessible only to you").required();
  keygen.add_flag("--json", arguments->is_json, "Print one JSON object");
  keygen.when_parsed([&action, arguments] { action = [arguments] { return make_keys(*arguments); }; });
}

}  // namespace trocar::cli
