#include "io/patient/patient_cache.h"

#include <gtest/gtest.h>

#include <fstream>

#include "core/files/folders.h"
#include "core/testing/data_folder.h"
#include "io/patient/patient_folder.h"
#include "phantom/phantom.h"

namespace trocar::io {
namespace {
namespace fs = std::filesystem;

/// An embedded patient, coarse enough for a test.
anatomy::VirtualPatient coarse(std::uint64_t seed) {
  auto patient = phantom::generate_phantom("abdomen", seed, {{40, 32, 36}});
  EXPECT_TRUE(patient) << patient.error().text();
  return *std::move(patient);
}

std::size_t entries_in(const fs::path& folder) {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(PatientCache, FindsOnlyStoredPatients) {
  const TemporaryFolder folder;
  const PatientCache cache(folder / "patients");
  EXPECT_FALSE(cache.find({"abdomen", 3}));
  const anatomy::VirtualPatient patient = coarse(3);
  const auto kept = cache.keep({"abdomen", 3}, patient);
  ASSERT_TRUE(kept) << kept.error().text();
  EXPECT_EQ(cache.find({"abdomen", 3}), *kept);
  const auto meshes = load_patient_meshes(*kept);
  ASSERT_TRUE(meshes) << meshes.error().text();
  EXPECT_TRUE(meshes->empty());
  EXPECT_FALSE(cache.find({"abdomen", 4}));
  EXPECT_FALSE(cache.find({"lumbar", 3}));
  const auto loaded = load_patient(*kept);
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_EQ(loaded->content_hash, patient.content_hash);
}

TEST(PatientCache, MissesAfterADataFileChange) {
  const TemporaryFolder folder;
  const PatientCache cache(folder / "patients");
  ASSERT_TRUE(cache.keep({"abdomen", 3}, coarse(3)));
  {
    const trocar::testing::OwnDataFolder own;
    EXPECT_TRUE(cache.find({"abdomen", 3})) << "the same bytes in another folder";
    own.change("phantoms/abdomen.toml", "[liver]", "# changed\n[liver]");
    EXPECT_FALSE(cache.find({"abdomen", 3}));
  }
  EXPECT_TRUE(cache.find({"abdomen", 3}));
}

TEST(PatientCache, ReturnsThePatientAsSaved) {
  const TemporaryFolder folder;
  anatomy::VirtualPatient patient = coarse(3);
  const auto kept = PatientCache(folder / "patients").keep({"abdomen", 3}, patient);
  ASSERT_TRUE(kept) << kept.error().text();
  const auto loaded = load_patient(*kept);
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_NE(loaded->skin_distance_mm.voxels, patient.skin_distance_mm.voxels);
  round_as_saved(patient);
  EXPECT_EQ(loaded->skin_distance_mm.voxels, patient.skin_distance_mm.voxels);
  EXPECT_EQ(loaded->ct.voxels, patient.ct.voxels);
  for (const auto& [kept_grid, made_grid] :
       {std::pair(&loaded->ct.geometry, &patient.ct.geometry),
        std::pair(&loaded->labels.geometry, &patient.labels.geometry),
        std::pair(&loaded->skin_distance_mm.geometry, &patient.skin_distance_mm.geometry)}) {
    EXPECT_EQ(kept_grid->spacing_mm, made_grid->spacing_mm);
    EXPECT_EQ(kept_grid->origin_P, made_grid->origin_P);
    EXPECT_EQ(kept_grid->R_PV, made_grid->R_PV);
  }
  EXPECT_EQ(loaded->labels.voxels, patient.labels.voxels);
}

TEST(PatientCache, AddsSurfacesToAnEntryLater) {
  const TemporaryFolder folder;
  const PatientCache cache(folder / "patients");
  const anatomy::VirtualPatient patient = coarse(3);
  const TriangleMesh triangle{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  EXPECT_FALSE(cache.keep_surfaces({"abdomen", 3}, {{"skin", triangle}})) << "there is no entry";
  const auto kept = cache.keep({"abdomen", 3}, patient);
  ASSERT_TRUE(kept) << kept.error().text();
  ASSERT_TRUE(cache.keep_surfaces({"abdomen", 3}, {{"skin", triangle}}));
  EXPECT_EQ(cache.find({"abdomen", 3}), *kept);
  const auto meshes = load_patient_meshes(*kept);
  ASSERT_TRUE(meshes) << meshes.error().text();
  ASSERT_EQ(meshes->size(), 1u);
  EXPECT_EQ(meshes->front().mesh_P.triangles, triangle.triangles);
  const auto loaded = load_patient(*kept);
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_EQ(loaded->content_hash, patient.content_hash);
}

TEST(PatientCache, SecondWriterReusesTheEntryOfTheFirst) {
  const TemporaryFolder folder;
  const PatientCache cache(folder / "patients");
  const anatomy::VirtualPatient patient = coarse(3);
  const auto first = cache.keep({"abdomen", 3}, patient);
  ASSERT_TRUE(first) << first.error().text();
  const auto second = cache.keep({"abdomen", 3}, patient);
  ASSERT_TRUE(second) << second.error().text();
  EXPECT_EQ(*second, *first);
}

TEST(PatientCache, EvictsLeastRecentlyUsedEntries) {
  const TemporaryFolder folder;
  const PatientCache cache(folder / "patients");
  const anatomy::VirtualPatient patient = coarse(1);
  const auto set_age = [&](std::uint64_t seed, int hours) {
    const auto entry = cache.find({"abdomen", seed});
    ASSERT_TRUE(entry);
    fs::last_write_time(*entry, fs::file_time_type::clock::now() - std::chrono::hours(hours));
  };
  for (std::uint64_t seed = 1; seed <= PatientCache::kMostKept; ++seed) {
    ASSERT_TRUE(cache.keep({"abdomen", seed}, patient));
    set_age(seed, 100 - static_cast<int>(seed));
  }
  ASSERT_TRUE(cache.find({"abdomen", 1}));  // the oldest is used again
  ASSERT_TRUE(cache.keep({"abdomen", 99}, patient));
  EXPECT_EQ(entries_in(folder / "patients"), PatientCache::kMostKept);
  EXPECT_TRUE(cache.find({"abdomen", 1}));
  EXPECT_FALSE(cache.find({"abdomen", 2}));
  EXPECT_TRUE(cache.find({"abdomen", 99}));
}

TEST(PatientCache, FoldersOfTheUserAreNotCached) {
  const TemporaryFolder folder;
  const PatientCache cache(folder / "patients");
  EXPECT_FALSE(cache.keep({folder.path().string(), 1}, coarse(1)));
  EXPECT_FALSE(PatientCache({}).keep({"abdomen", 1}, coarse(1)));
  EXPECT_FALSE(fs::exists(folder / "patients"));
}

TEST(PatientCache, DropsADamagedEntry) {
  const TemporaryFolder folder;
  const PatientCache cache(folder / "patients");
  const auto kept = cache.keep({"abdomen", 3}, coarse(3));
  ASSERT_TRUE(kept) << kept.error().text();
  std::ofstream(*kept / "ct.nrrd") << "damaged";
  EXPECT_FALSE(load_patient(*kept));
  cache.forget({"abdomen", 3});
  EXPECT_FALSE(cache.find({"abdomen", 3}));
}

}  // namespace
}  // namespace trocar::io
