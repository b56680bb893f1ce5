// Energy of random closed motions of a prescribed tool, by force model: docs/physics.md H8, docs/validation.md.

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <map>

#include "bench/benchmarks.h"
#include "bench/haptics/passivity_motions.h"
#include "core/files/output_file.h"
#include "core/parallel.h"

namespace trocar::bench {
namespace {

constexpr double kAllowed_mj = 0.1;
constexpr double kFiner = 4.0;  ///< Rate of the repetition of the worst motion.

struct RunMotion {
  PlannedMotion planned;
  haptics::PassivityOutcome outcome;

  bool is_lossless() const { return haptics::is_elastic(planned.kind); }
  bool is_limited() const { return outcome.limited_ticks > 0; }
  /// Energy that the force model made.
  double made_mj() const { return outcome.is_finite ? outcome.most_mj : std::numeric_limits<double>::infinity(); }
  /// What is missing at the end of a motion without losses: where a stretched spring lets go at once. Not known while
  /// the needle is still in its channel.
  double lost_mj() const { return is_lossless() && outcome.is_free_at_end ? -std::min(0.0, outcome.end_mj) : 0.0; }
};

haptics::PassivityOutcome run_at(const PlannedMotion& planned, double rate_hz,
                                 const std::function<void(const haptics::PassivitySample&)>& see = {}) {
  haptics::PassivityTrial trial;
  trial.before = planned.before ? &*planned.before : nullptr;
  trial.motion = &*planned.motion;
  trial.dt_s = 1.0 / rate_hz;
  return haptics::run_passivity_trial(*planned.scene, trial, see);
}

std::vector<int> motion_numbers(const Options& options) {
  if (options.only >= 0) return {options.only};
  std::vector<int> numbers;
  for (int number = 0; static_cast<int>(numbers.size()) < options.motions; ++number)
    if (options.model.empty() || options.model == to_string(model_of(number))) numbers.push_back(number);
  return numbers;
}

Result<std::vector<RunMotion>> run_all(const MotionPool& pool, const Options& options) {
  const std::vector<int> numbers = motion_numbers(options);
  std::vector<RunMotion> motions(numbers.size());
  std::vector<Status> done(numbers.size());
  std::atomic<std::size_t> count{0};
  parallel_for(numbers.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      auto planned = plan_motion(pool, options.seed, numbers[i]);
      if (!planned) {
        done[i] = tl::make_unexpected(planned.error());
        continue;
      }
      motions[i].planned = std::move(*planned);
      motions[i].outcome = run_at(motions[i].planned, motions[i].planned.rate_hz);
      const std::size_t now = ++count;
      constexpr std::size_t kReport = 64;
      if (now % kReport == 0)
        core::report(options.progress, "moving tools", static_cast<double>(now) / static_cast<double>(numbers.size()));
    }
  });
  for (const Status& status : done) TROCAR_TRY_STATUS(status);
  return motions;
}

using MotionGroup = std::vector<const RunMotion*>;
using EnergyOf = std::function<double(const RunMotion&)>;

const RunMotion& worst_of(const MotionGroup& group, const EnergyOf& energy) {
  return **std::max_element(group.begin(), group.end(),
                            [&](const RunMotion* a, const RunMotion* b) { return energy(*a) < energy(*b); });
}

std::string group_note(const MotionGroup& group, const RunMotion& worst, std::size_t missed) {
  const auto open =
      std::count_if(group.begin(), group.end(), [](const RunMotion* m) { return !m->outcome.is_free_at_end; });
  const haptics::PassivityOutcome& outcome = worst.outcome;
  const haptics::PassivityOutcome finer = run_at(worst.planned, kFiner * worst.planned.rate_hz);
  std::string note = fmt::format(
      "{} of {} above {} mJ; worst {:.3f} mJ made, {:+.3f} at the end ({:.3f}, {:+.3f} at {:.0f} times the rate), "
      "{:.1f} "
      "mJ put in, {:.1f} N, {:.3f} mJ made after the device's limits; {}",
      missed, group.size(), kAllowed_mj, outcome.most_mj, outcome.end_mj, finer.most_mj, finer.end_mj, kFiner,
      outcome.stored_mj, outcome.peak_force_n, outcome.device_mj, worst.planned.text());
  if (open > 0) note += fmt::format("; in contact at the end: {}", open);
  return note;
}

