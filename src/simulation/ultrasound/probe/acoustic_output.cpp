#include "ultrasound/probe/acoustic_output.h"

#include <cmath>
#include <string>

#include "config/sourced_number.h"
#include "ultrasound/probe/transducer.h"

namespace trocar::ultrasound {

AcousticIndices acoustic_indices(const AcousticOutput& output, double frequency_mhz, double focus_mm) noexcept {
  constexpr double kCmPerMm = 0.1;
  const double loss_db = kDerating_db_per_cm_mhz * frequency_mhz * focus_mm * kCmPerMm;
  const double pressure_mpa = output.pressure_mpa * std::pow(10.0, -loss_db / 20.0);
  AcousticIndices indices{pressure_mpa / std::sqrt(frequency_mhz),
                          output.power_mw * frequency_mhz / kThermalPower_mw_mhz};
  if (indices.mechanical > kMostMechanicalIndex) {
    const double lowered = kMostMechanicalIndex / indices.mechanical;
    indices.mechanical = kMostMechanicalIndex;
    indices.thermal *= lowered * lowered;
  }
  return indices;
}

Result<AcousticOutput> load_acoustic_output(const std::filesystem::path& path, std::string_view transducer) {
  // Checks the whole table, and reports an unknown name with the known ones.
  TROCAR_TRY_STATUS(load_transducer(path, transducer));
  TROCAR_TRY(const config::TomlTable document, config::load_toml(path));
  TROCAR_TRY(const config::TomlTable rows, document.table("transducers"));
  TROCAR_TRY(const config::TomlTable row, rows.table(std::string(transducer)));
  TROCAR_TRY(const config::SourcedNumber pressure, config::read_sourced_number(row, "pressure_mpa", {0.1, 10.0}));
  TROCAR_TRY(const config::SourcedNumber power, config::read_sourced_number(row, "power_mw", {0.1, 1000.0}));
  return AcousticOutput{pressure.value, power.value};
}

}  // namespace trocar::ultrasound
