#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "xray/detector/scatter.h"
#include "xray/fluoroscopy/fluoroscope.h"
#include "xray/projection/xray_volume.h"

namespace trocar::xray::detail {

/// The part of an image that stays the same while C-arm, body and exposure do: primary signal and scatter of the
/// patient without tools and contrast agent.
class PatientImage {
 public:
  PatientImage(std::shared_ptr<const XrayVolume> volume, const DetectorParams& params)
      : volume_(std::move(volume)), params_(params), beams_(params.scintillator_mm) {}

  /// Brings all up to date for a request. Errors: the C-arm's or the
  /// spectrum's.
  Status update(const FluoroscopyRequest& request, const ExposureLimits& limits);

  const MassImage& masses() const noexcept { return masses_; }
  const std::vector<float>& primary() const noexcept { return primary_; }  ///< 0 behind the shutters.
  const Scatter& scatter() const noexcept { return scatter_; }
  const Exposure& exposure() const noexcept { return exposure_; }
  const Beam& beam() const noexcept { return *beam_; }
  const XrayRays& rays() const noexcept { return rays_; }

 private:
  struct Key {
    CArm arm;
    motion::PatientMotion motion;
  };
  struct ExposureKey {
    std::array<double, 2> collimation;
    Tube filters;
    DoseMode mode;
    double pulses_per_s;
    bool operator==(const ExposureKey&) const = default;
  };
  void expose(const FluoroscopyRequest& request);

  std::shared_ptr<const XrayVolume> volume_;  ///< At rest.
  std::shared_ptr<const XrayVolume> now_;     ///< Where the last image shows it.
  DetectorParams params_;
  BeamCache beams_;
  std::optional<Key> key_;
  std::optional<ExposureKey> exposure_key_;
  XrayRays rays_;
  MassImage masses_;
  std::vector<float> primary_;
  Scatter scatter_;
  Exposure exposure_;
  std::optional<Beam> beam_;
};

/// True if both C-arms have the same rays.
bool has_same_rays(const CArm& a, const CArm& b) noexcept;

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
