#include "cases/later_data.h"

#include <gtest/gtest.h>

#include <set>
#include <thread>

#include "core/files/folders.h"
#include "core/testing/no_threads.h"
#include "io/patient/patient_cache.h"
#include "io/patient/patient_folder.h"
#include "phantom/phantom.h"
#include "surface/extract_surface.h"

namespace trocar::cases {
namespace {

std::shared_ptr<const anatomy::VirtualPatient> coarse() {
  auto patient = phantom::generate_phantom("abdomen", 3, {{60, 48, 48}});
  EXPECT_TRUE(patient) << patient.error().text();
  return std::make_shared<const anatomy::VirtualPatient>(*std::move(patient));
}

ultrasound::AcousticTable acoustics() {
  auto table = ultrasound::load_acoustic_table(data_dir() / "acoustics.toml");
  EXPECT_TRUE(table) << table.error().text();
  return *std::move(table);
}

std::set<std::string> names_of(const LaterData& later) {
  std::set<std::string> names;
  for (const auto& group : later.surfaces_after(0))
    for (const anatomy::NamedMesh& mesh : *group) names.insert(mesh.name);
  return names;
}

TEST(LaterData, DeliversTheSceneAndEverySurface) {
  const auto patient = coarse();
  const LaterData later(patient, acoustics(), {"abdomen", 3});
  later.wait();
  ASSERT_TRUE(later.acoustic());
  EXPECT_TRUE(later.errors().empty());
  std::set<std::string> expected;
  for (const anatomy::NamedMesh& mesh : surface::extract_surfaces(*patient)) expected.insert(mesh.name);
  EXPECT_EQ(names_of(later), expected);
  const auto groups = later.surfaces_after(0);
  ASSERT_EQ(groups.size(), expected.size());
  EXPECT_EQ(groups.front()->front().name, "skin");
  EXPECT_EQ(later.surfaces_after(groups.size() - 1).size(), 1u);
  EXPECT_TRUE(later.surfaces_after(groups.size() + 5).empty());
}

/// A task under fluoroscopy or palpation does not wait for an acoustic scene that it does not use.
TEST(LaterData, BuildsWhatTheTaskNeedsFirst) {
  const auto patient = coarse();
  const LaterData for_xray(patient, acoustics(), {"abdomen", 3}, LaterData::First::kSurfaces);
  while (!for_xray.acoustic()) std::this_thread::yield();
  EXPECT_EQ(for_xray.surfaces_after(0).size(), surface::extract_surfaces(*patient).size());
  const LaterData for_ultrasound(patient, acoustics(), {"abdomen", 3});
  while (for_ultrasound.surfaces_after(0).empty()) std::this_thread::yield();
  EXPECT_TRUE(for_ultrasound.acoustic());
}

TEST(LaterData, CachesSurfaces) {
  const TemporaryFolder folder;
  const auto patient = coarse();
  const io::PatientSource source{"abdomen", 3, folder / "patients"};
  const auto kept = io::PatientCache(source.cache_folder).keep(source, *patient);
  ASSERT_TRUE(kept) << kept.error().text();
  const LaterData first(patient, acoustics(), source);
  first.wait();
  const auto meshes = io::load_patient_meshes(*kept);
  ASSERT_TRUE(meshes) << meshes.error().text();
  const auto extracted = surface::extract_surfaces(*patient);
  ASSERT_EQ(meshes->size(), extracted.size());
  for (std::size_t n = 0; n < extracted.size(); ++n) {
    EXPECT_EQ((*meshes)[n].name, extracted[n].name) << "in the order of the labels";
    EXPECT_EQ((*meshes)[n].mesh_P.triangles, extracted[n].mesh_P.triangles);
  }
  const LaterData second(patient, acoustics(), source);
  second.wait();
  EXPECT_EQ(second.surfaces_after(0).size(), 1u) << "one group, read from the cache";
  EXPECT_EQ(names_of(second), names_of(first));
}

TEST(LaterData, CancelledRunCachesNothingIncomplete) {
  const TemporaryFolder folder;
  const auto patient = coarse();
  const io::PatientSource source{"abdomen", 3, folder / "patients"};
  const auto kept = io::PatientCache(source.cache_folder).keep(source, *patient);
  ASSERT_TRUE(kept) << kept.error().text();
  LaterData later(patient, acoustics(), source);
  later.cancel();
  later.wait();
  const auto meshes = io::load_patient_meshes(*kept);
  ASSERT_TRUE(meshes) << meshes.error().text();
  const std::size_t all = surface::extract_surfaces(*patient).size();
  EXPECT_TRUE(meshes->empty() || meshes->size() == all) << meshes->size();
}

TEST(LaterData, ReportsWhyAnImageIsMissing) {
  ultrasound::AcousticTable none;
  const LaterData later(coarse(), std::move(none), {"abdomen", 3});
  later.wait();
  EXPECT_FALSE(later.acoustic());
  ASSERT_EQ(later.errors().size(), 1u);
  EXPECT_NE(later.errors().front().find("acoustic table"), std::string::npos);
  EXPECT_FALSE(later.surfaces_after(0).empty());
}

TEST(LaterData, ReportsAMissingThreadAndFinishesWithoutImages) {
  const testing::NoThreads none;
  const LaterData later(coarse(), acoustics(), {"abdomen", 3});
  later.wait();
  EXPECT_TRUE(later.view().is_done);
  EXPECT_FALSE(later.acoustic());
  ASSERT_EQ(later.errors().size(), 1u);
  EXPECT_NE(later.errors().front().find("does not start"), std::string::npos);
}

}  // namespace
}  // namespace trocar::cases
