#include "slices/paint_slice.h"

#include <gtest/gtest.h>

#include "coarse_abdomen.h"
#include "core/testing/allocation_guard.h"
#include "core/testing/allocation_guard.inc.h"
#include "slices/slice_geometry.h"

namespace trocar::slices {
namespace {

SliceGeometry view_of(const Vec3& center_P, const SliceAxes& axes) {
  SliceGeometry geometry;
  geometry.axes = axes;
  geometry.center_P = center_P;
  geometry.columns = geometry.rows = 200;
  geometry.mm_per_px = 2.0;
  return geometry;
}

/// The middle of all voxels of a label.
Vec3 middle_of(const anatomy::VirtualPatient& patient, std::string_view name) {
  const anatomy::Label* label = patient.label_table.find(name);
  Vec3 sum = Vec3::Zero();
  double count = 0.0;
  for (std::size_t n = 0; label != nullptr && n < patient.labels.voxels.size(); ++n) {
    if (patient.labels.voxels[n] != label->id) continue;
    const auto [i, j, k] = patient.labels.geometry.index_of(n);
    sum += patient.labels.geometry.to_mm({static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)});
    ++count;
  }
  return sum / count;
}

TEST(PaintSlice, ShowsTheLiverOnTheImageLeft) {
  const Vec3 liver_P = middle_of(coarse_abdomen(), "liver");
  const SliceGeometry view = view_of(body_box(coarse_abdomen()).center(), slice_axes(SliceOrientation::kAxial));
  SliceGeometry at_liver = view;
  at_liver.center_P.z() = liver_P.z();
  SliceBuffers buffers;
  image::RgbImage picture;
  paint_slice(coarse_abdomen(), at_liver.plane(), {{}, 1.0, false}, buffers, picture);
  const image::Rgb liver = coarse_abdomen().label_table.find("liver")->color;
  double sum_u = 0.0;
  double count = 0.0;
  for (int v = 0; v < picture.rows; ++v)
    for (int u = 0; u < picture.columns; ++u)
      if (picture.at(u, v) == liver) sum_u += u, ++count;
  ASSERT_GT(count, 500.0);
  EXPECT_LT(sum_u / count, 0.5 * picture.columns);
}

TEST(PaintSlice, LaysColoursOverGrayByTheirOpacity) {
  const Vec3 liver_P = middle_of(coarse_abdomen(), "liver");
  const SliceGeometry view = view_of(liver_P, needle_axes(Vec3(0.5, 0.8, 0.3).normalized(), NeedlePlane::kAlong));
  SliceBuffers buffers;
  image::RgbImage plain;
  paint_slice(coarse_abdomen(), view.plane(), {{}, 0.0, false}, buffers, plain);
  for (const double opacity : {0.25, 0.5, 1.0}) {
    image::RgbImage picture;
    paint_slice(coarse_abdomen(), view.plane(), {{}, opacity, false}, buffers, picture);
    for (int v = 0; v < picture.rows; v += 3)
      for (int u = 0; u < picture.columns; u += 3) {
        const anatomy::Label* label = anatomy::find_label(coarse_abdomen(), view.to_P({u, v}));
        const bool is_ground = label == nullptr || label->tissue == "adipose" || label->tissue == "muscle";
        for (std::size_t c = 0; c < 3; ++c) {
          const double below = plain.at(u, v)[c];
          const double wanted = is_ground ? below : (1.0 - opacity) * below + opacity * label->color[c];
          ASSERT_NEAR(picture.at(u, v)[c], wanted, 0.51) << u << ' ' << v;  // rounding
        }
      }
  }
}

TEST(PaintSlice, OutlinesStructuresInFullColour) {
  const SliceGeometry view = view_of(middle_of(coarse_abdomen(), "liver"), slice_axes(SliceOrientation::kCoronal));
  SliceBuffers buffers;
  image::RgbImage picture;
  paint_slice(coarse_abdomen(), view.plane(), {{}, 0.0, true}, buffers, picture);
  const image::Rgb liver = coarse_abdomen().label_table.find("liver")->color;
  int outlined = 0;
  int inside = 0;
  for (int v = 1; v + 1 < picture.rows; ++v)
    for (int u = 1; u + 1 < picture.columns; ++u) {
      const auto is_liver = [&](int du, int dv) {
        const anatomy::Label* label = anatomy::find_label(coarse_abdomen(), view.to_P({u + du, v + dv}));
        return label != nullptr && label->name == "liver";
      };
      if (!is_liver(0, 0)) continue;
      const bool is_edge = !is_liver(-1, 0) || !is_liver(1, 0) || !is_liver(0, -1) || !is_liver(0, 1);
      EXPECT_EQ(picture.at(u, v) == liver, is_edge) << u << ' ' << v;
      ++(is_edge ? outlined : inside);
    }
  EXPECT_GT(outlined, 50);
  EXPECT_GT(inside, 500);
}

TEST(PaintSlice, HidesLesionsInExamsByPaintingTheirOrgan) {
  const anatomy::Label& lesion = *coarse_abdomen().label_table.find("liver_lesion_1");
  const SliceGeometry view = view_of(middle_of(coarse_abdomen(), lesion.name), slice_axes(SliceOrientation::kAxial));
  const auto painted = [&](const SliceStyle& style) {
    SliceBuffers buffers;
    image::RgbImage picture;
    paint_slice(coarse_abdomen(), view.plane(), style, buffers, picture);
    return picture;
  };
  const image::RgbImage open = painted({{}, 1.0, true}), exam = painted({{}, 1.0, true, true});
  const image::Rgb liver = coarse_abdomen().label_table.find("liver")->color;
  int lesions = 0;
  for (std::size_t n = 0; n < open.pixels.size(); ++n) {
    if (open.pixels[n] == lesion.color) ++lesions;
    EXPECT_EQ(exam.pixels[n], open.pixels[n] == lesion.color ? liver : open.pixels[n]) << n;
  }
  EXPECT_GT(lesions, 20);
}

TEST(PaintSlice, NeverAllocatesAfterTheFirstImage) {
  SliceGeometry view = view_of(middle_of(coarse_abdomen(), "liver"), slice_axes(SliceOrientation::kAxial));
  SliceBuffers buffers;
  image::RgbImage picture;
  paint_slice(coarse_abdomen(), view.plane(), {}, buffers, picture);
  const testing::AllocationGuard guard;
  for (int n = 0; n < 5; ++n) {
    view.center_P.z() += 3.0;
    view.rows -= 10;
    paint_slice(coarse_abdomen(), view.plane(), {{}, 0.25, true, n % 2 == 0}, buffers, picture);
  }
  EXPECT_EQ(guard.count(), 0U);
}

TEST(PaintSlice, ShowsAirFarFromThePatient) {
  SliceBuffers buffers;
  image::RgbImage picture;
  const SliceGeometry view = view_of({1e5, 0, 0}, slice_axes(SliceOrientation::kSagittal));
  paint_slice(coarse_abdomen(), view.plane(), {}, buffers, picture);
  EXPECT_EQ(picture.pixels, std::vector<image::Rgb>(picture.pixels.size(), image::Rgb{0, 0, 0}));
}

}  // namespace
}  // namespace trocar::slices
