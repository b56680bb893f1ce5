#include "ultrasound/engine/detail/needle_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace trocar::ultrasound::detail {
namespace {

/// Adds an echo to a scanline, between two samples.
void put(const ScanPlan& plan, FrameState& frame, std::size_t row, float shown, float re, float im) noexcept {
  if (!(shown >= 0.0F && shown < static_cast<float>(plan.samples - 1))) return;
  const auto sample = static_cast<std::size_t>(shown);
  const float part = shown - static_cast<float>(sample);
  float* const to_re = frame.re.data() + row + sample;
  float* const to_im = frame.im.data() + row + sample;
  to_re[0] += (1.0F - part) * re;
  to_re[1] += part * re;
  to_im[0] += (1.0F - part) * im;
  to_im[1] += part * im;
}

/// Path of a needle's echo on one scanline: sample `shown`, amplitude `gain`; false if there is no echo.
struct Way {
  float shown, gain;
};
bool find_way(const ScanPlan& plan, const FrameState& frame, int line, float walk, Way& way) noexcept {
  // Sound does not reach the space behind a mirror.
  const float depth_mm = (walk + 0.5F) * plan.sample_mm;
  const auto at_line = static_cast<std::size_t>(line);
  if (depth_mm > frame.walks[at_line].mirror_depth_mm) return false;
  const std::size_t at = at_line * static_cast<std::size_t>(plan.samples) + static_cast<std::size_t>(walk);
  way = {walk + frame.delay[at], frame.way_gain[at]};
  return true;
}

class Painter {
 public:
  Painter(const ScanPlan& plan, FrameState& frame, const NeedleImage::Part& part, int first, int last) noexcept
      : plan_(plan), frame_(frame), part_(part), first_(first), last_(last) {
    repeats_ = plan.acquisition.artefacts.reverberation ? kRepeats : 0;
    const auto sigma = static_cast<float>(plan.beam.axial_sigma_mm) / plan.sample_mm;
    inverse_variance_ = 1.0F / (sigma * sigma);
  }

  void paint(const ShaftPiece& piece) noexcept {
    paint_on_lines(piece.line, piece.walk, [&](std::size_t row, const Way& way, float part) {
      // The echo is split between two samples. This reduces the pulse height between them, which is compensated unless
      // other pieces at different depths do so.
      const float offset = way.shown - std::floor(way.shown);
      const float height = (1.0F - offset) * std::exp(-0.5F * inverse_variance_ * offset * offset) +
                           offset * std::exp(-0.5F * inverse_variance_ * (1.0F - offset) * (1.0F - offset));
      float echo = part * way.gain * piece.echo;
      put(plan_, frame_, row, way.shown, echo * std::lerp(1.0F, 1.0F / height, piece.level), 0.0F);
      echo *= piece.ring;
      if (piece.ring < 1e-3F) return;
      for (int k = 1; k <= repeats_; ++k) {
        echo *= static_cast<float>(kRepeatShare);
        put(plan_, frame_, row, way.shown + static_cast<float>(k) * part_.repeat_samples, echo, 0.0F);
      }
    });
  }

  void paint(const ShaftGrain& grain) noexcept {
    constexpr int kGrainRepeats = 4;
    paint_on_lines(grain.line, grain.walk, [&](std::size_t row, const Way& way, float part) {
      float echo = part * way.gain * grain.echo;
      const float turn = 2.0F * std::numbers::pi_v<float> * (grain.turn + way.shown * plan_.cycles_per_sample);
      const float re = std::cos(turn), im = -std::sin(turn);
      for (int k = 0; k <= std::min(repeats_, kGrainRepeats); ++k) {
        put(plan_, frame_, row, way.shown + static_cast<float>(k) * part_.repeat_samples, echo * re, echo * im);
        echo *= static_cast<float>(kRepeatShare) * (k == 0 ? grain.ring : 1.0F);
      }
    });
  }

 private:
  template <class Put>
  void paint_on_lines(float at_line, float walk, const Put& put_echo) noexcept {
    const float floor_line = std::floor(at_line);
    const int line = static_cast<int>(floor_line);
    if (line + 1 < first_ || line >= last_) return;
    for (int side = 0; side < 2; ++side) {
      if (line + side < first_ || line + side >= last_) continue;
      const float part = side == 0 ? 1.0F - (at_line - floor_line) : at_line - floor_line;
      Way way;
      if (!find_way(plan_, frame_, line + side, walk, way)) continue;
      put_echo(plan_.echo_row(line + side), way, part);
    }
  }

