#include "ultrasound/tissue/acoustic_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

#include "make_block.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

std::shared_ptr<const AcousticScene> make_block_scene(const anatomy::VirtualPatient& patient, double spacing_mm = 1.0) {
  auto scene = make_acoustic_scene(patient, make_block_table(), {.spacing_mm = spacing_mm});
  EXPECT_TRUE(scene.has_value()) << scene.error().text();
  return *scene;
}

Vec3 voxel_place(const AcousticScene& scene, std::size_t n) {
  const volume::Index3 ijk = scene.geometry.index_of(n);
  return scene.geometry.centre_mm(ijk);
}

std::string tissue_name(const AcousticScene& scene, std::size_t n) {
  return scene.table.tissues[scene.tissue[n] & 0x7F].name;
}

std::size_t nearest(const AcousticScene& scene, const Vec3& p_P) {
  const Vec3 index = scene.geometry.to_index(p_P);
  return scene.geometry.offset({std::llround(index.x()), std::llround(index.y()), std::llround(index.z())});
}
std::string tissue_at(const AcousticScene& scene, const Vec3& p_P) {
  return tissue_name(scene, nearest(scene, p_P));
}
double texture_hu_at(const AcousticScene& scene, const Vec3& p_P) {
  return kTextureStep_hu * scene.texture[nearest(scene, p_P)];
}

/// Greatest distance from a plane at which a voxel still lies on its wrong side, away from skin and faces.
double worst_side_mm(const AcousticScene& scene, const Vec3& normal, std::uint8_t below) {
  const auto code = *scene.table.find(below == kLiver ? "liver" : "kidney");
  const Vec3 middle_P(0.0, 25.0, 0.0);
  double worst_mm = 0.0;
  for (std::size_t n = 0; n < scene.tissue.size(); ++n) {
    const Vec3 p_P = voxel_place(scene, n);
    if (p_P.y() < 5.0 || p_P.y() > 44.0 || std::abs(p_P.z()) > 18.0 || std::abs(p_P.x()) > 22.0) continue;
    const double side_mm = normal.dot(p_P - middle_P);
    if (((scene.tissue[n] & 0x7F) == code) != (side_mm < 0.0)) worst_mm = std::max(worst_mm, std::abs(side_mm));
  }
  return worst_mm;
}

TEST(AcousticScene, SlantedBorderHasNoTerracesBetweenThickSlices) {
  for (const double slope_deg : {20.0, 35.0, 60.0}) {
    const double slope = radians(slope_deg);
    const Vec3 normal(std::sin(slope) * 0.8, std::sin(slope) * 0.6, std::cos(slope));
    const anatomy::VirtualPatient patient = make_block({56, 60, 60}, {0.7, 0.7, 5.0}, [&](const Vec3& p_P) {
      return BlockVoxel{normal.dot(p_P - Vec3(0, 25, 0)) < 0.0 ? kLiver : kKidney, 60};
    });
    // Slices as they are would be wrong by up to 2.5 mm cos(slope) (2.35 at 20 degrees); half a voxel of 0.7 mm in
    // plane and the votes' rounding remain.
    EXPECT_LT(worst_side_mm(*make_block_scene(patient), normal, kLiver), 0.8) << slope_deg;
  }
}

TEST(AcousticScene, BallKeepsItsVolumeAndShape) {
  const Vec3 middle_P(0.3, 24.2, 0.9);
  constexpr double kRadius_mm = 12.0;
  const anatomy::VirtualPatient patient = make_block({50, 60, 50}, {0.7, 0.7, 2.5}, [&](const Vec3& p_P) {
    return BlockVoxel{(p_P - middle_P).norm() < kRadius_mm ? kKidney : kLiver, 60};
  });
  const auto scene = make_block_scene(patient);
  const auto kidney = *scene->table.find("kidney");
  double volume_mm3 = 0.0;
  double worst_mm = 0.0;
  for (std::size_t n = 0; n < scene->tissue.size(); ++n) {
    const double side_mm = (voxel_place(*scene, n) - middle_P).norm() - kRadius_mm;
    const bool is_kidney = (scene->tissue[n] & 0x7F) == kidney;
    volume_mm3 += is_kidney ? scene->geometry.voxel_volume_mm3() : 0.0;
    if (is_kidney != (side_mm < 0.0)) worst_mm = std::max(worst_mm, std::abs(side_mm));
  }
  EXPECT_NEAR(volume_mm3, 4.0 / 3.0 * std::numbers::pi * std::pow(kRadius_mm, 3), 0.03 * volume_mm3);
  EXPECT_LT(worst_mm, 1.25);  // half a slice, at the poles
}

