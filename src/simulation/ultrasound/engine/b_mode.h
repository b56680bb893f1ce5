#pragma once

#include <memory>

#include "ultrasound/engine/echo_engine.h"
#include "ultrasound/tissue/acoustic_scene.h"

namespace trocar::ultrasound {

/// Ultrasound from an acoustic scene (docs/physics.md U1–U9). Buffers are allocated once; render() allocates nothing.
/// The result does not depend on the number of threads.
class BMode final : public EchoEngine {
 public:
  BMode(std::shared_ptr<const AcousticScene> scene, Transducer transducer, const Acquisition& acquisition);
  ~BMode() override;
  BMode(BMode&&) noexcept;
  BMode& operator=(BMode&&) noexcept;

  void set_acquisition(const Acquisition& acquisition) override;
  const Acquisition& acquisition() const noexcept override;
  const ScanGeometry& geometry() const noexcept override;
  const BasebandFrame& render(const BModeInput& input) noexcept override;
  SoundPath sound_path(int line) const override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace trocar::ultrasound
