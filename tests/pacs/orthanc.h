#pragma once

#include <string>

#include "core/files/folders.h"

namespace trocar::pacs_test {

/// Orthanc, a PACS, as a process of its own on the loopback interface, with its data in a temporary folder. It knows
/// the AE title TROCAR with the port move_port(). The destructor ends it.
class Orthanc {
 public:
  static bool is_installed();

  /// `permits_all`: an AE title that it does not know may ask and retrieve.
  explicit Orthanc(bool permits_all = true);
  ~Orthanc();
  Orthanc(const Orthanc&) = delete;
  Orthanc& operator=(const Orthanc&) = delete;

  bool is_running() const { return is_running_; }
  /// Stores a DICOM file. False: refused.
  bool store(const std::string& file) const;

  std::string pacs() const;      ///< For --pacs.
  std::string dicomweb() const;  ///< For --dicomweb.
  int move_port() const { return move_port_; }

 private:
  std::string http(const std::string& request) const;

  TemporaryFolder folder_;
  int http_port_ = 0, dicom_port_ = 0, move_port_ = 0;
  int process_ = -1;
  bool is_running_ = false;
};

}  // namespace trocar::pacs_test
