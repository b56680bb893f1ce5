#include "xray/fluoroscopy/detail/added_signal.h"

#include <algorithm>

#include "xray/projection/moved_volume.h"
#include "xray/projection/project.h"
#include "xray/tools/iodine_pieces.h"

namespace trocar::xray::detail {
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
