#include "ultrasound/live/picture_maker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/result.h"
#include "ultrasound/doppler/colour_doppler.h"
#include "ultrasound/doppler/detail/colour_conversion.h"
#include "ultrasound/engine/b_mode.h"
#include "ultrasound/panorama/panorama_engine.h"
#include "ultrasound/probe/probe_contact.h"

namespace trocar::ultrasound {
namespace {

std::array<Vec3, 3> corners_P(const RasterGeometry& raster, const Pose& X_PT) noexcept {
  const auto corner = [&](double column, double row) -> Vec3 {
    const Vec2 p_T = raster.to_T(column, row);
    return X_PT * Vec3(p_T.x(), p_T.y(), 0.0);
  };
  const double right = raster.columns - 0.5, bottom = raster.rows - 0.5;
  return {corner(-0.5, -0.5), corner(right, -0.5), corner(-0.5, bottom)};
}

void set_unscanned(const AcousticScene& scene, ScanPicture& picture) {
  picture.unscanned_share = unscanned_share(scene.ends, picture.X_PT, picture.scan);
  picture.scanned_T = scanned_polygon_T(scene.ends, picture.X_PT, picture.scan);
}

}  // namespace

struct PictureMaker::Impl {
  /// Objects that render one level of detail.
  struct LevelRenderer {
    std::unique_ptr<EchoEngine> engine;
    std::shared_ptr<const Panorama> panorama;  ///< Of `engine`; nullptr: ray cast.
    int next_line = 0;                         ///< First scanline of the next picture, if it renews a part.
    std::optional<ScanRequest> last;           ///< Of its last picture.
    std::shared_ptr<const VesselFlow> flow;    ///< Of `doppler`.
    std::optional<ColourDoppler> doppler;

    /// Share of the engine's last frame that comes from its panorama.
    double panorama_share() const noexcept;
    /// The scanlines that a picture renews; empty: all. The first picture at rest is whole.
    LineRange next_lines(const ScanRequest& request, bool is_other_detail);
  };

  /// Data of a stored frame besides its levels.
  struct CineMetadata {
    ScanDetail detail = ScanDetail::kFull;
    double coupled_share = 1.0;
    std::vector<float> pressed_mm;
    double dent_reach_mm = 0.0;
    bool has_doppler = false;
    ScanGeometry doppler_scan;
    DopplerFrame doppler;
    DopplerSettings doppler_settings;
  };

  std::shared_ptr<const AcousticScene> scene;
  Transducer transducer;
  std::array<std::optional<LevelRenderer>, kScanDetails> renderers;
  std::array<std::optional<Scanner>, kScanDetails> scanners;
  std::optional<Scanner> kept_scanner;  ///< For displayed frames of the loop.
  std::optional<ScanDetail> last_detail;
  bool had_colour = false;  ///< Of the last image.
  std::optional<CineLoop> cine;
  std::vector<CineMetadata> cine_metadata;  ///< For the slots of the loop, by number of pushes.
  std::size_t pushes = 0;
  std::vector<std::uint8_t> full_levels;
  detail::ColourConversion kept_colours;

