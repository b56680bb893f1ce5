#pragma once

#include "xray/fluoroscopy/fluoroscope.h"

namespace trocar::trainer {

/// What a user sets at the fluoroscope. C-arm: angles, table (isocentre), field and collimation.
struct XraySettings {
  xray::CArm arm;
  xray::Tube filters;
  xray::DoseMode dose_mode = xray::DoseMode::kNormal;
  double pulses_per_s = 15.0;
  xray::ImageMode mode = xray::ImageMode::kLive;
  bool is_inverted = false;
  double table_mm = 0.0;            ///< Height of the table, up positive. Range -150..150.
  double injection_ml_per_s = 1.0;  ///< While contrast agent is injected. Range 0.1..10.
};

}  // namespace trocar::trainer
