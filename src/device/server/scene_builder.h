#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>

#include "anatomy/patient.h"
#include "core/progress.h"
#include "core/result.h"
#include "link/messages.h"
#include "server/servo.h"
#include "stylus/device_preset.h"

namespace trocar::server {

/// Opens a patient folder or makes an embedded patient. A module above `server` reads the files, so that the tests of
/// this module need no files.
using PatientOpener = std::function<Result<std::shared_ptr<const anatomy::VirtualPatient>>(
    const std::string& patient, std::uint64_t seed, const Progress& progress)>;

/// Makes scenes for the servo. Only the control thread uses it. Keeps the patient of the last scene.
class SceneBuilder {
 public:
  SceneBuilder(PatientOpener open_patient, std::filesystem::path tissues_file, stylus::DevicePreset device);

  /// Builds a new scene. Errors: invalid patient, tissues, needle or options, not enough memory, or a requested stop
  /// (checked between the steps: tables, patient, scene). After an error the last scene is kept.
  Result<ServoScene> load(const link::LoadScene& request, const Progress& progress = {},
                          const std::stop_token& stop = {});
  /// Builds the last scene with other parameters. All changes of the request are applied, or none. Tissue settings
  /// replace those of earlier requests: a setting that is not in the list gets its loaded value again, so that an
  /// undone change or a lost message has no effect. A request without tissues keeps the earlier settings. A tissue
  /// table in the request replaces the loaded one first. Errors: no scene yet, an unknown name, a number out of range.
  Result<ServoScene> change(const link::SetParameters& request);

  const link::LoadScene& request() const noexcept { return request_; }
  /// Tissue table of the last scene.
  const anatomy::TissueTable& tissues() const noexcept { return parts_.tissues; }
  const anatomy::VirtualPatient* patient() const noexcept { return patient_.get(); }

 private:
  struct Parts {
    anatomy::TissueTable loaded;   ///< Loaded table.
    anatomy::TissueTable tissues;  ///< Loaded table with the changed settings.
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
  stylus::DevicePreset device_;
  link::LoadScene request_;
  Parts parts_;
  std::shared_ptr<const anatomy::VirtualPatient> patient_;
  std::uint64_t number_ = 0;
};

}  // namespace trocar::server