TEST(AcousticScene, WallOfOneVoxelHasNoHole) {
  for (const double turn_deg : {0.0, 13.0, 27.0, 45.0}) {
    const double turn = radians(turn_deg);
    const Vec3 normal(std::sin(turn), std::cos(turn), 0.0);
    const anatomy::VirtualPatient patient = make_block({50, 60, 40}, {0.7, 0.7, 2.5}, [&](const Vec3& p_P) {
      const double side_mm = normal.dot(p_P - Vec3(0, 22.1, 0));
      // As wide as a row of voxels that touch at their faces.
      const double half_mm = 0.35 * (std::abs(normal.x()) + std::abs(normal.y()));
      return BlockVoxel{std::abs(side_mm) <= half_mm ? kMuscle : side_mm < 0.0 ? kLiver : kLung, 0};
    });
    const auto scene = make_block_scene(patient);
    const auto liver = *scene->table.find("liver");
    const auto lung = *scene->table.find("lung");
    // No liver voxel touches a lung voxel at a face.
    const volume::Index3& size = scene->geometry.size;
    int touching = 0;
    for (std::size_t n = 0; n < scene->tissue.size(); ++n) {
      if ((scene->tissue[n] & 0x7F) != liver) continue;
      const volume::Index3 ijk = scene->geometry.index_of(n);
      if (ijk[0] < 2 || ijk[0] > size[0] - 3) continue;  // at the CT's edge nobody knows what is thin
      for (std::size_t a = 0; a < 2; ++a) {
        volume::Index3 next = ijk;
        if (++next[a] < size[a] && (scene->tissue[scene->geometry.offset(next)] & 0x7F) == lung) ++touching;
      }
    }
    EXPECT_EQ(touching, 0) << turn_deg;
  }
}

TEST(AcousticScene, ThinVesselsAndRibsStayConnected) {
  struct Tube {
    Vec3 direction;
    double diameter_mm;
  };
  for (const Tube& tube : {Tube{{0, 0, 1}, 2.0}, Tube{{0.5, 0, 1}, 2.5}, Tube{{0.6, 0.5, 1}, 3.0},
                           Tube{{1, 0.2, 0}, 3.0}, Tube{{1, 0, 0.3}, 3.0}}) {
    const Vec3 direction = tube.direction.normalized();
    const Vec3 through_P(0.2, 24.0, 0.3);
    const auto away_mm = [&](const Vec3& p_P) { return (p_P - through_P).cross(direction).norm(); };
    const anatomy::VirtualPatient patient = make_block({50, 60, 50}, {0.7, 0.7, 2.5}, [&](const Vec3& p_P) {
      return BlockVoxel{away_mm(p_P) < 0.5 * tube.diameter_mm ? kVessel : kLiver, 60};
    });
    const auto scene = make_block_scene(patient);
    const auto vessel = *scene->table.find("vessel");
    const auto is_near_vessel = [&](const Vec3& p_P) {
      for (int dz = -1; dz <= 1; ++dz) {
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            const Vec3 beside_P = p_P + 0.7 * Vec3(dx, dy, dz);
            if ((scene->tissue[nearest(*scene, beside_P)] & 0x7F) == vessel) return true;
          }
        }
      }
      return false;
    };
    double volume_mm3 = 0.0;
    for (std::size_t n = 0; n < scene->tissue.size(); ++n) {
      if ((scene->tissue[n] & 0x7F) == vessel && (voxel_place(*scene, n) - through_P).norm() < 15.0)
        volume_mm3 += scene->geometry.voxel_volume_mm3();
    }
    for (double along_mm = -15.0; along_mm <= 15.0; along_mm += 0.5)
      EXPECT_TRUE(is_near_vessel(through_P + along_mm * direction)) << direction.transpose() << " at " << along_mm;
    const double true_mm3 = 30.0 * 0.25 * std::numbers::pi * tube.diameter_mm * tube.diameter_mm;
    EXPECT_GT(volume_mm3, 0.6 * true_mm3) << direction.transpose();
    EXPECT_LT(volume_mm3, 1.5 * true_mm3) << direction.transpose();
  }
}

