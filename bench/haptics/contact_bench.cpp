// The two events of special interest to users on every device: contact of the needle with bone, and the loss of
// resistance behind the ligamentum flavum. docs/validation.md, Bone and loss of resistance by device.

#include <fmt/format.h>

#include <array>

#include "bench/benchmarks.h"
#include "bench/haptics/flat_scene.h"
#include "core/files/folders.h"
#include "haptics/option_texts.h"
#include "lab/haptics/push_trial.h"

namespace trocar::bench {
namespace {

constexpr double kBone_mm = 25.0;
constexpr double kPastBone_mm = 10.0;  // final target depth of the tip
constexpr double kFlavum_mm = 30.0;
constexpr double kFlavumThickness_mm = 4.0;  // [assumed] 3..5
constexpr double kPastFlavum_mm = 45.0;

struct ContactSetting {
  const anatomy::TissueTable& table;
  const stylus::DevicePreset& device;
  haptics::ForceModel model;
  std::uint64_t seed;
};

Result<std::vector<haptics::PushSample>> push(const ContactSetting& setting,
                                              const std::shared_ptr<const anatomy::VirtualPatient>& patient,
                                              const haptics::PushTrial& trial) {
  haptics::HapticOptions haptic;
  haptic.force_model = setting.model;
  haptic.seed = setting.seed;
  haptics::apply_device_preset(setting.device, haptic);
  TROCAR_TRY(const auto scene,
             haptics::make_haptic_scene(patient, setting.table, {}, setting.device.capability, haptic));
  return haptics::run_push_trial(scene, setting.device, trial);
}

void add_value(std::vector<CaseResult>& results, std::string name, const char* unit, double value,
               std::string note = {}, std::vector<std::pair<std::string, double>> values = {}) {
  Figures figures;
  figures.median = value;
  results.push_back({std::move(name), unit, figures, {}, std::move(note), std::move(values)});
}

Status add_bone(std::vector<CaseResult>& results, const ContactSetting& setting,
                const std::shared_ptr<const anatomy::VirtualPatient>& patient) {
  haptics::PushTrial trial;
  trial.to_mm = kBone_mm + kPastBone_mm;
  TROCAR_TRY(const auto samples, push(setting, patient, trial));
  const haptics::BoneContact contact =
      haptics::judge_bone_contact(samples, trial, kBone_mm, setting.device.capability.peak_force_n);
  const std::string name = fmt::format("contact/bone/{}/{}", setting.device.name, to_string(setting.model));
  add_value(
      results, name, "n", contact.peak_n,
      fmt::format("peak; steady {:.2f} N, overshoot {:.0f} %, p-p at rest {:.3f} N{}", contact.steady_n,
                  100.0 * contact.overshoot, contact.chatter_n, contact.is_limited ? ", at the device's limit" : ""),
      {{"overshoot", contact.overshoot}, {"ripple_n", contact.chatter_n}});
  add_value(results, name + "/slope", "n_per_mm", contact.slope_n_per_mm);
  return {};
}

Status add_flavum(std::vector<CaseResult>& results, const ContactSetting& setting,
                  const std::shared_ptr<const anatomy::VirtualPatient>& patient, std::uint8_t layer) {
  haptics::PushTrial trial;
  trial.to_mm = kFlavum_mm + kPastFlavum_mm;
  TROCAR_TRY(const auto samples, push(setting, patient, trial));
  const haptics::LossOfResistance loss = haptics::judge_loss_of_resistance(samples, layer);
  const std::string name = fmt::format("contact/flavum/{}/{}", setting.device.name, to_string(setting.model));
  if (!loss.has_given_way) {
    add_value(results, name, "n", 0.0, "not punctured");
    return {};
  }
  add_value(results, name, "n", loss.peak_n, "peak on the device");
  add_value(results, name + "/drop", "n", loss.drop_n);
  add_value(results, name + "/drop-time", "ms", 1000.0 * loss.drop_time_s,
            fmt::format("10 to 90 %; lowest force {:.2f} N", loss.lowest_n));
  trial.is_rigid = true;
  TROCAR_TRY(const auto without_hand, push(setting, patient, trial));
  add_value(results, name + "/drop-time-model", "ms",
            1000.0 * haptics::judge_loss_of_resistance(without_hand, layer).drop_time_s, "the same, without a hand");
  add_value(results, name + "/jump", "mm", loss.jump_mm, "needle travel beyond the hand within 0.3 s");
  return {};
}

}  // namespace

Result<std::vector<CaseResult>> run_contact_benchmark(const Options& options) {
  TROCAR_TRY(const std::filesystem::path data, checked_data_dir());
  TROCAR_TRY(const anatomy::TissueTable table, anatomy::load_tissue_table(data / "tissues.toml"));
  TROCAR_TRY(auto devices, stylus::load_device_presets(data / "devices.toml"));
  std::erase_if(devices, [](const stylus::DevicePreset& device) { return !device.has_force(); });
  TROCAR_TRY(const auto bone, make_flat_patient({{0.0, "adipose"}, {10.0, "muscle"}, {kBone_mm, "bone"}}));
  TROCAR_TRY(const auto back, make_flat_patient({{0.0, "adipose"},
                                                 {10.0, "ligament"},
                                                 {kFlavum_mm, "ligamentum_flavum"},
                                                 {kFlavum_mm + kFlavumThickness_mm, "adipose"}}));
  const auto flavum = table.find_layer("ligamentum_flavum");
  if (!flavum) return fail("has no layer ligamentum_flavum", "tissue table", "add it");
  std::vector<CaseResult> results;
  for (const haptics::ForceModel model : kForceModels) {
    if (options.force_model && *options.force_model != model) continue;
    for (const stylus::DevicePreset& device : devices) {
      const ContactSetting setting{table, device, model, options.seed};
      TROCAR_TRY_STATUS(add_bone(results, setting, bone));
      TROCAR_TRY_STATUS(add_flavum(results, setting, back, *flavum));
    }
  }
  return results;
}

}  // namespace trocar::bench
