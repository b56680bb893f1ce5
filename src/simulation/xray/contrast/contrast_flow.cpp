#include "xray/contrast/contrast_flow.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include "core/files/folders.h"
#include "core/live/live_schedule.h"
#include "core/log.h"
#include "core/result.h"
#include "core/start_thread.h"

namespace trocar::xray {
namespace {

constexpr double kLongestStep_s = 0.01;
constexpr double kLongestFrame_s = 1.0;
constexpr double kMostRate_ml_per_s = 50.0;  ///< A power injector's.
constexpr double kMostIodine_mg_per_ml = 500.0;
constexpr double kTissue_mm = 1.5, kFluid_mm = 2.5;  ///< Voxels.
constexpr double kDuctReach_mm = 3.0;                ///< From a voxel of a duct's label to the tree.
constexpr double kThinnestPiece_mg_per_ml = 0.05;    ///< Thinner pieces are not given to the projector.

std::string point_text(const Vec3& p_P) {
  return fmt::format("tip at {:g}, {:g}, {:g} mm", p_P.x(), p_P.y(), p_P.z());
}

}  // namespace

ContrastFlow::ContrastFlow(std::shared_ptr<const anatomy::VirtualPatient> patient, const ContrastTable& table,
                           BloodVelocity blood)
    : patient_(std::move(patient)),
      ducts_(make_duct_tree(*patient_, {.bridge_mm = table.duct.bridge_mm}), table.duct),
      vessels_(patient_, table.vessel, std::move(blood)),
      tissue_(patient_, table, kTissue_mm),
      fluid_(patient_, table, kFluid_mm) {}

Result<ContrastFlow> ContrastFlow::make(std::shared_ptr<const anatomy::VirtualPatient> patient,
                                        const ContrastTable& table, BloodVelocity blood) {
  TROCAR_CHECK(patient != nullptr && !table.media.empty());
  if (patient->labels.empty())
    return fail("contrast agent needs labels, and the patient has none", patient->name,
                "build the patient with a segmentation");
  return ContrastFlow(std::move(patient), table, std::move(blood));
}

Status ContrastFlow::inject(const Vec3& tip_P, double ml_per_s, double iodine_mg_per_ml) {
  stop_injection();
  if (!tip_P.allFinite())
    return fail_usage("the injection's place is not a finite point", point_text(tip_P), "give three numbers in mm");
  if (!(ml_per_s >= 0.0 && ml_per_s <= kMostRate_ml_per_s))
    return fail_usage(fmt::format("a rate of {:g} ml/s cannot be injected", ml_per_s), point_text(tip_P),
                      fmt::format("use 0 to {:g}", kMostRate_ml_per_s));
  if (!(iodine_mg_per_ml >= 0.0 && iodine_mg_per_ml <= kMostIodine_mg_per_ml))
    return fail_usage(fmt::format("no contrast agent has {:g} mg iodine per ml", iodine_mg_per_ml), point_text(tip_P),
                      fmt::format("use 0 to {:g}", kMostIodine_mg_per_ml));
  tip_P_ = tip_P;
  target_ = find_target(tip_P);
  ml_per_s_ = ml_per_s;
  iodine_mg_per_ml_ = iodine_mg_per_ml;
  return {};
}

ContrastFlow::Target ContrastFlow::find_target(const Vec3& tip_P) const {
  if (!tip_P.allFinite()) return {};
  const anatomy::Label* label = anatomy::find_label(*patient_, tip_P);
  if (label != nullptr && label->tissue == "vessel") return {ContrastPlace::kVessel, -1};
  if (label != nullptr && label->tissue == "bile_duct") {
    const int cell = ducts_.tree().find_cell(tip_P, kDuctReach_mm);
    // A speck of the label that belongs to no duct is like its surroundings.
    return {cell >= 0 ? ContrastPlace::kDuct : ContrastPlace::kTissue, cell};
  }
  const ContrastMedium* medium = tissue_.medium_at(tip_P);
  return {medium != nullptr ? medium->place : ContrastPlace::kOutside, -1};
}

ContrastPlace ContrastFlow::place(const Vec3& tip_P) const {
  return find_target(tip_P).place;
}

void ContrastFlow::inject_for(double dt_s) {
  const double ml = dt_s * ml_per_s_;
  const double mg = ml * iodine_mg_per_ml_;
  injected_ml_ += ml;
  injected_mg_ += mg;
  switch (target_.place) {
    case ContrastPlace::kDuct:
      return;  // with the ducts' own step
    case ContrastPlace::kVessel:
      vessels_.inject(tip_P_, dt_s, ml, iodine_mg_per_ml_);
      return;
    case ContrastPlace::kOutside:
      spilled_mg_ += mg;
      return;
    default:
      (fluid_.is_fluid_near(tip_P_) ? fluid_ : tissue_).inject(tip_P_, ml, iodine_mg_per_ml_);
  }
}

void ContrastFlow::step(double dt_s) {
  TROCAR_CHECK(dt_s >= 0.0 && dt_s <= kLongestFrame_s);
  const auto count = static_cast<int>(std::ceil(dt_s / kLongestStep_s - 1e-9));
  const bool injects = ml_per_s_ > 0.0;
  const bool is_moving = target_.place == ContrastPlace::kVessel || target_.place == ContrastPlace::kDuct;
  for (int n = 0; n < count; ++n) {
    const double part_s = dt_s / count;
    vessels_.step(part_s);
    if (injects && is_moving) inject_for(part_s);
    const bool is_duct = injects && target_.place == ContrastPlace::kDuct;
    ducts_.step(part_s, is_duct ? target_.cell : -1, ml_per_s_, iodine_mg_per_ml_);
  }
  if (count == 0) return;
  if (injects && !is_moving) inject_for(dt_s);
  tissue_.step(dt_s);
  fluid_.step(dt_s);
}

Iodine ContrastFlow::iodine() const {
  Iodine iodine;
  if (ducts_.has_iodine()) ducts_.add_pieces(kThinnestPiece_mg_per_ml, iodine.pieces);
  vessels_.add_pieces(kThinnestPiece_mg_per_ml, iodine.pieces);
  for (const TissueCloud* cloud : {&tissue_, &fluid_})
    if (auto grid = cloud->grid_mg_per_ml()) iodine.grids_mg_per_ml.push_back(std::move(grid));
  return iodine;
}

ContrastTotals ContrastFlow::totals() const {
  ContrastTotals totals;
  totals.injected_ml = injected_ml_;
  totals.injected_mg = injected_mg_;
  totals.ducts_mg = ducts_.iodine_mg();
  totals.vessels_mg = vessels_.iodine_mg();
  totals.tissue_mg = tissue_.iodine_mg() + fluid_.iodine_mg();
  totals.drained_mg = ducts_.drained_mg();
  totals.washed_away_mg =
      ducts_.refluxed_mg() + vessels_.washed_away_mg() + tissue_.washed_away_mg() + fluid_.washed_away_mg();
  totals.spilled_mg = spilled_mg_;
  totals.ducts_ml = ducts_.contrast_ml();
  return totals;
}

namespace {

constexpr std::chrono::milliseconds kPeriod{33};
constexpr double kLongestCatchUp_s = 0.5;  // after a stall the agent does not catch up
constexpr int kNice = 5;

}  // namespace

struct LiveContrast::Impl {
  void run(const std::stop_token& stop, std::shared_ptr<const anatomy::VirtualPatient> patient, BloodVelocity blood);
  void advance(ContrastFlow& flow, double iodine_mg_per_ml, double dt_s);

