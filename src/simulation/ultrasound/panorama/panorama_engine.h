#pragma once

#include <memory>

#include "ultrasound/engine/echo_engine.h"
#include "ultrasound/panorama/panorama.h"
#include "ultrasound/tissue/acoustic_scene.h"

namespace trocar::ultrasound {

/// Ultrasound from a panorama (docs/physics.md U17): an oblique slice of the panorama, as thick as the beam, with
/// shadows behind bone and gas of the acoustic scene, and with needles as in BMode. Where the panorama's weight falls
/// to 0, and on scanlines without contact, the frame fades to that of BMode, which computes only the scanlines that
/// need it. Without coverage the frame is that of BMode, bit by bit.
/// The echoes of the panorama are the same on all steering angles. Tissue that a needle displaces
/// is not moved in the panorama.
class PanoramaEngine final : public EchoEngine {
 public:
  PanoramaEngine(std::shared_ptr<const AcousticScene> scene, std::shared_ptr<const Panorama> panorama,
                 Transducer transducer, const Acquisition& acquisition);
  ~PanoramaEngine() override;
  PanoramaEngine(PanoramaEngine&&) noexcept;
  PanoramaEngine& operator=(PanoramaEngine&&) noexcept;

  void set_acquisition(const Acquisition& acquisition) override;
  const Acquisition& acquisition() const noexcept override;
  const ScanGeometry& geometry() const noexcept override;
  const BasebandFrame& render(const BModeInput& input) noexcept override;
  /// The gain without attenuation in soft tissue except that by which the scanner's TGC calculates; no mirrors.
  SoundPath sound_path(int line) const override;

  /// Share of the last frame's area that comes from the panorama, 0..1.
  double panorama_share() const noexcept;
  /// Scanlines of the last frame that BMode computed.
  int ray_cast_lines() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::ultrasound
