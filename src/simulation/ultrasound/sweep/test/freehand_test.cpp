#include "ultrasound/sweep/freehand.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <functional>

#include "core/random.h"

namespace trocar::ultrasound {
namespace {

using SequenceMatrix = TrackedSequence::Matrix4;
using Pattern = std::function<std::uint8_t(std::size_t frame, int column, int row)>;

TrackedSequence make_sequence(int columns, int rows, std::size_t frames, const Pattern& pattern) {
  TrackedSequence sequence;
  sequence.columns = columns;
  sequence.rows = rows;
  sequence.frames.resize(frames);
  for (std::size_t frame = 0; frame < frames; ++frame) {
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) sequence.pixels.push_back(pattern(frame, column, row));
    // Side by side, 1 mm apart; pixels of 1 mm.
    SequenceMatrix T_PI = SequenceMatrix::Identity();
    T_PI.col(3) << 10.0, 20.0, 30.0 + static_cast<double>(frame), 1.0;
    sequence.frames[frame].transforms.emplace("ImageToReference", T_PI);
  }
  return sequence;
}

std::uint8_t numbered(std::size_t frame, int column, int row) {
  return static_cast<std::uint8_t>(1 + 60 * static_cast<int>(frame) + 7 * row + column);
}

/// Frames swept with turns and tilts, pixels of 0.3 mm.
TrackedSequence tilted_sweep(const Pattern& pattern) {
  TrackedSequence sequence = make_sequence(60, 50, 40, pattern);
  Random random(7);
  for (std::size_t n = 0; n < sequence.frames.size(); ++n) {
    Eigen::Affine3d place = Eigen::Affine3d::Identity();
    place.translate(Vec3(random.uniform(-0.5, 0.5), 0.0, 0.4 * static_cast<double>(n)));
    place.rotate(Eigen::AngleAxisd(random.uniform(-0.2, 0.2), Vec3(1, 2, 0.5).normalized()));
    place.rotate(Eigen::AngleAxisd(0.5, Vec3::UnitX()));
    place.scale(0.3);
    sequence.frames[n].transforms.at("ImageToReference") = place.matrix();
  }
  return sequence;
}

FreehandVolume reconstruct(const TrackedSequence& sequence, const FreehandOptions& options = {}) {
  auto volume = reconstruct_freehand(sequence, {}, options);
  EXPECT_TRUE(volume) << volume.error().text();
  return volume ? *std::move(volume) : FreehandVolume{};
}

TEST(Freehand, StacksParallelImagesExactly) {
  const TrackedSequence sequence = make_sequence(5, 4, 3, numbered);
  for (const auto interpolation : {FreehandInterpolation::kNearest, FreehandInterpolation::kLinear}) {
    FreehandOptions options;
    options.interpolation = interpolation;
    const FreehandVolume volume = reconstruct(sequence, options);
    ASSERT_EQ(volume.gray.geometry.size, (std::array<std::int64_t, 3>{5, 4, 3}));
    EXPECT_EQ(volume.gray.geometry.origin_P, Vec3(10, 20, 30));
    EXPECT_EQ(volume.gray.voxels, sequence.pixels);
    EXPECT_EQ(volume.frames_used, 3U);
    EXPECT_EQ(volume.voxels_met, 60U);
  }
}

TEST(Freehand, ChainsCalibrationAndTracking) {
  TrackedSequence sequence = make_sequence(5, 4, 3, numbered);
  SequenceMatrix image = SequenceMatrix::Identity(), reference = SequenceMatrix::Identity();
  image.topLeftCorner<3, 3>() *= 0.5;
  reference.col(3) << 0.0, 0.0, 30.0, 1.0;
  for (auto& frame : sequence.frames) {
    auto node = frame.transforms.extract("ImageToReference");
    node.key() = "ProbeToTracker";
    frame.transforms.insert(std::move(node));
    frame.transforms.emplace("ReferenceToTracker", reference);
  }
  FreehandOptions options;
  options.spacing_mm = Vec3(0.5, 0.5, 1.0);
  const auto volume = reconstruct_freehand(sequence, {{"ImageToProbe", image}}, options);
  ASSERT_TRUE(volume) << volume.error().text();
  EXPECT_EQ(volume->gray.geometry.origin_P, Vec3(10, 20, 0));
  EXPECT_EQ(volume->gray.voxels, sequence.pixels);
}

TEST(Freehand, CompoundsPixelsOfOneVoxel) {
  // Three pictures in one place.
  TrackedSequence sequence = make_sequence(4, 4, 3, [](std::size_t frame, int, int) {
    return std::array<std::uint8_t, 3>{10, 31, 20}[frame];
  });
  for (auto& frame : sequence.frames) frame.transforms = sequence.frames[0].transforms;
  for (const auto interpolation : {FreehandInterpolation::kNearest, FreehandInterpolation::kLinear}) {
    FreehandOptions options;
    options.interpolation = interpolation;
    EXPECT_EQ(reconstruct(sequence, options).gray.voxels, std::vector<std::uint8_t>(16, 20));  // 61 / 3
    options.compounding = FreehandCompounding::kMaximum;
    EXPECT_EQ(reconstruct(sequence, options).gray.voxels, std::vector<std::uint8_t>(16, 31));
    options.compounding = FreehandCompounding::kLatest;
    EXPECT_EQ(reconstruct(sequence, options).gray.voxels, std::vector<std::uint8_t>(16, 20));
  }
}

TEST(Freehand, MeanOfThousandsOfPixelsIsExact) {
  // PLUS' running mean of whole numbers would sink to 100 here.
  const TrackedSequence sequence =
      make_sequence(100, 100, 1, [](std::size_t, int column, int) { return column % 4 == 0 ? 100 : 104; });
  FreehandOptions options;
  options.spacing_mm = Vec3::Constant(100.0);
  const FreehandVolume volume = reconstruct(sequence, options);
  EXPECT_EQ(volume.gray.voxels[0], 103);
}

/// The definition: every pixel to the nearest voxel, in doubles, one after the other.
std::vector<double> slow_means(const TrackedSequence& sequence, const volume::GridGeometry& grid) {
  std::vector<double> sums(grid.voxel_count(), 0.0), counts(grid.voxel_count(), 0.0);
  for (std::size_t frame = 0; frame < sequence.frames.size(); ++frame) {
    const SequenceMatrix& T_PI = sequence.frames[frame].transforms.at("ImageToReference");
    for (int row = 0; row < sequence.rows; ++row) {
      for (int column = 0; column < sequence.columns; ++column) {
        const Vec3 index = grid.to_index((T_PI * Eigen::Vector4d(column, row, 0, 1)).head<3>());
        volume::Index3 voxel{};
        for (int axis = 0; axis < 3; ++axis)
          voxel[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(std::floor(index[axis] + 0.5));
        EXPECT_TRUE(grid.contains(voxel));
        const auto pixel = static_cast<std::size_t>(row * sequence.columns + column);
        sums[grid.offset(voxel)] += sequence.picture(frame)[pixel];
        counts[grid.offset(voxel)] += 1.0;
      }
    }
  }
  for (std::size_t n = 0; n < sums.size(); ++n) sums[n] = counts[n] > 0.0 ? sums[n] / counts[n] : 0.0;
  return sums;
}

TEST(Freehand, AgreesWithTheSlowDefinition) {
  Random random(3);
  const TrackedSequence sequence =
      tilted_sweep([&](std::size_t, int, int) { return static_cast<std::uint8_t>(1 + random.next() % 255); });
  FreehandOptions options;
  options.spacing_mm = Vec3(0.4, 0.5, 0.6);
  const FreehandVolume volume = reconstruct(sequence, options);
  const std::vector<double> expected = slow_means(sequence, volume.gray.geometry);
  std::size_t wrong = 0;
  for (std::size_t n = 0; n < expected.size(); ++n) wrong += std::abs(volume.gray.voxels[n] - expected[n]) > 0.501;
  // A pixel within a billionth of a border may fall to the other side.
  EXPECT_LE(wrong, 2U);
  EXPECT_GT(volume.voxels_met, 10'000U);
  EXPECT_EQ(reconstruct(sequence, options).gray.voxels, volume.gray.voxels);
}

TEST(Freehand, RestoresASmoothFieldFromTiltedImages) {
  const auto field = [](const Vec3& p) {
    return 128.0 + 60.0 * std::sin(0.5 * p[0]) * std::cos(0.4 * p[1] + 0.3 * p[2]);
  };
  TrackedSequence sequence = tilted_sweep([](std::size_t, int, int) { return std::uint8_t{1}; });
  for (std::size_t n = 0; n < sequence.pixels.size(); ++n) {
    const std::size_t frame = n / sequence.frame_pixels(), pixel = n % sequence.frame_pixels();
    const Eigen::Vector4d p_I(static_cast<double>(pixel % 60), static_cast<double>(pixel / 60), 0.0, 1.0);
    const Vec3 p = (sequence.frames[frame].transforms.at("ImageToReference") * p_I).head<3>();
    sequence.pixels[n] = static_cast<std::uint8_t>(std::lround(field(p)));
  }
  const auto error_of = [&](FreehandInterpolation interpolation) {
    FreehandOptions options;
    options.spacing_mm = Vec3::Constant(0.5);
    options.interpolation = interpolation;
    options.holes = {HoleFilling{}};
    const volume::LabelGrid gray = reconstruct(sequence, options).gray;
    double sum2 = 0.0, count = 0.0;
    for (std::size_t n = 0; n < gray.voxels.size(); ++n) {
      if (gray.voxels[n] == 0) continue;
      const volume::Index3 ijk = gray.geometry.index_of(n);
      const Vec3 index = volume::to_vec3(ijk);
      sum2 += std::pow(gray.voxels[n] - field(gray.geometry.to_mm(index)), 2);
      count += 1.0;
    }
    EXPECT_GT(count, 20'000.0);
    return std::sqrt(sum2 / count);
  };
  // The field changes by 30 gray values a mm at most, and a voxel's pixels lie within 0.43 mm of it, 0.25 mm apart; at
  // the border they lie on one side. Linear shares reach to the neighbouring voxels and smooth.
  EXPECT_LT(error_of(FreehandInterpolation::kNearest), 2.0);
  EXPECT_LT(error_of(FreehandInterpolation::kLinear), 3.0);
}

TEST(Freehand, SkipsInvalidImagesAndImagesWithoutPose) {
  TrackedSequence sequence = make_sequence(5, 4, 3, numbered);
  sequence.frames[0].is_valid = false;
  sequence.frames[2].transforms.clear();
  const FreehandVolume volume = reconstruct(sequence);
  EXPECT_EQ(volume.frames_used, 1U);
  EXPECT_EQ(volume.frames_left_out, 2U);
  EXPECT_EQ(volume.gray.geometry.size[2], 1);
  EXPECT_EQ(volume.gray.voxels[0], numbered(1, 0, 0));
}

TEST(Freehand, NamesAMissingTransform) {
  const TrackedSequence sequence = make_sequence(5, 4, 3, numbered);
  FreehandOptions options;
  options.reference_frame = "Bed";
  const auto volume = reconstruct_freehand(sequence, {}, options);
  ASSERT_FALSE(volume);
  EXPECT_NE(volume.error().what.find("no transform from Image to Bed: known transforms are ImageToReference"),
            std::string::npos);
}

TEST(Freehand, ClipsToARectangle) {
  const TrackedSequence sequence = make_sequence(5, 4, 3, numbered);
  FreehandOptions options;
  options.rectangle = ClipRectangle{1, 2, 3, 99};
  const FreehandVolume volume = reconstruct(sequence, options);
  ASSERT_EQ(volume.gray.geometry.size, (std::array<std::int64_t, 3>{3, 2, 3}));
  EXPECT_EQ(volume.gray.geometry.origin_P, Vec3(11, 22, 30));
  EXPECT_EQ((volume.gray[{2, 1, 1}]), numbered(1, 3, 3));
  options.rectangle = ClipRectangle{50, 50, 10, 10};
  EXPECT_FALSE(reconstruct_freehand(sequence, {}, options));
}

TEST(Freehand, ClipsToAFan) {
  const TrackedSequence sequence = make_sequence(41, 40, 1, [](std::size_t, int, int) { return std::uint8_t{9}; });
  FreehandOptions options;
  options.fan = ClipFan{20.0, -10.0, -0.3, 0.3, 15.0, 45.0};
  const FreehandVolume volume = reconstruct(sequence, options);
  // Area of the part of a ring, half a pixel more or less along its edge.
  const double area = 0.5 * 0.6 * (45.0 * 45.0 - 15.0 * 15.0), edge = 0.6 * 60.0 + 2.0 * 30.0;
  EXPECT_NEAR(static_cast<double>(volume.voxels_met), area, 0.5 * edge);
}

TEST(Freehand, SkipsDarkPixelsAndTheBlackMargin) {
  // Column 0 is black in both pictures, column 1 only in the second.
  TrackedSequence sequence = make_sequence(4, 3, 2, [](std::size_t frame, int column, int) {
    return static_cast<std::uint8_t>(column == 0 ? 0 : column == 1 && frame == 1 ? 0 : 50);
  });
  sequence.frames[1].transforms = sequence.frames[0].transforms;
  FreehandOptions options;
  EXPECT_EQ((reconstruct(sequence, options).gray[{1, 0, 0}]), 25);
  options.is_black_left_out = true;
  const FreehandVolume without_margin = reconstruct(sequence, options);
  EXPECT_EQ(without_margin.gray.geometry.size[0], 3);
  EXPECT_EQ((without_margin.gray[{0, 0, 0}]), 25);
  options.least_gray = 1.0;
  EXPECT_EQ((reconstruct(sequence, options).gray[{0, 0, 0}]), 50);
}

TEST(Freehand, RefusesImpossibleOptions) {
  TrackedSequence sequence = make_sequence(5, 4, 3, numbered);
  const auto is_refused = [&](const std::function<void(FreehandOptions&)>& change) {
    FreehandOptions options;
    change(options);
    return !reconstruct_freehand(sequence, {}, options);
  };
  EXPECT_TRUE(is_refused([](FreehandOptions& o) { o.spacing_mm[1] = 0.0; }));
  EXPECT_TRUE(is_refused([](FreehandOptions& o) { o.spacing_mm[1] = std::nan(""); }));
  EXPECT_TRUE(is_refused([](FreehandOptions& o) { o.holes = {{.stick_length_limit = 1000}}; }));
  EXPECT_TRUE(is_refused([](FreehandOptions& o) { o.holes = {{.size = 4}}; }));
  sequence.frames[0].transforms.at("ImageToReference")(0, 3) = 1e9;
  EXPECT_TRUE(is_refused([](FreehandOptions&) {}));
  sequence.frames[0].transforms.at("ImageToReference")(0, 3) = std::nan("");
  EXPECT_EQ(reconstruct(sequence).frames_used, 2U);
}

}  // namespace
}  // namespace trocar::ultrasound
