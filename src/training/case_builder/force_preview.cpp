#include "case_builder/force_preview.h"

#include <algorithm>

#include "cases/needle_geometry.h"

namespace trocar::case_builder {
namespace {

constexpr double kSpeed_mm_per_s = 10.0;
constexpr double kMostLag_mm = 20.0;  ///< Behind the device by the compliance of tissue and coupling.

}  // namespace

Result<ForcePreview> preview_forces(const CaseDraft& draft, std::shared_ptr<const anatomy::VirtualPatient> patient,
                                    const tasks::Needle& needle, const anatomy::TissueTable& tissues) {
  const anatomy::NeedlePath* path = find_expert_path(draft);
  if (path == nullptr) return fail("no expert path is drawn", draft.name, "draw one, or have one planned");
  haptics::HapticOptions options;
  options.has_weight_compensation = false;
  TROCAR_TRY(options.force_model, haptics::parse_force_model(draft.task.force_model));
  TROCAR_TRY(const auto scene,
             haptics::make_haptic_scene(std::move(patient), tissues, cases::needle_geometry(needle), {}, options));
  cases::PrescribedMotion motion;
  motion.line_P = path->line_P;
  motion.speed_mm_per_s = kSpeed_mm_per_s;
  motion.after_mm = kMostLag_mm;
  ForcePreview preview;
  preview.curve = cases::force_curve(*scene, motion);
  preview.events = cases::find_curve_events(preview.curve, tissues);
  preview.pieces = cases::pieces_along(*scene, tissues, path->line_P);
  for (const cases::CurvePoint& point : preview.curve) preview.highest_n = std::max(preview.highest_n, point.force_n);
  return preview;
}

}  // namespace trocar::case_builder