  Feed<InjectionRequest> wanted;
  Feed<ContrastState> states;
  std::jthread thread;
};

void LiveContrast::Impl::run(const std::stop_token& stop, std::shared_ptr<const anatomy::VirtualPatient> patient,
                             BloodVelocity blood) {
  lower_priority(kNice);
  const auto table = load_contrast_table(data_dir() / "contrast.toml");
  if (!table) return log_warning("{}", table.error().text());
  auto flow = ContrastFlow::make(std::move(patient), *table, std::move(blood));
  if (!flow) return log_warning("no contrast agent: {}", flow.error().text());
  auto last = std::chrono::steady_clock::now();
  while (!stop.stop_requested()) {
    const auto now = std::chrono::steady_clock::now();
    advance(*flow, table->iodine_mg_per_ml,
            std::min(kLongestCatchUp_s, std::chrono::duration<double>(now - std::exchange(last, now)).count()));
    std::this_thread::sleep_until(now + kPeriod);
  }
}

void LiveContrast::Impl::advance(ContrastFlow& flow, double iodine_mg_per_ml, double dt_s) {
  const std::shared_ptr<const InjectionRequest> wanted_now = wanted.value();
  const InjectionRequest request = wanted_now ? *wanted_now : InjectionRequest{};
  const std::shared_ptr<const ContrastState> before = states.value();
  if (request.ml_per_s <= 0.0 || !request.tip_P.allFinite()) {
    flow.stop_injection();
  } else if (const Status status = flow.inject(request.tip_P, request.ml_per_s, iodine_mg_per_ml); !status) {
    log_warning("{}", status.error().text());
  }
  flow.step(dt_s);
  auto state = std::make_shared<ContrastState>();
  state->place = flow.place(request.tip_P);
  state->injected_ml = flow.totals().injected_ml;
  state->iodine_mg_per_ml = iodine_mg_per_ml;
  // Without agent in the body the pointer stays the same: nothing changes in the image.
  state->iodine =
      flow.totals().in_body_mg() > 0.0 || !before ? std::make_shared<const Iodine>(flow.iodine()) : before->iodine;
  states.publish(std::move(state));
}

LiveContrast::LiveContrast() : impl_(std::make_unique<Impl>()) {}
LiveContrast::~LiveContrast() = default;

void LiveContrast::open(std::shared_ptr<const anatomy::VirtualPatient> patient, BloodVelocity blood) {
  close();
  auto thread = start_stoppable_thread(
      "contrast agent", [impl = impl_.get(), patient = std::move(patient),
                         blood = std::move(blood)](const std::stop_token& stop) { impl->run(stop, patient, blood); });
  if (!thread) return log_warning("no contrast agent: {}", thread.error().text());
  impl_->thread = *std::move(thread);
}

void LiveContrast::close() {
  impl_->thread = {};  // stops and joins
  impl_->states.clear();
  impl_->wanted.clear();
}

void LiveContrast::request(const InjectionRequest& request) {
  impl_->wanted.publish(request);
}

const Feed<ContrastState>& LiveContrast::states() const noexcept {
  return impl_->states;
}

}  // namespace trocar::xray