TEST(AcousticScene, SteepThinLayerStaysBetweenItsNeighbours) {
  // From one slice to the next (5 mm) the layer moves by 7 mm; in a slice it is 3 mm wide.
  const Vec3 normal = Vec3(5.0, 0.0, 7.0).normalized();
  const double half_mm = 1.5 * normal.x();
  const anatomy::VirtualPatient patient = make_block({60, 40, 60}, {0.7, 0.7, 5.0}, [&](const Vec3& p_P) {
    const double side_mm = normal.dot(p_P);
    return BlockVoxel{std::abs(side_mm) < half_mm ? kFat : side_mm < 0.0 ? kLiver : kKidney, 0};
  });
  const auto scene = make_block_scene(patient);
  const auto liver = *scene->table.find("liver");
  const auto fat = *scene->table.find("adipose");
  const auto kidney = *scene->table.find("kidney");
  int leaks = 0;
  for (std::size_t n = 0; n < scene->tissue.size(); ++n) {
    const Vec3 p_P = voxel_place(*scene, n);
    if (std::abs(p_P.z()) > 15.0 || p_P.y() < 4.0 || p_P.y() > 26.0 || std::abs(p_P.x()) > 26.0) continue;
    const auto own = scene->tissue[n] & 0x7F;
    const auto next = scene->tissue[n + 1] & 0x7F;
    leaks += (own == liver && next == kidney) || (own == kidney && next == liver);
    if (std::abs(normal.dot(p_P)) < 0.3) {
      EXPECT_EQ(own, fat) << p_P.transpose();
    }
  }
  EXPECT_EQ(leaks, 0);
}

TEST(AcousticScene, SkinIsAShellAndOutsideIsAir) {
  anatomy::VirtualPatient patient = make_block({30, 60, 30}, {1.0, 1.0, 2.0}, [](const Vec3&) {
    return BlockVoxel{kLiver, 60};
  });
  patient.labels[{3, 2, 3}] = kBone;  // outside the body: air all the same
  const auto scene = make_block_scene(patient);
  for (std::size_t n = 0; n < scene->tissue.size(); ++n) {
    const double depth_mm = voxel_place(*scene, n).y();
    EXPECT_EQ(tissue_name(*scene, n), depth_mm <= 0.0 ? "air" : depth_mm < 2.0 ? "skin" : "liver") << depth_mm;
  }
  const volume::FloatGrid& skin = scene->skin_distance_mm;
  const volume::Index3 voxel{7, 9, 8};
  EXPECT_NEAR(skin[voxel], -skin.geometry.to_mm(Vec3(7, 9, 8)).y(), 1e-4);
}

TEST(AcousticScene, IsCroppedToTheBodyAndItsMargin) {
  anatomy::VirtualPatient patient = make_block({120, 60, 120}, {1.0, 1.0, 2.0}, [](const Vec3&) {
    return BlockVoxel{kLiver, 60};
  });
  for (std::size_t n = 0; n < patient.labels.voxels.size(); ++n) {
    const volume::Index3 ijk = patient.labels.geometry.index_of(n);
    const Vec3 p_P = patient.labels.geometry.centre_mm(ijk);
    patient.skin_distance_mm.voxels[n] = static_cast<float>((p_P - Vec3(0, 24, 0)).norm() - 15.0);
  }
  const auto scene = make_block_scene(patient);
  EXPECT_NEAR(static_cast<double>(scene->geometry.size[0]), 70.0, 2.0);
  EXPECT_NEAR(static_cast<double>(scene->geometry.size[2]), 70.0, 4.0);
  EXPECT_LT((scene->geometry.spacing_mm - Vec3::Ones()).norm(), 1e-12);
  EXPECT_EQ(scene->tissue.size(), scene->geometry.voxel_count());
  EXPECT_EQ(scene->texture.size(), scene->geometry.voxel_count());
}

