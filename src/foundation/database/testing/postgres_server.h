#pragma once

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "core/files/folders.h"
#include "core/testing/source_dir.h"
#include "database/database.h"

namespace trocar::database::testing {

/// A PostgreSQL server on the loopback interface as processes of its own, with its data in a temporary folder. It asks
/// for a password. The destructor ends it. A test program that runs as root starts it as the user "nobody".
class PostgresServer {
 public:
  static constexpr const char* kUser = "trocar";
  static constexpr const char* kPassword = "only-for-tests";

  /// Folder of initdb and postgres; empty: not installed.
  static std::filesystem::path programs() {
    std::error_code error;
    std::filesystem::path found;
    for (const auto& version : std::filesystem::directory_iterator("/usr/lib/postgresql", error))
      if (std::filesystem::exists(version.path() / "bin/initdb") && version.path() / "bin" > found)
        found = version.path() / "bin";
    return found;
  }

  PostgresServer() : port_(free_port()) {
    std::ofstream(folder_ / "password") << kPassword;
    std::filesystem::permissions(folder_.path(), std::filesystem::perms::owner_all);
    if (::geteuid() == 0) {
      give_away(folder_.path());
      give_away(folder_ / "password");
    }
    const std::string data = (folder_ / "data").string();
    const int made =
        wait_for(start({(programs() / "initdb").string(), "-D", data, "-U", kUser, "-A", "scram-sha-256",
                        "--pwfile=" + (folder_ / "password").string(), "-E", "UTF8", "--locale=C", "--no-sync"}));
    if (made == 0) run();
  }
  ~PostgresServer() { stop(); }
  PostgresServer(const PostgresServer&) = delete;
  PostgresServer& operator=(const PostgresServer&) = delete;

  bool is_running() const noexcept { return process_ > 0; }
  /// Starts the server again after stop().
  void run() {
    process_ =
        start({(programs() / "postgres").string(), "-D", (folder_ / "data").string(), "-p", std::to_string(port_), "-c",
               "listen_addresses=127.0.0.1", "-c", "unix_socket_directories=", "-c", "fsync=off"});
    constexpr int kTries = 300, kPoll_ms = 50;
    for (int n = 0; n < kTries && !Database::open({{}, url("postgres")}, Missing::kRefuse); ++n) {
      if (::waitpid(process_, nullptr, WNOHANG) != 0) {
        process_ = 0;
        return;
      }
      ::poll(nullptr, 0, kPoll_ms);
    }
  }
  /// Ends all connections at once.
  void stop() {
    if (process_ > 0) {
      ::kill(process_, SIGINT);
      ::waitpid(process_, nullptr, 0);
    }
    process_ = 0;
  }

  std::string url(const std::string& database, const std::string& password = kPassword,
                  const std::string& user = kUser) const {
    return fmt::format("postgresql://{}:{}@127.0.0.1:{}/{}", user, password, port_, database);
  }
  /// URLs of a database (a new one, or one that is there) for the roles of packaging/postgresql_roles.sql.
  struct Roles {
    DatabaseUrl owner, writer;
  };
  Result<Roles> make_database_with_roles() { return give_roles(make_database()); }
  Result<Roles> give_roles(const DatabaseUrl& made) {
    const std::string name = made.server.substr(made.server.rfind('/') + 1);
    TROCAR_TRY(auto administrator, Database::open(made, Missing::kRefuse));
    TROCAR_TRY_STATUS(administrator.run("the roles cannot be made", [&](soci::session& session) {
      for (const std::string& statement :
           statements_of(trocar::testing::source_dir() / "packaging/postgresql_roles.sql"))
        session << statement;
      for (const char* role : {"trocar_owner", "trocar_writer"})
        session << fmt::format("ALTER ROLE {} PASSWORD '{}'", role, kPassword);
    }));
    return Roles{{{}, url(name, kPassword, "trocar_owner")}, {{}, url(name, kPassword, "trocar_writer")}};
  }
  /// URL of a new, empty database.
  DatabaseUrl make_database() {
    const std::string name = fmt::format("test{}", ++databases_);
    auto administrator = Database::open({{}, url("postgres")}, Missing::kRefuse);
    if (administrator)
      static_cast<void>(administrator->run("x", [&](soci::session& session) { session << "CREATE DATABASE " + name; }));
    return {{}, url(name)};
  }

 private:
  static constexpr uid_t kNobody = 65534;

  /// The statements of a file, without comments; each ends with a line.
  static std::vector<std::string> statements_of(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::vector<std::string> statements;
    std::string statement;
    bool is_in_body = false;
    for (std::string line; std::getline(file, line);) {
      if (line.find_first_not_of(' ') == std::string::npos || line.find("--") == line.find_first_not_of(' ')) continue;
      statement += line + "\n";
      if (line.find("$$") != std::string::npos) is_in_body = !is_in_body;
      if (!line.ends_with(';') || is_in_body) continue;
      statements.push_back(std::exchange(statement, {}));
    }
    return statements;
  }
  static void give_away(const std::filesystem::path& path) {
    if (::chown(path.c_str(), kNobody, kNobody) != 0) std::abort();
  }
  static int free_port() {
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    ::bind(socket, reinterpret_cast<sockaddr*>(&address), size);
    ::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size);
    ::close(socket);
    return ntohs(address.sin_port);
  }
  pid_t start(const std::vector<std::string>& command) const {
    const pid_t process = ::fork();
    if (process != 0) return process;
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // must not outlive a test that crashes
    const int log = ::open((folder_ / "log").c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666);
    ::dup2(log, STDOUT_FILENO);
    ::dup2(log, STDERR_FILENO);
    if (::geteuid() == 0 && (::setgid(kNobody) != 0 || ::setuid(kNobody) != 0 || ::chdir("/") != 0)) ::_exit(126);
    std::vector<char*> arguments;
    for (const std::string& argument : command) arguments.push_back(const_cast<char*>(argument.c_str()));
    arguments.push_back(nullptr);
    ::execv(arguments.front(), arguments.data());
    ::_exit(127);
  }
  static int wait_for(pid_t process) {
    int status = 0;
    ::waitpid(process, &status, 0);
    return status;
  }

  TemporaryFolder folder_;
  int port_ = 0, databases_ = 0;
  pid_t process_ = 0;
};

}  // namespace trocar::database::testing
