// One motion everywhere: a tagged place of the liver, while the patient shears, bulges and slides, is where the motion
// says for each part that looks at the patient, at ten times of a breath. Prints the table of docs/validation.md.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

#include "anatomy/skin_now.h"
#include "attempt/offline/run_session.h"
#include "attempt/record/attempt_replay.h"
#include "cases/testing/cached_case.h"
#include "core/files/folders.h"
#include "moving_patient/block_patient.h"
#include "scene/patient_scene.h"
#include "scene/render_patient.h"
#include "server/scene_builder.h"
#include "server/servo.h"
#include "slices/paint_slice.h"
#include "surface/extract_surface.h"
#include "ultrasound/live/picture_maker.h"
#include "ultrasound/panorama/panorama_engine.h"
#include "xray/projection/moved_volume.h"
#include "xray/projection/xray_volume.h"

namespace trocar::testing {
namespace {

constexpr int kTimes = 10;
constexpr double kWithin_mm = 0.3;
const Vec3& kTag_A = BlockPatient::kTag_A;

std::shared_ptr<const anatomy::VirtualPatient> patient() {
  static const auto the_patient = block_patient();
  return the_patient;
}
motion::MotionClock clock_of(const anatomy::VirtualPatient& moving) {
  return {moving.motion.get(), motion::testing::sliding_drive()};
}
double time_of(int n) {
  return 0.4 * n;
}

/// Largest distance of the ten, printed as a row of the table.
class Row {
 public:
  explicit Row(std::string consumer) : consumer_(std::move(consumer)) {}
  ~Row() { fmt::print("| {} | {:.2f} {} | {:.2f} |\n", consumer_, most_, unit_, allowed_); }
  void note(double error, double allowed = kWithin_mm, const char* unit = "mm") {
    most_ = std::max(most_, error);
    allowed_ = allowed;
    unit_ = unit;
    EXPECT_LE(error, allowed) << consumer_;
  }

 private:
  std::string consumer_;
  double most_ = 0.0, allowed_ = 0.0;
  const char* unit_ = "mm";
};

/// A device whose pose the test sets.
class PosedDevice final : public devices::HapticDevice {
 public:
  explicit PosedDevice(stylus::DevicePreset preset) : preset_(std::move(preset)) {}
  const stylus::DevicePreset& preset() const noexcept override { return preset_; }
  std::string name() const override { return "posed"; }
  devices::DeviceReading read(double) noexcept override { return {devices::DeviceStatus::kFresh, X_DS, 0}; }
  bool write(const Wrench&) noexcept override { return true; }
  Status reconnect() override { return {}; }
  Pose X_DS;

 private:
  stylus::DevicePreset preset_;
};

/// A haptic server's loop over the block, one period at a time.
class ServerLab {
 public:
  explicit ServerLab(const char* tool) : preset_(*stylus::load_device_preset(data_dir() / "devices.toml", "premium")) {
    server::SceneBuilder builder(
        [](const std::string&, std::uint64_t, const Progress&) {
          return Result<std::shared_ptr<const anatomy::VirtualPatient>>(patient());
        },
        data_dir() / "tissues.toml", preset_);
    link::LoadScene request;
    request.patient = "block";
    request.tool = tool;
    request.motion_hash = anatomy::motion_hash(*patient());
    request.motion = motion::testing::sliding_drive();
    Mat3 R_PW;
    R_PW << 0, 1, 0, 0, 0, -1, -1, 0, 0;
    request.X_PW = {R_PW, kTag_A - Vec3(0.0, request.needle_length_mm, 0.0)};
    const auto made = builder.load(request);
    EXPECT_TRUE(made) << (made ? "" : made.error().text());
    if (made) scene_ = *made;
  }
  /// The first tick of a tool that is at X_P at a time.
  telemetry::TickSample first_tick(const Pose& X_P, double time_s) const {
    PosedDevice device(preset_);
    server::Servo servo(device, server::servo_params(preset_));
    const haptics::HapticScene& scene = *scene_.scene;
    device.X_DS = scene.X_PW.inverse() * X_P * scene.X_SN.inverse();
    server::ServoInput input;
    input.now_s = time_s;
    input.scene = &scene_;
    const telemetry::TickSample sample = servo.step(input).sample;
    EXPECT_LT((sample.device_mm - X_P.p()).norm(), 1e-6);
    return sample;
  }

