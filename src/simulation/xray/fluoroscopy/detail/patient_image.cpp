#include "xray/fluoroscopy/detail/patient_image.h"

#include <algorithm>
#include <cmath>

#include "xray/projection/moved_volume.h"
#include "xray/projection/project.h"

namespace trocar::xray::detail {
namespace {

/// Sets the pixels behind the shutters to 0.
void close_shutters(const FieldPixels& field, int columns, std::vector<float>& signal) {
  const int rows = static_cast<int>(signal.size()) / std::max(columns, 1);
  for (int row = 0; row < rows; ++row) {
    const auto line = signal.begin() + static_cast<std::ptrdiff_t>(row) * columns;
    const bool is_open = row >= field.first_row && row < field.last_row;
    std::fill(line, line + (is_open ? field.first_column : columns), 0.0F);
    if (is_open) std::fill(line + field.last_column, line + columns, 0.0F);
  }
}

}  // namespace

bool has_same_rays(const CArm& a, const CArm& b) noexcept {
  CArm other = b;
  other.collimation = a.collimation;
  return a == other;
}

void PatientImage::expose(const FluoroscopyRequest& request) {
  primary_.resize(masses_.size());
  beam_->signals(masses_, primary_);
  close_shutters(field_pixels(request.arm), masses_.columns, primary_);
  scatter_ = estimate_scatter(masses_, primary_, request.arm, params_);
}

Status PatientImage::update(const FluoroscopyRequest& request, const ExposureLimits& limits) {
  const bool is_projected = key_ && has_same_rays(key_->arm, request.arm) && key_->motion.is_same_place(request.motion);
  if (!is_projected) {
    if (!now_ || !key_ || !key_->motion.is_same_place(request.motion)) now_ = moved_volume(volume_, request.motion);
    TROCAR_TRY_STATUS(check_source(*now_, request.arm));
    rays_ = rays_of(request.arm);
    project(*now_, rays_, masses_);
    key_ = Key{request.arm, request.motion};
  }
  const ExposureKey wanted{request.arm.collimation, request.filters, request.dose_mode, request.pulses_per_s};
  if (is_projected && exposure_key_ == wanted) return {};
  exposure_key_.reset();
  TROCAR_TRY(exposure_, control_exposure(masses_, request.arm, request.filters, request.dose_mode, request.pulses_per_s,
                                         limits, beams_));
  TROCAR_TRY(beam_, beams_.beam(exposure_.tube));
  expose(request);
  exposure_key_ = wanted;
  return {};
}

}  // namespace trocar::xray::detail