TEST(AcousticScene, GridIsNotMuchFinerThanTheCt) {
  const auto patient = make_block({60, 60, 60}, {3.0, 3.0, 3.0}, [](const Vec3&) { return BlockVoxel{kLiver, 60}; });
  EXPECT_DOUBLE_EQ(make_block_scene(patient)->geometry.spacing_mm.x(), 1.5);
  EXPECT_DOUBLE_EQ(make_block_scene(patient, 2.0)->geometry.spacing_mm.x(), 2.0);
}

TEST(AcousticScene, ClassifiesUnlabelledTissueAndBowelGasByHu) {
  const anatomy::VirtualPatient patient = make_block({60, 60, 40}, {1.0, 1.0, 2.0}, [](const Vec3& p_P) {
    if (p_P.z() > 0.0) return BlockVoxel{kBowel, static_cast<std::int16_t>(p_P.x() < 0.0 ? -900 : 30)};
    const int hu = p_P.x() < -15.0 ? -900 : p_P.x() < 0.0 ? -100 : p_P.x() < 15.0 ? 40 : 700;
    return BlockVoxel{0, static_cast<std::int16_t>(hu)};
  });
  const auto scene = make_block_scene(patient);
  EXPECT_EQ(tissue_at(*scene, {-22, 20, -10}), "gas");
  EXPECT_EQ(tissue_at(*scene, {-7, 20, -10}), "adipose");
  EXPECT_EQ(tissue_at(*scene, {7, 20, -10}), "soft_tissue");
  EXPECT_EQ(tissue_at(*scene, {22, 20, -10}), "bone");
  EXPECT_EQ(tissue_at(*scene, {-10, 20, 10}), "gas");
  EXPECT_EQ(tissue_at(*scene, {10, 20, 10}), "bowel");
  EXPECT_NEAR(texture_hu_at(*scene, {10, 20, 10}), 0.0, kTextureStep_hu);  // gas is not in its mean
}

TEST(AcousticScene, TextureShowsDeviationsWithoutNeighbourTissue) {
  const Vec3 lesion_P(-10.0, 24.0, 0.0);
  const anatomy::VirtualPatient patient = make_block({60, 60, 40}, {0.7, 0.7, 2.5}, [&](const Vec3& p_P) {
    if (p_P.x() > 0.0) return BlockVoxel{kLung, -800};
    return BlockVoxel{kLiver, static_cast<std::int16_t>((p_P - lesion_P).norm() < 5.0 ? 20 : 80)};
  });
  const auto scene = make_block_scene(patient);
  // The lesion is 3 % of the liver block: the mean is within 2 HU of 80.
  EXPECT_NEAR(texture_hu_at(*scene, lesion_P), -60.0, 5.0);
  EXPECT_NEAR(texture_hu_at(*scene, {-20, 24, 8}), 0.0, 3.0);
  for (double x_mm = -3.0; x_mm <= 3.0; x_mm += 0.25)
    EXPECT_NEAR(texture_hu_at(*scene, {x_mm, 40, 8}), 0.0, 3.0) << x_mm;
}

TEST(AcousticScene, TextureIsSmoothedByAboutItsSigma) {
  // A sharp step of HU within one tissue: from 16 to 84 % it takes two standard deviations.
  const anatomy::VirtualPatient patient = make_block({60, 60, 20}, {0.5, 0.5, 2.0}, [](const Vec3& p_P) {
    return BlockVoxel{kLiver, static_cast<std::int16_t>(p_P.x() < 0.0 ? 0 : 200)};
  });
  const auto scene = make_block_scene(patient, 0.5);
  const auto crossing_mm = [&](double hu) {
    double x_mm = -6.0;
    while (x_mm < 6.0 && texture_hu_at(*scene, {x_mm, 24, 0}) < hu) x_mm += 0.05;
    return x_mm;
  };
  EXPECT_NEAR(0.5 * (crossing_mm(68.0) - crossing_mm(-68.0)), 1.2, 0.3);  // the grid's step is 0.5 mm
}

