#include "server/scene_builder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <new>

#include "anatomy/tissue/tissue_settings.h"
#include "server/test/servo_rig.h"
#include "stylus/device_preset.h"

namespace trocar::server {
namespace {

using testing::data_file;
using testing::device_preset;
using testing::layered_opener;
using testing::layered_request;

/// One number of a tissue as a message, and a message without any.
link::SetParameters tissue(const char* text) {
  const anatomy::TissueSetting setting = anatomy::parse_setting(text).value();
  link::TissueSetting sent{setting.row, setting.key, setting.value};
  if (std::isinf(setting.value)) sent.value.reset();
  return {.tissues = std::vector{sent}};
}
const link::SetParameters kAsLoaded{.tissues = std::vector<link::TissueSetting>()};

SceneBuilder make_builder(const char* device = "premium") {
  return {layered_opener(), data_file("tissues.toml"), device_preset(device)};
}

TEST(SceneBuilder, BuildsTheRequestedScene) {
  SceneBuilder builder = make_builder();
  const auto scene = builder.load(layered_request("proxy"));
  ASSERT_TRUE(scene) << scene.error().text();
  EXPECT_EQ(scene->scene->options.force_model, haptics::ForceModel::kProxy);
  EXPECT_FALSE(scene->continues);
  EXPECT_LT((scene->scene->gravity_P - Vec3::UnitZ()).norm(), 1e-12) << "down in the room is into the layers";
}

TEST(SceneBuilder, ReportsErrorsAndKeepsTheLastScene) {
  SceneBuilder builder = make_builder();
  EXPECT_FALSE(builder.change(tissue("liver.k=0.5"))) << "there is none yet";
  ASSERT_TRUE(builder.load(layered_request()));
  for (const auto& spoil : std::vector<std::function<void(link::LoadScene&)>>{
           [](link::LoadScene& r) { r.patient = "nobody"; }, [](link::LoadScene& r) { r.tool = "spoon"; },
           [](link::LoadScene& r) { r.force_model = "magic"; }, [](link::LoadScene& r) { r.tissues_toml = "[tissues"; },
           [](link::LoadScene& r) { r.needle_radius_mm = 9.0; },
           [](link::LoadScene& r) { r.patient_hash = "another"; }}) {
    link::LoadScene request = layered_request();
    spoil(request);
    const auto scene = builder.load(request);
    ASSERT_FALSE(scene);
    EXPECT_FALSE(scene.error().what.empty());
  }
  EXPECT_EQ(builder.request().patient, "layers");
  EXPECT_TRUE(builder.change(tissue("liver.k=0.5")));
}

TEST(SceneBuilder, StopsBetweenStepsAndKeepsTheLastScene) {
  std::stop_source source;
  bool is_stopping = false;
  const PatientOpener opener = [&](const std::string& name, std::uint64_t seed, const Progress& progress) {
    if (is_stopping) source.request_stop();
    return layered_opener()(name, seed, progress);
  };
  SceneBuilder builder(opener, data_file("tissues.toml"), device_preset("premium"));
  ASSERT_TRUE(builder.load(layered_request(), {}, source.get_token()));
  is_stopping = true;
  link::LoadScene other = layered_request("proxy");
  other.patient_seed = 2;
  const auto stopped = builder.load(other, {}, source.get_token());
  ASSERT_FALSE(stopped);
  EXPECT_NE(stopped.error().what.find("stopped"), std::string::npos);
  EXPECT_EQ(builder.request().patient_seed, layered_request().patient_seed);
}

TEST(SceneBuilder, RefusesAPatientThatExceedsMemory) {
  bool is_short = false;
  const PatientOpener opener = [&](const std::string& name, std::uint64_t seed, const Progress& progress) {
    if (is_short) throw std::bad_alloc();
    return layered_opener()(name, seed, progress);
  };
  SceneBuilder builder(opener, data_file("tissues.toml"), device_preset("premium"));
  ASSERT_TRUE(builder.load(layered_request()));
  is_short = true;
  link::LoadScene other = layered_request();
  other.patient_seed = 2;
  const auto refused = builder.load(other);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().what.find("not enough memory"), std::string::npos);
  EXPECT_TRUE(builder.change(tissue("liver.k=0.5"))) << "the last scene is still there";
}

TEST(SceneBuilder, ReplacesTheLoadedTable) {
  SceneBuilder builder = make_builder();
  ASSERT_TRUE(builder.load(layered_request()));
  anatomy::TissueTable other = builder.tissues();
  ASSERT_TRUE(anatomy::apply_override(other, "skin.fp=6"));
  link::SetParameters replaced = tissue("liver.mu=0.2");
  replaced.tissues_toml = other.to_toml();
  ASSERT_TRUE(builder.change(replaced));
  EXPECT_EQ(builder.tissues().layers[*other.find_layer("skin")].puncture_force_n, 6.0);
  ASSERT_TRUE(builder.change(kAsLoaded));
  EXPECT_EQ(builder.tissues().to_toml(), other.to_toml());
  EXPECT_FALSE(builder.change({.tissues_toml = "[tissues"}));
}

TEST(SceneBuilder, ChangesAllNumbersOrNone) {
  SceneBuilder builder = make_builder();
  const auto before = builder.load(layered_request());
  ASSERT_TRUE(before);
  link::SetParameters half = tissue("liver.nonsense=1");
  half.coupling_stiffness_n_per_mm = 0.5;
  EXPECT_FALSE(builder.change(half));
  const auto after = builder.change(tissue("liver.mu=0.2"));
  ASSERT_TRUE(after) << after.error().text();
  EXPECT_TRUE(after->continues);
  EXPECT_GT(after->number, before->number);
  EXPECT_EQ(after->scene->options.coupling.stiffness_n_per_mm, before->scene->options.coupling.stiffness_n_per_mm);
  EXPECT_FALSE(builder.change(tissue("liver.mu=1e9")));
  EXPECT_FALSE(builder.change(tissue("liver.mu=never")));
  EXPECT_FALSE(builder.change({.force_model = "none"}));
  EXPECT_FALSE(builder.change({.coupling_stiffness_n_per_mm = std::numeric_limits<double>::quiet_NaN()}));
}

TEST(SceneBuilder, NewTissueNumbersReplaceEarlierChanges) {
  SceneBuilder builder = make_builder();
  const auto loaded = builder.load(layered_request());
  ASSERT_TRUE(loaded);
  const anatomy::TissueTable table = anatomy::load_tissue_table(data_file("tissues.toml")).value();
  const std::uint8_t liver = *table.find_tissue("liver"), capsule = *table.find_layer("liver_capsule");
  const auto cutting_n = [&](const auto& scene) { return scene->scene->tissues[liver].cutting_n; };
  const auto fp_n = [&](const auto& scene) { return scene->scene->layers[capsule].puncture_force_n; };
  EXPECT_EQ(cutting_n(builder.change(tissue("liver.fc=2"))), 2.0);
  EXPECT_EQ(cutting_n(builder.change({.coupling_stiffness_n_per_mm = 0.5})), 2.0) << "names no tissue";
  const auto other = builder.change(tissue("liver.fp=3"));
  EXPECT_EQ(fp_n(other), 3.0);
  EXPECT_EQ(cutting_n(other), cutting_n(loaded)) << "is not named any more";
  EXPECT_FALSE(builder.change(tissue("liver.fc=99")));
  EXPECT_EQ(fp_n(builder.change({.has_bending = true})), 3.0) << "a refused change changes nothing";
  const auto reset = builder.change(kAsLoaded);
  ASSERT_TRUE(reset);
  EXPECT_EQ(fp_n(reset), fp_n(loaded));
}

TEST(SceneBuilder, RestartsWithAnotherForceModel) {
  SceneBuilder builder = make_builder();
  ASSERT_TRUE(builder.load(layered_request()));
  const auto scene = builder.change({.force_model = "combined"});
  ASSERT_TRUE(scene);
  EXPECT_FALSE(scene->continues);
}

TEST(SceneBuilder, ClipsTheCouplingToTheScaledDeviceLimit) {
  stylus::DevicePreset preset = device_preset("premium");
  preset.motion_scale = 5.0;
  SceneBuilder builder(layered_opener(), data_file("tissues.toml"), preset);
  const auto scene = builder.load(layered_request());
  ASSERT_TRUE(scene) << scene.error().text();
  const double most = preset.capability.max_stiffness_n_per_mm / 5.0;
  EXPECT_LE(scene->scene->options.coupling.stiffness_n_per_mm, most + 1e-12);
}

TEST(SceneBuilder, RefusesACouplingBeyondTheDeviceLimits) {
  for (const char* device : {"premium", "omni", "omega7", "falcon", "mouse"}) {
    const stylus::DevicePreset preset = device_preset(device);
    SceneBuilder builder = make_builder(device);
    const auto before = builder.load(layered_request());
    ASSERT_TRUE(before) << before.error().text();
    const auto expect_refused = [&](const link::SetParameters& bad, const char* name) {
      const auto scene = builder.change(bad);
      ASSERT_FALSE(scene) << device;
      const std::string text = scene.error().text();
      EXPECT_NE(text.find(name), std::string::npos) << text;
      EXPECT_NE(text.find("give a number from"), std::string::npos) << text;
      EXPECT_EQ(text.find('\n'), std::string::npos);
    };
    for (const double damping : {1.0, 0.2, -0.001})
      expect_refused({.coupling_damping_ns_per_mm = damping}, "coupling.damp");
    for (const double stiffness : {19.0, 0.001, -1.0})
      expect_refused({.coupling_stiffness_n_per_mm = stiffness}, "coupling.stiff");
    const stylus::CouplingLimits limits = stylus::limits_of(preset);
    EXPECT_TRUE(builder.change({.coupling_stiffness_n_per_mm = limits.most_n_per_mm})) << device;
    EXPECT_FALSE(builder.change({.coupling_stiffness_n_per_mm = 1.01 * limits.most_n_per_mm})) << device;
    EXPECT_TRUE(builder.change({.coupling_damping_ns_per_mm = limits.most_ns_per_mm})) << device;
    EXPECT_FALSE(builder.change({.coupling_damping_ns_per_mm = 1.01 * limits.most_ns_per_mm})) << device;
  }
}

TEST(SceneBuilder, OpensAPatientOnceForManyScenes) {
  int opened = 0;
  const auto counting = [&](const std::string& name, std::uint64_t seed, const Progress& progress) {
    ++opened;
    return layered_opener()(name, seed, progress);
  };
  SceneBuilder builder(counting, data_file("tissues.toml"), device_preset());
  ASSERT_TRUE(builder.load(layered_request()));
  ASSERT_TRUE(builder.load(layered_request("proxy")));
  EXPECT_EQ(opened, 1);
}

}  // namespace
}  // namespace trocar::server
