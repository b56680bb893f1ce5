#include "ultrasound/engine/echo_engine.h"

#include <algorithm>

namespace trocar::ultrasound {

Acquisition default_acquisition(const Transducer& transducer) {
  Acquisition acquisition;
  acquisition.depth_mm = transducer.depth_mm;
  acquisition.frequency_mhz = transducer.frequency_mhz;
  acquisition.focus_mm = transducer.focus_mm;
  acquisition.lines = transducer.scanlines;
  return acquisition;
}

double coupled_share(const BasebandFrame& frame) noexcept {
  constexpr float kMost = 0.5F;
  const auto coupled =
      std::count_if(frame.contact.begin(), frame.contact.end(), [](float part) { return part > kMost; });
  return static_cast<double>(coupled) / static_cast<double>(frame.contact.size());
}

}  // namespace trocar::ultrasound