/// `is_judged`: the case decides on the exit status.
void add_group(std::vector<CaseResult>& results, const std::string& name, const MotionGroup& group,
               const EnergyOf& energy, bool is_judged) {
  if (group.empty()) return;
  std::vector<double> energies;
  for (const RunMotion* motion : group) energies.push_back(energy(*motion));
  const auto missed = static_cast<std::size_t>(
      std::count_if(energies.begin(), energies.end(), [](double mj) { return !(mj <= kAllowed_mj); }));
  CaseResult result{name, "mj", figures_of(energies), {}, group_note(group, worst_of(group, energy), missed)};
  result.is_missed = is_judged && missed > 0;
  results.push_back(std::move(result));
}

double law_mj(const RunMotion& motion) {
  return motion.made_mj();
}
double lost_mj(const RunMotion& motion) {
  return motion.lost_mj();
}
double device_mj(const RunMotion& motion) {
  return motion.outcome.device_mj;
}

bool is_face(MovedModel model) {
  return model == MovedModel::kProbe || model == MovedModel::kFinger;
}

void add_model(std::vector<CaseResult>& results, const std::vector<RunMotion>& motions, MovedModel model) {
  std::map<haptics::MotionKind, MotionGroup> by_kind;
  MotionGroup net, lossless, limited;
  for (const RunMotion& motion : motions) {
    if (motion.planned.model != model) continue;
    by_kind[motion.planned.kind].push_back(&motion);
    (motion.is_lossless() ? lossless : net).push_back(&motion);
    if (!motion.is_lossless() && motion.is_limited()) limited.push_back(&motion);
  }
  const std::string prefix = fmt::format("passivity/{}", to_string(model));
  add_group(results, prefix + "/net", net, law_mj, !is_face(model));
  add_group(results, prefix + "/net-limited", limited, device_mj, false);
  // Without losses: the area of a face that the skin supports depends on its tilt without a torque for it (B9).
  add_group(results, prefix + "/lossless", lossless, law_mj, !is_face(model));
  add_group(results, prefix + "/lossless-lost", lossless, lost_mj, false);
  for (const auto& [kind, group] : by_kind)
    add_group(results, fmt::format("{}/{}", prefix, to_string(kind)), group, law_mj, false);
}

Status write_motion(const PlannedMotion& planned, const std::filesystem::path& file) {
  std::string text =
      "time_s,tip_x_mm,tip_y_mm,tip_z_mm,axis_x,axis_y,axis_z,f_x_n,f_y_n,f_z_n,tau_x_nmm,tau_y_nmm,tau_z_nmm,"
      "energy_mj,by_force_mj,by_torque_mj,virtual_x_mm,virtual_y_mm,virtual_z_mm,depth_mm,phase,prepuncture_n,"
      "friction_n,cutting_n,stick_n,body_n,constraint_x_n,constraint_y_n,constraint_z_n,tip_proxy_x_n,tip_proxy_y_n,"
      "tip_proxy_z_n,puncture\n";
  const auto add = [&](const Vec3& v) { text += fmt::format(",{:.6g},{:.6g},{:.6g}", v.x(), v.y(), v.z()); };
  run_at(planned, planned.rate_hz, [&](const haptics::PassivitySample& sample) {
    const telemetry::TickSample& tick = sample.tick;
    text += fmt::format("{:.6f}", sample.time_s);
    add(sample.X_PTool.p());
    add(sample.X_PTool.R().col(planned.model == MovedModel::kProbe || planned.model == MovedModel::kFinger ? 1 : 2));
    add(sample.wrench_P.force_n);
    add(sample.wrench_P.torque_nmm);
    text += fmt::format(",{:.6g},{:.6g},{:.6g}", sample.by_force_mj + sample.by_torque_mj, sample.by_force_mj,
                        sample.by_torque_mj);
    add(tick.tip_mm);
    text += fmt::format(",{:.6g},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}", tick.depth_mm, static_cast<int>(tick.phase),
                        tick.f_prepuncture_n, tick.f_friction_n, tick.f_cutting_n, tick.f_stick_n, tick.f_body_axial_n);
    add(tick.f_constraint_n);
    add(tick.f_tip_proxy_n);
    const bool has_punctured = tick.events[0].kind == telemetry::EventKind::kPuncture;
    text += fmt::format(",{:d}\n", has_punctured);
  });
  return write_file_atomically(file, text);
}

