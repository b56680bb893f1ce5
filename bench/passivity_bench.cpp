// Energy of random closed motions of a prescribed tool, by force model: docs/physics.md H8, docs/validation.md.

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>

#include "bench/benchmarks.h"
#include "bench/passivity_motions.h"
#include "core/files/atomic_file.h"
#include "core/parallel.h"

namespace trocar::bench {
namespace {

constexpr double kAllowed_mj = 0.1;
constexpr double kFiner = 4.0;  ///< Rate of the repetition of the worst motion.

struct RunMotion {
  PlannedMotion planned;
  haptics::PassivityOutcome outcome;

  bool is_lossless() const { return haptics::is_elastic(planned.kind); }
  /// What must not exceed the allowance: energy made, and without losses energy that is missing, too.
  double error_mj() const {
    if (!outcome.is_finite) return std::numeric_limits<double>::infinity();
    const double made_mj = std::max(outcome.most_mj, is_lossless() ? 0.0 : outcome.device_mj);
    return is_lossless() ? std::max(made_mj, std::abs(outcome.end_mj)) : made_mj;
  }
  bool is_missed() const { return error_mj() > kAllowed_mj || !is_valid(); }
  /// A closed motion starts and ends without contact.
  bool is_valid() const { return outcome.is_free_at_start && outcome.is_free_at_end; }
};

haptics::PassivityOutcome run_at(const PlannedMotion& planned, double rate_hz,
                                 const std::function<void(const haptics::PassivitySample&)>& see = {}) {
  haptics::PassivityTrial trial;
  trial.before = planned.before ? &*planned.before : nullptr;
  trial.motion = &*planned.motion;
  trial.dt_s = 1.0 / rate_hz;
  return haptics::run_passivity_trial(*planned.scene, trial, see);
}

std::vector<int> numbers_of(const Options& options) {
  if (options.only >= 0) return {options.only};
  std::vector<int> numbers;
  for (int number = 0; static_cast<int>(numbers.size()) < options.motions; ++number)
    if (options.model.empty() || options.model == to_string(model_of(number))) numbers.push_back(number);
  return numbers;
}

Result<std::vector<RunMotion>> run_all(const MotionPool& pool, const Options& options) {
  const std::vector<int> numbers = numbers_of(options);
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

using Group = std::vector<const RunMotion*>;

const RunMotion& worst_of(const Group& group) {
  return **std::max_element(group.begin(), group.end(),
                            [](const RunMotion* a, const RunMotion* b) { return a->error_mj() < b->error_mj(); });
}

std::string note_of(const Group& group) {
  const RunMotion& worst = worst_of(group);
  const auto missed = std::count_if(group.begin(), group.end(), [](const RunMotion* m) { return m->is_missed(); });
  const auto limited =
      std::count_if(group.begin(), group.end(), [](const RunMotion* m) { return m->outcome.limited_ticks > 0; });
  const auto touching = std::count_if(group.begin(), group.end(), [](const RunMotion* m) { return !m->is_valid(); });
  const haptics::PassivityOutcome finer = run_at(worst.planned, kFiner * worst.planned.rate_hz);
  std::string note = fmt::format(
      "{} of {} above {} mJ; worst {:.3f} mJ made, {:+.3f} at the end ({:.3f} and {:+.3f} at {:.0f} times the rate), "
      "{:.1f} mJ put in, "
      "{:.1f} N; {}",
      missed, group.size(), kAllowed_mj, worst.outcome.most_mj, worst.outcome.end_mj, finer.most_mj, finer.end_mj,
      kFiner, worst.outcome.stored_mj, worst.outcome.peak_force_n, worst.planned.text());
  if (limited > 0) note += fmt::format("; the device's limits act in {}", limited);
  if (touching > 0) note += fmt::format("; {} in contact at start or end", touching);
  return note;
}

/// `is_judged`: the case decides on the exit status.
void add_case(std::vector<CaseResult>& results, const std::string& name, const Group& group, bool is_judged) {
  std::vector<double> errors;
  for (const RunMotion* motion : group) errors.push_back(motion->error_mj());
  CaseResult result{name, "mj", figures_of(errors), {}, note_of(group)};
  result.is_missed =
      is_judged && std::any_of(group.begin(), group.end(), [](const RunMotion* m) { return m->is_missed(); });
  results.push_back(std::move(result));
}

void add_model(std::vector<CaseResult>& results, const std::vector<RunMotion>& motions, MovedModel model) {
  std::map<haptics::MotionKind, Group> by_kind;
  Group net, lossless;
  for (const RunMotion& motion : motions) {
    if (motion.planned.model != model) continue;
    by_kind[motion.planned.kind].push_back(&motion);
    (motion.is_lossless() ? lossless : net).push_back(&motion);
  }
  const std::string prefix = fmt::format("passivity/{}", to_string(model));
  if (!net.empty()) add_case(results, prefix + "/net", net, true);
  if (!lossless.empty()) add_case(results, prefix + "/lossless", lossless, true);
  for (const auto& [kind, group] : by_kind) add_case(results, fmt::format("{}/{}", prefix, to_string(kind)), group, false);
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

/// The worst motion of every model.
Status write_worst(const std::vector<RunMotion>& motions, const std::filesystem::path& out) {
  return write_folder_atomically(out, [&](const std::filesystem::path& folder) -> Status {
    for (const MovedModel model : kMovedModels) {
      for (const bool is_lossless : {false, true}) {
        Group group;
        for (const RunMotion& motion : motions)
          if (motion.planned.model == model && motion.is_lossless() == is_lossless) group.push_back(&motion);
        if (group.empty()) continue;
        const PlannedMotion& worst = worst_of(group).planned;
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
  std::vector<CaseResult> results;
  for (const MovedModel model : kMovedModels) add_model(results, motions, model);
  if (!options.out.empty()) TROCAR_TRY_STATUS(write_worst(motions, options.out));
  return results;
}

}  // namespace trocar::bench