TEST(AcousticScene, ThickAxisMayBeAnyOfTheThree) {
  const auto label = [](const Vec3& p_P) {
    return BlockVoxel{(p_P - Vec3(2, 24, 1)).norm() < 11.0 ? kKidney : kLiver, 60};
  };
  const auto thick_x = make_block_scene(make_block({50, 60, 50}, {5.0, 0.7, 0.7}, label));
  const auto thick_z = make_block_scene(make_block({50, 60, 50}, {0.7, 0.7, 5.0}, label));
  EXPECT_NEAR(thick_x->geometry.R_PV.determinant(), 1.0, 1e-12);
  int differing = 0;
  int kidney = 0;
  for (double z = -18; z <= 18; z += 1.5) {
    for (double y = 6; y <= 42; y += 1.5) {
      for (double x = -18; x <= 18; x += 1.5) {
        differing += tissue_at(*thick_x, {x, y, z}) != tissue_at(*thick_z, {x, y, z});
        kidney += tissue_at(*thick_z, {x, y, z}) == "kidney";
      }
    }
  }
  EXPECT_GT(kidney, 1000);
  EXPECT_LT(differing, kidney / 5);  // at the poles of the ball, which lie elsewhere
}

TEST(AcousticScene, MixedCellsContainTwoTissues) {
  AcousticScene scene;
  scene.geometry.size = {9, 7, 6};
  std::uint32_t state = 7;
  for (std::size_t n = 0; n < scene.geometry.voxel_count(); ++n) {
    state = state * 1664525U + 1013904223U;
    scene.tissue.push_back(static_cast<std::uint8_t>((state >> 24) < 16 ? 3 : 1) | (n % 5 == 0 ? kMixedCell : 0));
  }
  const std::vector<std::uint8_t> before = scene.tissue;
  mark_mixed_cells(scene);
  for (std::size_t n = 0; n < before.size(); ++n) {
    const volume::Index3 ijk = scene.geometry.index_of(n);
    bool is_mixed = false;
    for (int corner = 1; corner < 8; ++corner) {
      volume::Index3 at = ijk;
      for (std::size_t a = 0; a < 3; ++a) at[a] = std::min(at[a] + ((corner >> a) & 1), scene.geometry.size[a] - 1);
      is_mixed |= (before[scene.geometry.offset(at)] & 0x7F) != (before[n] & 0x7F);
    }
    EXPECT_EQ(scene.tissue[n], (before[n] & 0x7F) | (is_mixed ? kMixedCell : 0));
  }
}

TEST(AcousticScene, NamesATissueMissingInTheTable) {
  const auto patient = make_block({20, 30, 20}, {1, 1, 2}, [](const Vec3&) { return BlockVoxel{kLiver, 60}; });
  AcousticTable table = make_block_table();
  std::erase_if(table.tissues, [](const AcousticTissue& tissue) { return tissue.name == "kidney"; });
  const auto scene = make_acoustic_scene(patient, table);
  ASSERT_FALSE(scene.has_value());
  EXPECT_NE(scene.error().text().find("\"kidney\""), std::string::npos) << scene.error().text();
  EXPECT_NE(scene.error().text().find("the kidney"), std::string::npos) << scene.error().text();

  table.tissues.resize(128);
  EXPECT_FALSE(make_acoustic_scene(patient, table).has_value());
}

TEST(AcousticScene, RefusesAPatientWithoutSkin) {
  auto patient = make_block({20, 30, 20}, {1, 1, 2}, [](const Vec3&) { return BlockVoxel{kLiver, 60}; });
  for (float& distance_mm : patient.skin_distance_mm.voxels) distance_mm = 1.0F;
  EXPECT_FALSE(make_acoustic_scene(patient, make_block_table()).has_value());
  EXPECT_FALSE(make_acoustic_scene(anatomy::VirtualPatient{}, make_block_table()).has_value());
}

}  // namespace
}  // namespace trocar::ultrasound