  std::unique_ptr<EchoEngine> make_engine(const std::shared_ptr<const Panorama>& panorama,
                                          const Acquisition& acquisition) const;
  LevelRenderer& renderer(const ScanRequest& request, ScanDetail detail);
  Scanner& scanner(std::optional<Scanner>& place, const ScanRequest& request);
  void add_colour(const ScanRequest& request, LevelRenderer& renderer, const BasebandFrame& echoes, std::uint64_t seed,
                  ScanPicture& picture, CineMetadata& metadata);
  void keep(const ScanRequest& request, const ScanPicture& picture, CineMetadata metadata);
  const CineMetadata& metadata(int index) const noexcept {
    return cine_metadata[(pushes - static_cast<std::size_t>(cine->size()) + static_cast<std::size_t>(index)) %
                         cine_metadata.size()];
  }
};

std::unique_ptr<EchoEngine> PictureMaker::Impl::make_engine(const std::shared_ptr<const Panorama>& panorama,
                                                            const Acquisition& acquisition) const {
  if (!panorama) return std::make_unique<BMode>(scene, transducer, acquisition);
  return std::make_unique<PanoramaEngine>(scene, panorama, transducer, acquisition);
}

PictureMaker::Impl::LevelRenderer& PictureMaker::Impl::renderer(const ScanRequest& request, ScanDetail detail) {
  std::optional<LevelRenderer>& place = renderers[static_cast<std::size_t>(detail)];
  const Acquisition wanted = with_detail(request.acquisition, detail);
  if (!place || place->panorama != request.panorama) {
    place.emplace(LevelRenderer{make_engine(request.panorama, wanted), request.panorama, 0, std::nullopt, nullptr, {}});
  } else if (!(place->engine->acquisition() == wanted)) {
    place->engine->set_acquisition(wanted);
  }
  return *place;
}

double PictureMaker::Impl::LevelRenderer::panorama_share() const noexcept {
  return panorama ? static_cast<const PanoramaEngine&>(*engine).panorama_share() : 0.0;
}

Scanner& PictureMaker::Impl::scanner(std::optional<Scanner>& place, const ScanRequest& request) {
  const bool fits = place && place->raster().columns == request.columns && place->raster().rows == request.rows;
  if (!fits) place.emplace(request.columns, request.rows);
  place->settings = request.display;
  place->artefacts = request.acquisition.artefacts;
  return *place;
}

LineRange PictureMaker::Impl::LevelRenderer::next_lines(const ScanRequest& request, bool is_other_detail) {
  constexpr double kRest_mm = 0.02;
  const int lines = engine->geometry().lines;
  const bool is_whole = request.renewed_share >= 1.0 || is_other_detail || request.flow != nullptr || !last ||
                        is_equivalent(*last, request, kRest_mm);
  last = request;
  if (is_whole) {
    next_line = 0;
    return {};
  }
  if (next_line >= lines) next_line = 0;
  const int first = next_line;
  next_line += std::max(2, static_cast<int>(std::ceil(request.renewed_share * lines)));
  return {first, std::min(next_line, lines)};
}

void PictureMaker::Impl::add_colour(const ScanRequest& request, LevelRenderer& renderer, const BasebandFrame& echoes,
                                    std::uint64_t seed, ScanPicture& picture, CineMetadata& metadata) {
  if (std::exchange(renderer.flow, request.flow) != request.flow) renderer.doppler.emplace(request.flow);
  renderer.doppler->settings = request.doppler;
  metadata.has_doppler = true;
  metadata.doppler_scan = echoes.geometry;
  metadata.doppler_settings = request.doppler;
  metadata.doppler = renderer.doppler->render(
      {request.X_PT, echoes.geometry, echoes.beam, request.time_s, seed, renderer.engine.get(), request.motion});
  picture.colour = renderer.doppler->overlay(picture.gray, picture.raster);
  picture.doppler = request.doppler;
  picture.doppler_scale_cm_per_s = metadata.doppler.scale_cm_per_s;
}

void PictureMaker::Impl::keep(const ScanRequest& request, const ScanPicture& picture, CineMetadata metadata) {
  const Acquisition& a = request.acquisition;
  const ScanGeometry full = make_scan_geometry(transducer, a.depth_mm, a.lines, a.samples);
  if (!cine || !detail::is_same_scan(cine->scan(), full)) {
    const std::size_t frame_bytes = static_cast<std::size_t>(full.lines) * static_cast<std::size_t>(full.samples);
    const auto capacity = static_cast<int>(std::clamp<std::size_t>(kCineBytes / frame_bytes, 1, kCineFrames));
    cine.emplace(full, capacity);
    cine_metadata.assign(static_cast<std::size_t>(capacity), {});
    pushes = 0;
  }
  resample_levels(picture.levels, picture.scan, full, full_levels);
  cine->push(full_levels, request.X_PT, request.time_s, request.display);
  cine_metadata[pushes++ % cine_metadata.size()] = std::move(metadata);
}

PictureMaker::PictureMaker(std::shared_ptr<const AcousticScene> scene, Transducer transducer)
    : impl_(std::make_unique<Impl>()) {
  TROCAR_CHECK(scene != nullptr);
  impl_->scene = std::move(scene);
  impl_->transducer = std::move(transducer);
}
PictureMaker::~PictureMaker() = default;
PictureMaker::PictureMaker(PictureMaker&&) noexcept = default;
PictureMaker& PictureMaker::operator=(PictureMaker&&) noexcept = default;

const Transducer& PictureMaker::transducer() const noexcept {
  return impl_->transducer;
}

ScanPicture PictureMaker::make(const ScanRequest& asked, ScanDetail detail, std::uint64_t seed) {
  Impl& impl = *impl_;
  const ScanRequest request = within_ranges(asked, impl.transducer);
  Impl::LevelRenderer& renderer = impl.renderer(request, detail);
  Scanner& scanner = impl.scanner(impl.scanners[static_cast<std::size_t>(detail)], request);
  // Persistence combines frames of the same kind only: not those of another detail or without colour.
  const bool is_other_detail = impl.last_detail != detail;
  const bool has_colour = request.flow != nullptr;
  if (is_other_detail) scanner.reset();
  if (renderer.doppler && (is_other_detail || !impl.had_colour)) renderer.doppler->reset();
  impl.last_detail = detail;
  impl.had_colour = has_colour;

  std::vector<NeedleEcho> needles;
  if (request.needle_shaft_P.size() >= 2) {
    NeedleEcho needle;
    needle.shaft_P = request.needle_shaft_P;
    needle.diameter_mm = request.needle_diameter_mm;
    needle.displacement_mm = request.tip_shift_mm;
    needle.bore_share = request.needle_bore_share;
    needles.push_back(needle);
  }
  const BasebandFrame& echoes = renderer.engine->render(
      {request.X_PT, needles, request.time_s, renderer.next_lines(request, is_other_detail), false, request.motion});

  ScanPicture picture;
  picture.gray = scanner.show(echoes, seed);
  picture.raster = scanner.raster();
  picture.levels = scanner.levels();
  picture.scan = echoes.geometry;
  picture.X_PT = request.X_PT;
  picture.time_s = request.time_s;
  picture.corners_P = corners_P(picture.raster, picture.X_PT);
  picture.acquisition = request.acquisition;
  picture.display = request.display;
  picture.detail = detail;
  picture.coupled_share = trocar::ultrasound::coupled_share(echoes);
  picture.panorama_share = renderer.panorama_share();
  set_unscanned(*impl.scene, picture);
  for (int line = 0; line < echoes.geometry.lines; ++line)
    picture.pressed_mm.push_back(renderer.engine->sound_path(line).pressed_mm);
  picture.dent_reach_mm = find_dent_reach_mm(*impl.scene, echoes.geometry, request.X_PT);

  Impl::CineMetadata metadata{detail, picture.coupled_share, picture.pressed_mm, picture.dent_reach_mm, false, {}, {},
                              {}};
  if (has_colour) impl.add_colour(request, renderer, echoes, seed, picture, metadata);
  if (!impl.cine || !impl.cine->is_frozen()) impl.keep(request, picture, std::move(metadata));
  return picture;
}

CineLoop* PictureMaker::cine() noexcept {
  return impl_->cine ? &*impl_->cine : nullptr;
}

ScanPicture PictureMaker::show_kept(const ScanRequest& asked) {
  Impl& impl = *impl_;
  TROCAR_CHECK(impl.cine && impl.cine->size() > 0);
  ScanRequest request = within_ranges(asked, impl.transducer);
  const int position = impl.cine->position();
  const CineFrame frame = impl.cine->frame(position);
  const Impl::CineMetadata& metadata = impl.metadata(position);
  Scanner& scanner = impl.scanner(impl.kept_scanner, request);

  ScanPicture picture;
  picture.gray = scanner.show_levels(frame.levels, impl.cine->scan());
  picture.raster = scanner.raster();
  picture.scan = impl.cine->scan();
  picture.levels.assign(frame.levels.begin(), frame.levels.end());
  picture.X_PT = frame.X_PT;
  picture.time_s = frame.time_s;
  picture.corners_P = corners_P(picture.raster, picture.X_PT);
  picture.acquisition = request.acquisition;
  picture.acquisition.depth_mm = picture.scan.depth_mm;
  picture.display = request.display;
  picture.display.tgc_db = frame.settings.tgc_db;
  picture.detail = metadata.detail;
  picture.coupled_share = metadata.coupled_share;
  set_unscanned(*impl.scene, picture);
  picture.pressed_mm = metadata.pressed_mm;
  picture.dent_reach_mm = metadata.dent_reach_mm;
  picture.is_frozen = true;
  if (metadata.has_doppler && request.flow) {
    picture.doppler = metadata.doppler_settings;
    // Settings that can still change for a stored colour frame.
    picture.doppler.baseline = request.doppler.baseline;
    picture.doppler.is_inverted = request.doppler.is_inverted;
    picture.doppler.write_priority = request.doppler.write_priority;
    picture.doppler_scale_cm_per_s = metadata.doppler.scale_cm_per_s;
    impl.kept_colours.forget();
    picture.colour = impl.kept_colours.convert(picture.gray, picture.raster, metadata.doppler_scan, metadata.doppler,
                                               picture.doppler);
  }
  return picture;
}

}  // namespace trocar::ultrasound
