#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "ultrasound/sweep/tracked_sequence.h"

namespace trocar::ultrasound {
namespace {

using GraphMatrix = TransformGraph::Matrix4;

GraphMatrix moved_matrix(double angle_rad, double x, double y, double z, double scale = 1.0) {
  Eigen::Affine3d affine = Eigen::Affine3d::Identity();
  affine.translate(Eigen::Vector3d(x, y, z))
      .rotate(Eigen::AngleAxisd(angle_rad, Eigen::Vector3d(1, 2, 3).normalized()));
  affine.scale(scale);
  return affine.matrix();
}

TEST(TransformGraph, ChainsForwardAndInverseTransforms) {
  const GraphMatrix probe = moved_matrix(0.3, 1, 2, 3), reference = moved_matrix(-0.7, 4, 5, 6),
                    image = moved_matrix(0.1, 7, 8, 9, 0.08);
  TransformGraph graph;
  graph.add({{"ImageToProbe", image}});
  graph.add({{"ProbeToTracker", probe}, {"ReferenceToTracker", reference}, {"StylusToTracker", probe}});
  const auto found = graph.find("Image", "Reference");
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->isApprox(reference.inverse() * probe * image, 1e-12));
  EXPECT_TRUE(graph.find("Reference", "Image")->isApprox(found->inverse(), 1e-9));
}

TEST(TransformGraph, TakesTheFewestTransforms) {
  TransformGraph graph;
  graph.add({{"ImageToProbe", moved_matrix(0.3, 1, 0, 0)}, {"ProbeToReference", moved_matrix(0.2, 0, 1, 0)}});
  graph.add({{"ImageToReference", moved_matrix(0.1, 0, 0, 1)}});
  EXPECT_TRUE(graph.find("Image", "Reference")->isApprox(moved_matrix(0.1, 0, 0, 1), 1e-12));
}

TEST(TransformGraph, LaterTransformsOfANameReplaceEarlierOnes) {
  TransformGraph graph;
  graph.add({{"ImageToReference", moved_matrix(0.0, 1, 1, 1)}});
  graph.add({{"ImageToReference", moved_matrix(0.0, 2, 2, 2)}});
  EXPECT_EQ((*graph.find("Image", "Reference"))(0, 3), 2.0);
}

TEST(TransformGraph, ParsesFrameNamesThatContainTo) {
  TransformGraph graph;
  graph.add({{"ToolToTracker", moved_matrix(0.0, 3, 0, 0)}, {"TorsoToTracker", moved_matrix(0.0, 1, 0, 0)}});
  ASSERT_TRUE(graph.find("Tool", "Torso"));
  EXPECT_EQ((*graph.find("Tool", "Torso"))(0, 3), 2.0);
}

TEST(TransformGraph, DoesNotInvertAProjection) {
  GraphMatrix flat = GraphMatrix::Identity();
  flat(2, 2) = 0.0;
  TransformGraph graph;
  graph.add({{"ImageToReference", flat}});
  EXPECT_TRUE(graph.find("Image", "Reference"));
  EXPECT_FALSE(graph.find("Reference", "Image"));
}

TEST(TransformGraph, NamesTheMissingTransform) {
  TransformGraph graph;
  graph.add({{"ProbeToTracker", GraphMatrix::Identity()}, {"ReferenceToTracker", GraphMatrix::Identity()}});
  EXPECT_FALSE(graph.find("Image", "Reference"));
  EXPECT_EQ(graph.explain("Image", "Reference"),
            "no transform from Image to Reference: known transforms are ProbeToTracker, ReferenceToTracker; Image is "
            "connected to "
            "none, Reference to Probe, Tracker");
}

}  // namespace
}  // namespace trocar::ultrasound
