#include "xray/fluoroscopy/detail/patient_image.h"

#include <algorithm>
#include <cmath>

#include "xray/projection/moved_volume.h"
#include "xray/projection/xray_volume.h"
#include "xray/tools/tool_shape.h"

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

namespace {

constexpr float kG_per_mg = 1e-3F;

}  // namespace

void AddedSignal::update_iodine(const FluoroscopyRequest& request, const PatientImage& patient) {
  const bool is_same =
      iodine_ == request.iodine && arm_ && has_same_rays(*arm_, request.arm) && motion_.is_same_place(request.motion);
  if (is_same) return;
  iodine_ = request.iodine;
  arm_ = request.arm;
  motion_ = request.motion;
  iodine_g_per_cm2_.clear();
  if (!iodine_) return;
  for (const auto& grid : iodine_->grids_mg_per_ml) {
    project(request.motion.is_rest() ? *grid : moved_grid(*grid, request.motion), patient.rays(), integrals_);
    iodine_g_per_cm2_.resize(integrals_.size(), 0.0F);
    for (std::size_t n = 0; n < integrals_.size(); ++n) iodine_g_per_cm2_[n] += kG_per_mg * integrals_[n];
  }
  if (!iodine_->pieces.empty())
    add_iodine(moved_pieces(iodine_->pieces, request.motion), patient.rays(), iodine_g_per_cm2_);
}

void AddedSignal::apply(const FluoroscopyRequest& request, const PatientImage& patient, std::vector<float>& signal) {
  update_iodine(request, patient);
  signal = patient.primary();
  for (std::vector<float>& image : added_.g_per_cm2) std::fill(image.begin(), image.end(), 0.0F);
  if (added_.size() != patient.masses().size()) added_ = {};
  added_.columns = patient.masses().columns;
  added_.rows = patient.masses().rows;
  if (!iodine_g_per_cm2_.empty()) added_.of(Basis::kIodine) = iodine_g_per_cm2_;
  add_tools(request.tools, patient.rays(), added_);

  is_changed_.assign(signal.size(), 0);
  for (const std::vector<float>& image : added_.g_per_cm2)
    for (std::size_t n = 0; n < image.size(); ++n) is_changed_[n] |= static_cast<std::uint8_t>(image[n] != 0.0F);
  places_.clear();
  for (std::size_t n = 0; n < signal.size(); ++n)
    if (is_changed_[n] != 0 && signal[n] > 0.0F) places_.push_back(n);
  if (places_.empty()) return;
  few_.columns = static_cast<int>(places_.size());
  few_.rows = 1;
  few_signal_.resize(places_.size());
  for (std::size_t basis = 0; basis < kBases; ++basis) {
    const std::vector<float>& body = patient.masses().g_per_cm2[basis];
    const std::vector<float>& added = added_.g_per_cm2[basis];
    std::vector<float>& few = few_.g_per_cm2[basis];
    few.clear();
    if (body.empty() && added.empty()) continue;
    for (const std::size_t n : places_)
      few.push_back((body.empty() ? 0.0F : body[n]) + (added.empty() ? 0.0F : std::max(0.0F, added[n])));
  }
  patient.beam().signals(few_, few_signal_);
  for (std::size_t n = 0; n < places_.size(); ++n) signal[places_[n]] = few_signal_[n];
}

}  // namespace trocar::xray::detail