  const ScanPlan& plan_;
  FrameState& frame_;
  const NeedleImage::Part& part_;
  int first_, last_;
  int repeats_;
  float inverse_variance_;
};

/// The piece that covers most of a scanline's beam.
struct Cover {
  float miss2 = std::numeric_limits<float>::infinity();
  const ShaftPiece* piece = nullptr;
};

/// Remaining amplitude, both ways, of an echo from `depth_mm` behind a piece.
float behind(const ScanPlan& plan, const Cover& cover, float diameter_mm, float depth_mm) noexcept {
  const ShaftPiece& piece = *cover.piece;
  // The wider the aperture seen from behind, the smaller the part blocked by a strip across the image.
  const float aperture_mm =
      std::min(depth_mm / static_cast<float>(plan.beam.f_number), static_cast<float>(plan.beam.aperture_mm));
  const float piece_mm = (piece.walk + 0.5F) * plan.sample_mm;
  const float cone_mm =
      static_cast<float>(kGaussianAperture) * aperture_mm * std::max(0.0F, 1.0F - piece_mm / depth_mm);
  const float sigma2 = piece.strip_sigma2_mm2 + piece.strip_lateral * cone_mm * cone_mm;
  const float covered = std::erf(diameter_mm / (2.0F * std::sqrt(2.0F * sigma2))) *
                        std::exp(-0.5F * cover.miss2 * piece.strip_sigma2_mm2 / sigma2);
  const float left = 1.0F - static_cast<float>(kShadowShare) * piece.cover * covered;
  return left * left;
}

void darken(const ScanPlan& plan, FrameState& frame, int line, const Cover& cover, float diameter_mm) noexcept {
  constexpr float kInPlane = 0.01F;  // a shaft along the image plane: its shadow is not filled in
  const auto samples = static_cast<std::size_t>(plan.samples);
  const auto at_line = static_cast<std::size_t>(line);
  const auto begin = static_cast<int>(cover.piece->walk + diameter_mm / plan.sample_mm) + 1;
  const int step = cover.piece->strip_lateral < kInPlane ? plan.samples : kCoarse;
  for (int s = begin; s < plan.samples; s += step) {
    const int end = std::min(s + step, plan.samples);
    const auto at = static_cast<std::size_t>(s), n = static_cast<std::size_t>(end - s);
    const float left = behind(plan, cover, diameter_mm, 0.5F * static_cast<float>(s + end) * plan.sample_mm);
    const auto fade = [&](float* values) {
      for (std::size_t k = 0; k < n; ++k) values[k] *= left;
    };
    const float neper = -std::log(std::max(left, 1e-6F));
    for (int plane = 0; plane < plan.planes; ++plane) {
      if (plan.walked_line(plane, line) != line) continue;
      ScattererGain* gains = frame.gain.data() + static_cast<std::size_t>(plan.row_of(plane, line)) * samples + at;
      for (std::size_t k = 0; k < n; ++k) gains[k] = attenuate(gains[k], neper);
    }
    fade(frame.way_gain.data() + at_line * samples + at);
    const std::size_t row = plan.echo_row(line) + at;
    fade(frame.re.data() + row);
    fade(frame.im.data() + row);
  }
}

/// Attenuates borders and scatterers behind a needle.
void cast_shadow(const ScanPlan& plan, FrameState& frame, const NeedleImage& image, const NeedleImage::Part& part,
                 int first, int last) noexcept {
  constexpr float kReach = 3.0F;  // sigmas
  std::array<Cover, kGroup> covers{};
  for (std::size_t p = part.first_piece; p < part.last_piece; ++p) {
    const ShaftPiece& piece = image.pieces[p];
    const float reach = kReach / piece.line_sigmas;
    const int low = std::max(first, static_cast<int>(std::ceil(piece.line - reach)));
    const int high = std::min(last - 1, static_cast<int>(std::floor(piece.line + reach)));
    for (int line = low; line <= high; ++line) {
      const float lines_off = std::abs(static_cast<float>(line) - piece.line);
      const float aside = std::max(0.0F, lines_off - piece.half_lines) * piece.line_sigmas;
      const float miss2 = aside * aside + piece.miss2;
      Cover& cover = covers[static_cast<std::size_t>(line - first)];
      if (miss2 < cover.miss2) cover = {miss2, &piece};
    }
  }
  for (int line = first; line < last; ++line) {
    const Cover& cover = covers[static_cast<std::size_t>(line - first)];
    if (cover.piece != nullptr && cover.miss2 < kReach * kReach) darken(plan, frame, line, cover, part.diameter_mm);
  }
}

}  // namespace

void add_needles(const ScanPlan& plan, FrameState& frame, const NeedleImage& image, int first, int last) noexcept {
  const std::span<const NeedleImage::Part> parts(image.parts.data(), image.count);
  if (plan.acquisition.artefacts.attenuation)
    for (const auto& part : parts) cast_shadow(plan, frame, image, part, first, last);
  for (const auto& part : parts) {
    Painter painter(plan, frame, part, first, last);
    for (std::size_t p = part.first_piece; p < part.last_piece; ++p) painter.paint(image.pieces[p]);
    for (std::size_t g = part.first_grain; g < part.last_grain; ++g) painter.paint(image.grains[g]);
  }
}

}  // namespace trocar::ultrasound::detail
