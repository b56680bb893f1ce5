#include "bench/images/xray_contrast_bench.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>

#include "core/files/folders.h"
#include "phantom/phantom.h"
#include "xray/contrast/contrast_flow.h"

namespace trocar::bench {
namespace {

constexpr double kVoxel_mm = 1.5;
constexpr double kFrame_s = 0.033;
constexpr double kRate_ml_per_s = 0.8;
constexpr double kAgent_mg_per_ml = 300.0;
constexpr int kContrastFrames = 600;

/// A tip in the middle of a peripheral duct: that end of a duct which has the widest lumen.
Result<Vec3> find_tip_P(const xray::DuctTree& tree) {
  const xray::DuctCell* widest = nullptr;
  for (const xray::DuctCell& cell : tree.cells) {
    const bool is_peripheral = cell.end == xray::DuctEnd::kPeripheral;
    if (is_peripheral && (widest == nullptr || cell.radius_b_mm > widest->radius_b_mm)) widest = &cell;
  }
  if (widest == nullptr) return fail("the patient has no peripheral bile duct", "ptcd-1", "check data/phantoms");
  return Vec3(0.5 * (widest->a_P + widest->b_P));
}

}  // namespace

Result<std::vector<CaseResult>> contrast_cases(const Progress& progress) {
  core::report(progress, "generating the patient with bile ducts", 0.92);
  TROCAR_TRY(auto phantom, phantom::generate_phantom("ptcd-1", 1, {{0, 0, 0}, kVoxel_mm}));
  const auto patient = std::make_shared<const anatomy::VirtualPatient>(std::move(phantom));
  TROCAR_TRY(const xray::ContrastTable table, xray::load_contrast_table(data_dir() / "contrast.toml"));
  const auto start = std::chrono::steady_clock::now();
  TROCAR_TRY(auto flow, xray::ContrastFlow::make(patient, table));
  const double make_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
  TROCAR_TRY(const Vec3 tip_P, find_tip_P(flow.ducts().tree()));
  TROCAR_TRY_STATUS(flow.inject(tip_P, kRate_ml_per_s, kAgent_mg_per_ml));
  std::size_t pieces = 0;
  core::report(progress, "injecting contrast agent", 0.95);
  const Figures figures = time_ms(0, kContrastFrames, [&] {
    flow.step(kFrame_s);
    pieces = flow.iodine().pieces.size();
  });
  if (pieces == 0) return fail("no duct contains contrast agent", "contrast/step", "check the place of the tip");
  return std::vector<CaseResult>{
      {"contrast/ducts", "ms", figure_of(make_ms), {}, "the tree of ducts of ptcd-1 at 1.5 mm, once"},
      {"contrast/step",
       "ms",
       figures,
       {},
       fmt::format(
           "flow and pieces of a frame of 33 ms, one thread; {} cells, {:.1f} ml/s for {:.0f} s, then {} pieces",
           flow.ducts().tree().cells.size(), kRate_ml_per_s, kContrastFrames * kFrame_s, pieces)}};
}

}  // namespace trocar::bench
