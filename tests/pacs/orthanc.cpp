#include "pacs/orthanc.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "pacs/sockets.h"

namespace trocar::pacs_test {
namespace {

constexpr const char* kProgram = "/usr/sbin/Orthanc";
constexpr const char* kPlugin = "/usr/share/orthanc/plugins/libOrthancDicomWeb.so";
constexpr int kStart_s = 60;
constexpr int kPoll_ms = 50;

}  // namespace

bool Orthanc::is_installed() {
  return std::filesystem::exists(kProgram) && std::filesystem::exists(kPlugin);
}

Orthanc::Orthanc(bool permits_all) : http_port_(free_port()), dicom_port_(free_port()), move_port_(free_port()) {
  const std::string file = (folder_ / "orthanc.json").string();
  std::ofstream(file) << fmt::format(
      R"({{"StorageDirectory": "{0}/db", "IndexDirectory": "{0}/db", "Plugins": ["{1}"], "HttpPort": {2},
"DicomPort": {3}, "DicomAet": "ORTHANC", "DicomCheckCalledAet": true, "DicomAlwaysAllowFind": {6},
"DicomAlwaysAllowMove": {6}, "DicomAlwaysAllowGet": {6}, "RemoteAccessAllowed": false, "AuthenticationEnabled": false,
"DicomModalities": {{"trocar": ["TROCAR", "127.0.0.1", {4}], "closed": ["CLOSED", "127.0.0.1", {5}]}},
"DicomWeb": {{"Enable": true, "Root": "/dicom-web/"}}}})",
      folder_.path().string(), kPlugin, http_port_, dicom_port_, move_port_, free_port(), permits_all);
  process_ = ::fork();
  if (process_ == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGTERM);  // must not outlive a test that crashes
    ::setenv("TCP_NODELAY", "1", 1);     // otherwise every message waits for the acknowledgement of the last one
    const int log = ::open((folder_ / "log").c_str(), O_WRONLY | O_CREAT, 0600);
    ::dup2(log, STDOUT_FILENO);
    ::dup2(log, STDERR_FILENO);
    ::execl(kProgram, kProgram, file.c_str(), nullptr);
    ::_exit(127);
  }
  for (int n = 0; !is_running_ && n < kStart_s * 1000 / kPoll_ms; ++n) {
    if (::waitpid(process_, nullptr, WNOHANG) != 0) return;
    is_running_ = http("GET /system HTTP/1.0\r\n\r\n").find(" 200 ") != std::string::npos;
    if (!is_running_) ::poll(nullptr, 0, kPoll_ms);
  }
}

Orthanc::~Orthanc() {
  ::kill(process_, SIGTERM);
  ::waitpid(process_, nullptr, 0);
}

std::string Orthanc::http(const std::string& request) const {
  const int socket = connect_to(http_port_);
  if (socket < 0) return {};
  std::string answer;
  send_all(socket, request);
  for (std::string byte; !(byte = receive_exactly(socket, 1)).empty();) answer += byte;
  ::close(socket);
  return answer;
}

bool Orthanc::store(const std::string& file) const {
  const std::string header = fmt::format("POST /instances HTTP/1.0\r\nContent-Length: {}\r\n\r\n", file.size());
  return http(header + file).find(" 200 ") != std::string::npos;
}

std::string Orthanc::pacs() const {
  return fmt::format("--pacs ORTHANC@127.0.0.1:{} --listen-port {}", dicom_port_, move_port_);
}

std::string Orthanc::dicomweb() const {
  return fmt::format("--dicomweb http://127.0.0.1:{}/dicom-web", http_port_);
}

}  // namespace trocar::pacs_test