/// One row per motion.
Status write_list(const std::vector<RunMotion>& motions, const std::filesystem::path& file) {
  std::string text =
      "number,model,kind,angle_deg,tempo_mm_s,rate_hz,patient,needle,profile,error_mj,made_mj,made_at_s,end_mj,"
      "device_made_mj,put_in_mj,peak_n,punctures,ticks,limited_ticks,is_free_at_start,is_free_at_end\n";
  for (const RunMotion& motion : motions) {
    const PlannedMotion& p = motion.planned;
    const haptics::PassivityOutcome& o = motion.outcome;
    text += fmt::format(
        "{},{},{},{:.2f},{:.2f},{:.0f},{},{},{},{:.6g},{:.6g},{:.3f},{:.6g},{:.6g},{:.6g},{:.4g},{},{},"
        "{},{:d},{:d}\n",
        p.number, to_string(p.model), haptics::to_string(p.kind), p.angle_deg, p.tempo_mm_per_s, p.rate_hz, p.patient,
        p.needle, p.profile, std::max(motion.made_mj(), motion.lost_mj()), o.most_mj, o.most_s, o.end_mj, o.device_mj,
        o.stored_mj, o.peak_force_n, o.punctures, o.ticks, o.limited_ticks, o.is_free_at_start, o.is_free_at_end);
  }
  return write_file_atomically(file, text);
}

/// All motions as a list, and the worst one of every model tick by tick.
Status write_worst(const std::vector<RunMotion>& motions, const std::filesystem::path& out) {
  return write_folder_atomically(out, [&](const std::filesystem::path& folder) -> Status {
    TROCAR_TRY_STATUS(write_list(motions, folder / "motions.csv"));
    for (const MovedModel model : kMovedModels) {
      for (const bool is_lossless : {false, true}) {
        MotionGroup group;
        for (const RunMotion& motion : motions)
          if (motion.planned.model == model && motion.is_lossless() == is_lossless) group.push_back(&motion);
        if (group.empty()) continue;
        const PlannedMotion& worst = worst_of(group, law_mj).planned;
        const std::string name = fmt::format("{}-{}-{}.csv", to_string(model), to_string(worst.kind), worst.number);
        TROCAR_TRY_STATUS(write_motion(worst, folder / name));
      }
    }
    return {};
  });
}

}  // namespace

Result<std::vector<CaseResult>> run_passivity_benchmark(const Options& options) {
  TROCAR_TRY(const MotionPool pool, load_motion_pool(options.progress));
  TROCAR_TRY(const auto motions, run_all(pool, options));
  for (const RunMotion& motion : motions)
    if (!motion.outcome.is_free_at_start)
      return fail("a motion starts in contact", motion.planned.text(), "start it farther from the skin");
  std::vector<CaseResult> results;
  for (const MovedModel model : kMovedModels) add_model(results, motions, model);
  if (!options.out.empty()) TROCAR_TRY_STATUS(write_worst(motions, options.out));
  return results;
}

}  // namespace trocar::bench
