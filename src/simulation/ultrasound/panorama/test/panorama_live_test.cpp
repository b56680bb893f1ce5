// The panorama as the engine of a live scanner, and its loading in the background.

#include <thread>

#include "ultrasound/live/picture_maker.h"
#include "ultrasound/panorama/panorama.h"
#include "ultrasound/panorama/test/panorama_lab.h"

namespace trocar::ultrasound {
namespace {

using namespace testing;

ScanRequest request_of(const Transducer& transducer) {
  ScanRequest request;
  request.acquisition = small_scan(transducer);
  request.display.persistence = 0.0;
  request.columns = 160;
  request.rows = 120;
  return request;
}

TEST(PanoramaLive, RequestsSelectTheEngineOfEachImage) {
  const Transducer transducer = linear();
  const ScenePtr scene = homogeneous_scene(box_for(transducer, 60.0), TestTissue::kTissue);
  const auto panorama = make(paint_gray(kFirst_mm, kLast_mm, 1.0, [](const Vec3&) { return 150; }));
  PictureMaker maker(scene, transducer);
  ScanRequest request = request_of(transducer);
  const ScanPicture cast = maker.make(request, ScanDetail::kFull, 7);
  request.panorama = panorama;
  const ScanPicture sliced = maker.make(request, ScanDetail::kFull, 7);
  request.panorama.reset();
  const ScanPicture again = maker.make(request, ScanDetail::kFull, 7);
  EXPECT_EQ(cast.panorama_share, 0.0);
  EXPECT_DOUBLE_EQ(sliced.panorama_share, 1.0);
  EXPECT_NE(sliced.gray.pixels, cast.gray.pixels);
  EXPECT_EQ(again.gray.pixels, cast.gray.pixels);
}

TEST(PanoramaLive, AnotherEngineIsANewRequest) {
  const ScanRequest cast = request_of(linear());
  ScanRequest sliced = cast;
  sliced.panorama = make(paint_gray(Vec3(0, 0, 0), Vec3(9, 9, 9), 1.0, [](const Vec3&) { return 150; }));
  EXPECT_TRUE(is_equivalent(cast, cast, 0.1));
  EXPECT_FALSE(is_equivalent(cast, sliced, 0.1));
}

/// Polls until loading has ended.
std::shared_ptr<const Panorama> wait_for(PanoramaOnDemand& panorama) {
  std::shared_ptr<const Panorama> loaded = panorama.poll();
  while (!loaded && panorama.is_possible()) {
    std::this_thread::yield();
    loaded = panorama.poll();
  }
  return loaded;
}

TEST(PanoramaOnDemand, LoadsOnceAtTheFirstUse) {
  const auto panorama = make(paint_gray(Vec3(0, 0, 0), Vec3(9, 9, 9), 1.0, [](const Vec3&) { return 150; }));
  int loads = 0;
  PanoramaOnDemand on_demand([&]() -> Result<std::shared_ptr<const Panorama>> {
    ++loads;
    return panorama;
  });
  EXPECT_EQ(loads, 0);
  EXPECT_EQ(wait_for(on_demand), panorama);
  EXPECT_EQ(on_demand.poll(), panorama);
  EXPECT_EQ(loads, 1);
}

TEST(PanoramaOnDemand, IsImpossibleAfterAnError) {
  PanoramaOnDemand on_demand([]() -> Result<std::shared_ptr<const Panorama>> {
    return fail("the panorama is damaged", "panorama.nrrd", "stitch it again");
  });
  EXPECT_TRUE(on_demand.is_possible());
  EXPECT_EQ(wait_for(on_demand), nullptr);
  EXPECT_FALSE(on_demand.is_possible());
}

}  // namespace
}  // namespace trocar::ultrasound
