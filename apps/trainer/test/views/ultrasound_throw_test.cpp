#include "test/views/ultrasound_lab.h"
#include "views/ultrasound/ultrasound_layout.h"

namespace trocar::trainer {
namespace {

TEST_F(UltrasoundViewTest, DrawsTheThrowWhereItLiesInThePlane) {
  UltrasoundView view;
  open(view, "liver-lesion", {900, 700});
  ASSERT_TRUE(settle(view));
  const auto segment_P = [&](double z_mm) {
    return Segment{X_PT_ * Vec3(-10.0, 40.0, z_mm), X_PT_ * Vec3(0.0, 60.0, z_mm)};
  };
  const auto differ_near = [&](const QImage& a, const QImage& b, const ultrasound::Vec2& p_T) {
    const QPoint at = map_of(view).to_view(p_T).toPoint();
    constexpr int kRoom_px = 6;
    const QRect around(at.x() - kRoom_px, at.y() - kRoom_px, 2 * kRoom_px, 2 * kRoom_px);
    return a.copy(around) != b.copy(around);
  };
  view.set_frozen(true);  // only the marks change
  ASSERT_TRUE(run_until(view, [](const ultrasound::ScanPicture& p) { return p.is_frozen; }));
  const QImage none = look(view, "throw_none");
  view.set_throw(segment_P(1.0), segment_P(1.0));
  const QImage drawn = look(view, "throw");
  EXPECT_TRUE(differ_near(none, drawn, {0.0, 60.0})) << "its end has a bar";
  EXPECT_TRUE(differ_near(none, drawn, {-5.0, 50.0}));
  EXPECT_FALSE(differ_near(none, drawn, {10.0, 80.0})) << "not beyond";
  view.set_throw(segment_P(8.0), segment_P(8.0));
  EXPECT_EQ(look(view, "throw_beside"), none) << "beside the plane";
  view.set_throw({}, {});
  EXPECT_EQ(look(view, "throw_over"), none);
}

}  // namespace
}  // namespace trocar::trainer
