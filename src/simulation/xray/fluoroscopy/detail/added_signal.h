#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "xray/fluoroscopy/detail/patient_image.h"

namespace trocar::xray::detail {

/// Tools and contrast agent in front of the patient's image: only pixels with their masses are computed anew.
class AddedSignal {
 public:
  /// The patient's primary signal with the request's tools and contrast agent.
  void apply(const FluoroscopyRequest& request, const PatientImage& patient, std::vector<float>& signal);

 private:
  void update_iodine(const FluoroscopyRequest& request, const PatientImage& patient);

  std::shared_ptr<const Iodine> iodine_;  ///< Of iodine_g_per_cm2_.
  std::optional<CArm> arm_;
  motion::PatientMotion motion_;
  std::vector<float> iodine_g_per_cm2_;  ///< Empty without contrast agent.
  std::vector<float> integrals_;         ///< Of one grid.
  MassImage added_;
  MassImage few_;  ///< Masses of the changed pixels, in one row.
  std::vector<std::uint8_t> is_changed_;
  std::vector<std::size_t> places_;
  std::vector<float> few_signal_;
};

}  // namespace trocar::xray::detail