 private:
  stylus::DevicePreset preset_;
  server::ServoScene scene_;
};

TEST(EveryConsumer, NeedleServerFindsTheTag) {
  Row row("needle server: tissue at the tip");
  const ServerLab lab("needle");
  const Mat3 R_PN = rotation_between(Vec3::UnitZ(), Vec3::UnitY());
  const auto bone = patient()->label_table.find("tag")->tissue;
  for (int n = 0; n < kTimes; ++n) {
    const Vec3 tag_P = clock_of(*patient()).at(time_of(n)).to_now(kTag_A);
    Vec3 found_P = tag_P;
    std::map<int, int> tissues;
    for (int axis = 0; axis < 3; ++axis) {
      double low_mm = 1e9, high_mm = -1e9;
      const std::uint8_t outside = lab.first_tick({R_PN, tag_P + 8.0 * Vec3::Unit(axis)}, time_of(n)).tissue;
      for (double off_mm = -6.0; off_mm <= 6.0; off_mm += 0.05) {
        const Vec3 p_P = tag_P + off_mm * Vec3::Unit(axis);
        const telemetry::TickSample sample = lab.first_tick({R_PN, p_P}, time_of(n));
        ASSERT_LT((clock_of(*patient()).at(time_of(n)).to_now(sample.rest_tip_mm) - sample.tip_mm).norm(), 1e-5);
        if (sample.tissue == outside) continue;
        low_mm = std::min(low_mm, off_mm);
        high_mm = std::max(high_mm, off_mm);
      }
      ASSERT_LT(low_mm, high_mm);
      found_P[axis] += 0.5 * (low_mm + high_mm);
    }
    row.note((found_P - tag_P).norm());
  }
  EXPECT_EQ(bone, "bone");
}

TEST(EveryConsumer, TransducerServerMeetsTheSkin) {
  Row row("transducer server: first contact with the skin");
  const ServerLab lab("probe");
  const Vec3 place_A(10.0, 0.0, 20.0);
  for (int n = 0; n < kTimes; ++n) {
    const motion::PatientMotion motion = clock_of(*patient()).at(time_of(n));
    const Vec3 place_P = motion.to_now(place_A);
    const Vec3 inward_P = anatomy::SkinNow(*patient(), motion).inward(place_P);
    const Mat3 R_PT = rotation_between(Vec3::UnitY(), inward_P);
    double met_mm = -3.0;
    while (met_mm < 3.0 && lab.first_tick({R_PT, place_P + met_mm * inward_P}, time_of(n)).depth_mm <= 0.0)
      met_mm += 0.02;
    row.note(std::abs(met_mm));
  }
}

TEST(EveryConsumer, UltrasoundShowsTheTag) {
  Row row("ultrasound: brightest point of the image");
  const auto table = ultrasound::load_acoustic_table(data_dir() / "acoustics.toml");
  ASSERT_TRUE(table);
  const auto plain = block_patient(false);
  const auto made = ultrasound::make_acoustic_scene(*plain, *table);
  ASSERT_TRUE(made) << made.error().text();
  auto scene = std::make_shared<ultrasound::AcousticScene>(**made);
  scene->points = {{kTag_A, 60.0F}};
  const auto transducer = *ultrasound::load_transducer(data_dir() / "transducers.toml", "C5-2");
  ultrasound::PictureMaker maker(scene, transducer);
  Mat3 R_PT;  // the plane through the tag that contains both displacements
  R_PT.col(0) = Vec3::UnitZ();
  R_PT.col(1) = Vec3::UnitY();
  R_PT.col(2) = R_PT.col(0).cross(R_PT.col(1));
  for (int n = 0; n < kTimes; ++n) {
    const motion::PatientMotion motion = clock_of(*plain).at(time_of(n));
    const Vec3 tag_P = motion.to_now(kTag_A);
    ultrasound::ScanRequest request;
    request.X_PT = {R_PT, Vec3(kTag_A.x(), motion.to_now({kTag_A.x(), 0.0, -4.0}).y() + 2.0, -4.0)};
    request.motion = motion;
    request.acquisition = ultrasound::default_acquisition(transducer);
    request.acquisition.depth_mm = 80.0;
    request.acquisition.focus_mm = 45.0;
    request.acquisition.artefacts.range_distortion = false;  // liver is faster than the scanner assumes
    request.acquisition.artefacts.refraction = false;
    request.columns = request.rows = 800;
    const ultrasound::ScanPicture picture = maker.make(request, ultrasound::ScanDetail::kFull, 7);
    const ultrasound::Vec2 expected_T = ultrasound::shown_place_T(picture, tag_P);
    ultrasound::Vec2 sum_T(0.0, 0.0);
    double weight = 0.0;
    int brightest = 0;
    for (const std::uint8_t gray : picture.gray.pixels) brightest = std::max<int>(brightest, gray);
    for (int v = 0; v < picture.gray.rows; ++v)
      for (int u = 0; u < picture.gray.columns; ++u) {
        const int gray = picture.gray.pixels[static_cast<std::size_t>(v * picture.gray.columns + u)];
        const ultrasound::Vec2 p_T = picture.raster.to_T(u, v);
        if (gray < brightest - 25 || (p_T - expected_T).norm() > 6.0) continue;
        sum_T += p_T;
        weight += 1.0;
      }
    ASSERT_GT(weight, 0.0);
    row.note((sum_T / weight - expected_T).norm(), std::max(kWithin_mm, picture.raster.mm_per_pixel));
  }
}

TEST(EveryConsumer, SlicesShowTheTag) {
  Row row("slices: bright voxels of the CT");
  slices::SliceBuffers buffers;
  slices::SliceStyle style;
  style.label_opacity = 0.0;
  style.has_outlines = false;
  style.window = {700.0, 1400.0};
  for (int n = 0; n < kTimes; ++n) {
    const motion::PatientMotion motion = clock_of(*patient()).at(time_of(n));
    const Vec3 tag_P = motion.to_now(kTag_A);
    volume::SlicePlane plane;
    plane.columns = plane.rows = 200;
    plane.step_u_P = 0.4 * Vec3::UnitZ();
    plane.step_v_P = 0.4 * Vec3::UnitY();
    plane.origin_P = {tag_P.x(), 5.0, -45.0};
    image::RgbImage image;
    slices::paint_slice(*patient(), plane, style, buffers, image, motion);
    Vec3 sum = Vec3::Zero();
    double weight = 0.0;
    for (int v = 0; v < image.rows; ++v)
      for (int u = 0; u < image.columns; ++u) {
        const double gray = image.pixels[static_cast<std::size_t>(v * image.columns + u)][0];
        if (gray < 100.0) continue;
        sum += gray * (plane.origin_P + u * plane.step_u_P + v * plane.step_v_P);
        weight += gray;
      }
    ASSERT_GT(weight, 0.0);
    row.note((sum / weight - tag_P).norm());
  }
}

TEST(EveryConsumer, SurfacesShowTheTag) {
  if (!scene::can_render()) GTEST_SKIP() << "no X server: run under scripts/with_display";
  Row row("3D view: surface of the tag");
  constexpr int kSide = 400;
  auto made = scene::PatientScene::make(kSide, kSide);
  ASSERT_TRUE(made) << made.error().text();
  scene::PatientScene& view = **made;
  auto meshes = std::make_shared<std::vector<anatomy::NamedMesh>>(surface::extract_surfaces(*patient()));
  view.show_patient(patient(), meshes);
  view.finish_loading();
  for (const scene::StructureInfo& structure : std::vector(view.structures()))
    view.set_opacity(structure.name, structure.name == "tag" ? 1.0 : 0.0);
  scene::CameraView camera;
  camera.focus_P = kTag_A + Vec3(0.0, 0.0, -9.0);
  camera.eye_P = camera.focus_P + Vec3(400.0, 0.0, 0.0);
  camera.view_angle_rad = 0.15;
  view.set_view(camera);
  /// Middle (right, down) of the pixels that show the ball, less where its middle is projected.
  const auto off_px = [&](const motion::PatientMotion& motion) -> Eigen::Vector2d {
    scene::SceneView frame;
    frame.motion = motion;
    view.show(frame);
    EXPECT_TRUE(view.render(scene::DetailPolicy::full()));
    std::vector<std::uint32_t> pixels(static_cast<std::size_t>(kSide) * kSide);
    view.copy_picture(pixels);
    Eigen::Vector2d sum(0.0, 0.0);
    double weight = 0.0;
    for (int v = 0; v < kSide; ++v)
      for (int u = 0; u < kSide; ++u) {
        const std::uint32_t pixel = pixels[static_cast<std::size_t>(v * kSide + u)];
        const int red = static_cast<int>(pixel >> 16 & 0xff), blue = static_cast<int>(pixel & 0xff);
        if (red < blue + 15) continue;  // the ball alone is visible, before a bluish background
        sum += Eigen::Vector2d(u, v);
        weight += 1.0;
      }
    EXPECT_GT(weight, 0.0);
    const Vec3 tag_P = motion.to_now(kTag_A), from_focus = tag_P - camera.focus_P;
    const double mm_per_px = camera.mm_per_pixel(tag_P, kSide), middle = 0.5 * (kSide - 1);
    return sum / weight - Eigen::Vector2d(middle + from_focus.dot(camera.right_P()) / mm_per_px,
                                          middle - from_focus.dot(camera.up_P) / mm_per_px);
  };
  const Eigen::Vector2d lit_px = off_px({});  // the shaded side of the ball is as dark as the background
  const double mm_per_px = camera.mm_per_pixel(kTag_A, kSide);
  for (int n = 0; n < kTimes; ++n) row.note((off_px(clock_of(*patient()).at(time_of(n))) - lit_px).norm() * mm_per_px);
}

TEST(EveryConsumer, XrayShowsTheTag) {
  Row row("X-ray: shadow of the tag");
  const auto rest = xray::XrayVolume::make(patient());
  ASSERT_TRUE(rest) << rest.error().text();
  xray::CArm arm;
  arm.isocentre_P = kTag_A;
  arm.lao_deg = 90.0;
  arm.field_mm = 160.0;
  arm.pixels = 512;
  const xray::XrayRays rays = xray::rays_of(arm);
  for (int n = 0; n < kTimes; ++n) {
    const motion::PatientMotion motion = clock_of(*patient()).at(time_of(n));
    xray::MassImage masses;
    xray::project(*xray::moved_volume(*rest, motion), rays, masses);
    const std::vector<float>& bone = masses.of(xray::Basis::kBone);
    const float most = *std::max_element(bone.begin(), bone.end());
    double column = 0.0, line = 0.0, weight = 0.0;
    for (std::size_t i = 0; i < bone.size(); ++i) {
      if (bone[i] < 0.3F * most) continue;
      const auto value = static_cast<double>(bone[i]);
      column += value * static_cast<double>(i % 512);
      line += value * static_cast<double>(i / 512);
      weight += value;
    }
    const auto expected = rays.project(motion.to_now(kTag_A));
    row.note(std::hypot(column / weight - expected[0], line / weight - expected[1]), 1.0, "px");
  }
}

TEST(EveryConsumer, PanoramaShowsTheTag) {
  Row row("panorama: bright ball of the recorded volume");
  const auto table = ultrasound::load_acoustic_table(data_dir() / "acoustics.toml");
  ASSERT_TRUE(table);
  const auto plain = block_patient(false);
  const auto scene = ultrasound::make_acoustic_scene(*plain, *table);
  ASSERT_TRUE(scene) << scene.error().text();
  volume::GridGeometry geometry;
  geometry.size = {60, 160, 200};
  geometry.spacing_mm = Vec3::Constant(0.7);
  geometry.origin_P = kTag_A - Vec3(21.0, 60.0, 70.0);
  volume::LabelGrid gray(geometry, 40);
  for (std::size_t i = 0; i < gray.voxels.size(); ++i)
    if ((geometry.centre_mm(geometry.index_of(i)) - kTag_A).norm() < BlockPatient::kTag_mm) gray.voxels[i] = 230;
  const auto panorama = ultrasound::make_panorama(gray, Pose(), {});
  ASSERT_TRUE(panorama) << panorama.error().text();
  const auto transducer = *ultrasound::load_transducer(data_dir() / "transducers.toml", "C5-2");
  ultrasound::Acquisition acquisition = ultrasound::default_acquisition(transducer);
  acquisition.depth_mm = 80.0;
  ultrasound::PanoramaEngine engine(*scene, *panorama, transducer, acquisition);
  Mat3 R_PT;
  R_PT.col(0) = Vec3::UnitZ();
  R_PT.col(1) = Vec3::UnitY();
  R_PT.col(2) = R_PT.col(0).cross(R_PT.col(1));
  for (int n = 0; n < kTimes; ++n) {
    ultrasound::BModeInput input;
    input.motion = clock_of(*plain).at(time_of(n));
    const Vec3 tag_P = input.motion.to_now(kTag_A);
    input.X_PT = {R_PT, Vec3(kTag_A.x(), input.motion.to_now({kTag_A.x(), 0.0, -4.0}).y(), -4.0)};
    const ultrasound::BasebandFrame& frame = engine.render(input);
    const Vec3 tag_T = input.X_PT.inverse() * tag_P;
    const ultrasound::Polar at = frame.geometry.to_polar(ultrasound::Vec2(tag_T.x(), tag_T.y()));
    // The beam is as wide as the ball: the middle of what is above half of the brightest.
    double most = 0.0, line = 0.0, depth = 0.0, weight = 0.0;
    for (const bool is_second : {false, true})
      for (int l = std::max(0, static_cast<int>(at.line) - 12); l < static_cast<int>(at.line) + 13; ++l)
        for (int s = 0; s < frame.geometry.samples; ++s) {
          const double depth_mm = (s + 0.5) * frame.geometry.sample_mm();
          if (std::abs(depth_mm - at.depth_mm) > 6.0) continue;
          double power = 0.0;
          for (int angle = 0; angle < frame.steering_angles; ++angle) {
            const auto i = static_cast<std::size_t>((angle * frame.geometry.lines + l) * frame.geometry.samples + s);
            power += static_cast<double>(frame.re[i] * frame.re[i] + frame.im[i] * frame.im[i]);
          }
          if (!is_second) most = std::max(most, power);
          if (!is_second || power < 0.02 * most) continue;
          line += l;
          depth += depth_mm;
          weight += 1.0;
        }
    ASSERT_GT(weight, 0.0);
    const ultrasound::SoundPath path = engine.sound_path(static_cast<int>(std::lround(at.line)));
    const auto sample = static_cast<std::size_t>(at.depth_mm / frame.geometry.sample_mm());
    const double pressed_mm = static_cast<double>(path.pressed_mm * path.dent_share[sample]);
    const ultrasound::Vec2 found_T = frame.geometry.to_cartesian({line / weight, depth / weight - pressed_mm});
    row.note((found_T - ultrasound::Vec2(tag_T.x(), tag_T.y())).norm());
  }
}

TEST(EveryConsumer, ReplayShowsTheTag) {
  Row row("replay: motion restored from the session");
  cases::CaseChoice choice;
  choice.patient_source = "layers-liver";
  const auto opened = open_cached_case(choice);
  ASSERT_TRUE(opened) << opened.error().text();
  auto open = std::make_shared<cases::OpenCase>(**opened);
  auto moving = std::make_shared<anatomy::VirtualPatient>(*open->the_case.patient);
  const Vec3 tag_A = open->the_case.plan.line_P.b;
  moving->motion = motion::testing::sliding_model(tag_A.x() - 60.0, tag_A);
  open->the_case.patient = moving;

  const TemporaryFolder folder;
  attempt::RunOptions options;
  options.operator_name = "constant-velocity:20";
  options.patient_source = choice.patient_source;
  open->the_case.breathing = motion::testing::sliding_drive();
  options.session = folder / "first.session";
  const auto first = attempt::run_session(open->the_case, options);
  ASSERT_TRUE(first) << first.error().text();
  const auto replay = attempt::AttemptReplay::load(options.session, open);
  ASSERT_TRUE(replay) << replay.error().text();
  const auto& samples = replay->session().samples;
  const motion::MotionClock clock = clock_of(*moving);
  for (int n = 0; n < kTimes; ++n) {
    const telemetry::TickSample& sample = samples[samples.size() * static_cast<std::size_t>(n) / kTimes];
    const motion::PatientMotion shown = replay->motion_at(sample.time_s);
    row.note((shown.to_now(tag_A) - clock.at(sample.time_s).to_now(tag_A)).norm(), 1e-9);
    EXPECT_LT((shown.to_now(sample.rest_tip_mm) - sample.tip_mm).norm(), 1e-5);
  }

  options.operator_name = "replay:" + options.session.string();
  options.session = folder / "again.session";
  const auto again = attempt::run_session(open->the_case, options);
  ASSERT_TRUE(again) << again.error().text();
  EXPECT_EQ(again->ticks_hash, first->ticks_hash) << "a replay is exact";

  storage::Session damaged = replay->session();
  damaged.samples[5].breathing = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(attempt::AttemptReplay::of(damaged, open)) << "a tick without a phase";
  damaged = replay->session();
  damaged.parameters.front().options.push_back("motion.period=0");
  EXPECT_FALSE(attempt::AttemptReplay::of(damaged, open)) << "a breath of 0 s";

  moving->motion = motion::testing::uniform_model({0.0, 0.0, 5.0});
  EXPECT_FALSE(attempt::AttemptReplay::load(options.session, open)) << "the patient moves in another way";
}

}  // namespace
}  // namespace trocar::testing
