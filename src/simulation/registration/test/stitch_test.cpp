#include "registration/panorama/stitch.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/random.h"
#include "lab/registration/volume_series.h"

namespace trocar::registration {
namespace {

Result<PreparedVolume> prepared(const GeneratedVolume& volume, const std::string& name) {
  return prepare(name, volume.gray, *Beams::along_axis("+z", volume.gray.geometry));
}

std::vector<PreparedVolume> prepare_all(const std::vector<GeneratedVolume>& series) {
  std::vector<PreparedVolume> volumes;
  for (const GeneratedVolume& v : series) volumes.push_back(*prepared(v, "v" + std::to_string(volumes.size())));
  return volumes;
}

TargetError error_between(const std::vector<GeneratedVolume>& series, const Stitching& stitching, std::size_t a,
                          std::size_t b) {
  return target_error(series[a].gray.geometry, series[b].gray.geometry, series[a].X_WU.inverse() * series[b].X_WU,
                      stitching.X_0N[a]->inverse() * *stitching.X_0N[b]);
}

TEST(Stitch, AlignsHalfOverlappingVolumesDespiteSpeckle) {
  for (const bool is_varied : {false, true}) {
    SeriesOptions options;
    options.volumes = 3;
    options.has_varied_controls = is_varied;
    const auto series = make_volume_series(options, is_varied ? 21 : 20);
    const auto volumes = prepare_all(series);
    const Stitching stitching = *stitch(volumes);
    for (std::size_t n = 1; n < series.size(); ++n) {
      ASSERT_TRUE(stitching.X_0N[n]) << n;
      const TargetError error = error_between(series, stitching, n - 1, n);
      EXPECT_LT(error.mean_mm, 0.5) << n;
      EXPECT_LT(error.max_mm, 1.2) << n;
    }
  }
}

TEST(Stitch, RefusesForeignAndReflectedVolumes) {
  SeriesOptions options;
  options.volumes = 2;
  auto series = make_volume_series(options, 30);
  series.push_back(make_volume_series(options, 31).front());  // another scene
  GeneratedVolume mirrored = series[1];
  const auto& size = mirrored.gray.geometry.size;
  for (std::size_t n = 0; n < mirrored.gray.voxels.size(); ++n) {
    const volume::Index3 ijk = mirrored.gray.geometry.index_of(n);
    mirrored.gray.voxels[n] = series[1].gray[{size[0] - 1 - ijk[0], ijk[1], ijk[2]}];
  }
  series.push_back(mirrored);
  const Stitching stitching = *stitch(prepare_all(series));
  EXPECT_TRUE(stitching.X_0N[1]);
  EXPECT_FALSE(stitching.X_0N[2]);
  EXPECT_FALSE(stitching.X_0N[3]);
}

TEST(Prepare, RefusesVolumesWithoutAnImage) {
  GeneratedVolume plain;
  plain.gray.geometry.size = {32, 32, 32};
  for (const std::uint8_t level : {std::uint8_t{0}, std::uint8_t{90}}) {
    plain.gray.voxels.assign(plain.gray.geometry.voxel_count(), level);
    const auto result = prepared(plain, "plain");
    ASSERT_FALSE(result);
    EXPECT_EQ(result.error().exit_status, 1);
    EXPECT_NE(result.error().text().find("plain"), std::string::npos);
  }
}

Pose draw_pose(Random& random) {
  return {Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
              .normalized()
              .toRotationMatrix(),
          Vec3(random.uniform(-80, 80), random.uniform(-80, 80), random.uniform(-80, 80))};
}

/// A ring of poses with exact edges to the next two.
struct Ring {
  std::vector<Pose> X_0N{Pose()};
  std::vector<PoseEdge> edges;
  explicit Ring(std::size_t nodes) {
    Random random(5);
    while (X_0N.size() < nodes) X_0N.push_back(draw_pose(random));
    for (std::size_t a = 0; a < nodes; ++a) {
      for (const std::size_t step : {std::size_t{1}, std::size_t{2}}) {
        PoseEdge edge;
        edge.a = a;
        edge.b = (a + step) % nodes;
        edge.X_AB = X_0N[edge.a].inverse() * X_0N[edge.b];
        edges.push_back(edge);
      }
    }
  }
};

TEST(PoseGraph, RecoversExactPoses) {
  const Ring ring(6);
  const PoseGraph graph = solve_pose_graph(6, ring.edges);
  EXPECT_TRUE(graph.removed.empty());
  for (std::size_t n = 0; n < 6; ++n) {
    ASSERT_TRUE(graph.X_0N[n]);
    EXPECT_LT((graph.X_0N[n]->p() - ring.X_0N[n].p()).norm(), 1e-6);
  }
}

TEST(PoseGraph, RemovesAnEdgeThatContradictsTheLoops) {
  Ring ring(6);
  ring.edges[3].X_AB = ring.edges[3].X_AB * Pose::translation({0, 25, 0});
  const PoseGraph graph = solve_pose_graph(6, ring.edges);
  ASSERT_EQ(graph.removed.size(), 1U);
  EXPECT_EQ(graph.removed[0], 3U);
  for (std::size_t n = 0; n < 6; ++n) EXPECT_LT((graph.X_0N[n]->p() - ring.X_0N[n].p()).norm(), 1e-5);
}

TEST(PoseGraph, SpreadsAnErrorOverALoop) {
  Ring ring(3);
  ring.edges.resize(5);
  std::vector<PoseEdge> loop = {ring.edges[0], ring.edges[2], ring.edges[4]};             // 0-1, 1-2, 2-0
  for (PoseEdge& edge : loop) edge.information.diagonal().head<3>().setConstant(1600.0);  // a rotation at 40 mm
  loop[1].X_AB = loop[1].X_AB * Pose::translation({0.3, 0, 0});
  const PoseGraph graph = solve_pose_graph(3, loop);
  for (const double contradiction_mm : graph.contradiction_mm) EXPECT_LT(contradiction_mm, 0.2);
  EXPECT_TRUE(graph.removed.empty());
}

TEST(PoseGraph, LeavesUnconnectedNodesWithoutAPose) {
  const Ring ring(4);
  const std::vector<PoseEdge> one = {ring.edges[0]};
  const PoseGraph graph = solve_pose_graph(4, one);
  EXPECT_TRUE(graph.X_0N[1]);
  EXPECT_FALSE(graph.X_0N[2]);
  EXPECT_FALSE(graph.X_0N[3]);
}

TEST(Blend, KeepsASingleVolumeAndPreservesSpeckle) {
  SeriesOptions options;
  options.volumes = 2;
  options.has_shadows = false;
  const auto series = make_volume_series(options, 40);
  const auto volumes = prepare_all(series);
  const Pose X_01 = series[0].X_WU.inverse() * series[1].X_WU;
  const Panorama alone = *blend({{volumes.data(), Pose()}});
  for (std::size_t n = 0; n < alone.gray.voxels.size(); ++n) {
    if (alone.source.voxels[n] == 0) continue;
    EXPECT_NEAR(alone.gray.voxels[n], std::max<int>(1, series[0].gray.voxels[n]), 1) << n;
  }
  const Panorama both = *blend({{&volumes[0], Pose()}, {&volumes[1], X_01}});
  EXPECT_GT(both.gray.geometry.size[0], alone.gray.geometry.size[0] + 30);
  // Deviation of speckle: in the overlap as in the first volume alone, within a fifth.
  const auto deviation = [&](const volume::LabelGrid& gray, double low_x, double high_x) {
    double sum = 0.0, squares = 0.0, count = 0.0;
    for (std::size_t n = 0; n < gray.voxels.size(); ++n) {
      const Vec3 p = gray.geometry.centre_mm(gray.geometry.index_of(n));
      if (gray.voxels[n] == 0 || p.x() < low_x || p.x() > high_x || (p.array() < 10).any() ||
          (p.tail<2>().array() > 85).any())
        continue;
      sum += gray.voxels[n];
      squares += static_cast<double>(gray.voxels[n]) * gray.voxels[n];
      count += 1.0;
    }
    return std::sqrt(squares / count - sum * sum / count / count);
  };
  EXPECT_NEAR(deviation(both.gray, 60, 85) / deviation(alone.gray, 60, 85), 1.0, 0.2);
}

TEST(Blend, MatchesTheGainOfTheFirstVolume) {
  SeriesOptions options;
  options.volumes = 2;
  options.has_shadows = false;
  auto series = make_volume_series(options, 41);
  for (std::uint8_t& g : series[1].gray.voxels) g = static_cast<std::uint8_t>(std::min(255, g + 40));
  const auto volumes = prepare_all(series);
  const Panorama both = *blend({{&volumes[0], Pose()}, {&volumes[1], series[0].X_WU.inverse() * series[1].X_WU}});
  double own = 0.0, own_count = 0.0, other = 0.0, other_count = 0.0;
  for (std::size_t n = 0; n < both.gray.voxels.size(); ++n) {
    if (both.source.voxels[n] == 1) own += both.gray.voxels[n], own_count += 1.0;
    if (both.source.voxels[n] == 2) other += both.gray.voxels[n], other_count += 1.0;
  }
  EXPECT_NEAR(own / own_count, other / other_count, 8.0);
}

}  // namespace
}  // namespace trocar::registration
