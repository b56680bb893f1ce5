#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"
#include "haptics/coupling/device_preset.h"
#include "link/messages.h"
#include "server/servo.h"

namespace trocar::server {

/// Opens a patient folder or makes an embedded patient. Files are above this module, so that its tests need none.
using PatientOpener = std::function<Result<std::shared_ptr<const anatomy::VirtualPatient>>(
    const std::string& patient, std::uint64_t seed, const Progress& progress)>;

/// Makes scenes for the servo. By the control thread alone; keeps the patient of the last scene.
class SceneBuilder {
 public:
  SceneBuilder(PatientOpener open_patient, std::filesystem::path tissues_file, haptics::DevicePreset device);

  /// Everything anew. Errors: what is wrong with patient, tissues, needle or options, not enough memory, a stop that
  /// was requested (looked at between the steps: tables, patient, scene); the last scene stays.
  Result<ServoScene> load(const link::LoadScene& request, const Progress& progress = {},
                          const std::stop_token& stop = {});
  /// The last scene with other numbers: all of the request or none. Numbers of tissues replace those of earlier
  /// changes: a number that is not named has its loaded value again, so that a change that was undone or a message that
  /// was lost leaves nothing behind; a request without tissues leaves them. A tissue table in the request replaces the
  /// loaded one first. Errors: no scene yet, an unknown name, a number out of range.
  Result<ServoScene> change(const link::SetParameters& request);

  const link::LoadScene& request() const noexcept { return request_; }
  /// In force with the last scene.
  const anatomy::TissueTable& tissues() const noexcept { return parts_.tissues; }
  const anatomy::VirtualPatient* patient() const noexcept { return patient_.get(); }

 private:
  struct Parts {
    anatomy::TissueTable loaded;   ///< As the client gave it,
    anatomy::TissueTable tissues;  ///< and with changed numbers.
    haptics::HapticOptions options;
  };
  Result<ServoScene> load_throwing(const link::LoadScene& request, const Progress& progress,
                                   const std::stop_token& stop);
  Result<ServoScene> change_throwing(const link::SetParameters& request);
  Result<std::shared_ptr<const anatomy::VirtualPatient>> patient_for(const link::LoadScene& request,
                                                                     const Progress& progress);
  Result<Parts> parts_for(const link::LoadScene& request) const;
  Result<ServoScene> build(const link::LoadScene& request, std::shared_ptr<const anatomy::VirtualPatient> patient,
                           Parts parts, bool continues);

  PatientOpener open_patient_;
  std::filesystem::path tissues_file_;
  haptics::DevicePreset device_;
  link::LoadScene request_;
  Parts parts_;
  std::shared_ptr<const anatomy::VirtualPatient> patient_;
  std::uint64_t number_ = 0;
};

}  // namespace trocar::server
