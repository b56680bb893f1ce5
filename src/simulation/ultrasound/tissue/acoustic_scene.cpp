#include "ultrasound/tissue/acoustic_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/parallel.h"
#include "core/result.h"
#include "ultrasound/tissue/detail/slice_blend.h"
#include "ultrasound/tissue/detail/strands.h"
#include "ultrasound/tissue/detail/tissue_volume.h"
#include "ultrasound/tissue/detail/tissue_votes.h"
#include "volume/sampling.h"

namespace trocar::ultrasound {
namespace {

constexpr double kAirMargin_mm = 20.0;   ///< Air around the body: in front of the skin.
constexpr double kSkinSpacing_mm = 2.0;  ///< Of the distance to the skin, which is smooth.
constexpr double kSkin_mm = 2.0;         ///< Thickness of the skin, as TissueTable::skin_thickness_mm.
/// Assumed: reduces a CT's noise but keeps vessels of 3 mm. With the mean over a cell in a scan it is 1.2 mm.
constexpr double kTextureSigma_mm = 1.1;
/// A grid finer than this fraction of the CT's voxels adds no detail.
constexpr double kLeastShareOfVoxel = 0.5;

/// Grid of cubes over the window's voxels, to their outer faces.
volume::GridGeometry cubic_geometry(const volume::GridGeometry& window, double spacing_mm, bool is_at_faces) {
  volume::GridGeometry grid = window;
  grid.spacing_mm.setConstant(spacing_mm);
  Vec3 first_index;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double extent_mm = window.spacing_mm[axis] * static_cast<double>(window.size[a]);
    const auto cells = static_cast<std::int64_t>(std::ceil(extent_mm / spacing_mm - 1e-6));
    grid.size[a] = cells + (is_at_faces ? 1 : 0);
    const double first_mm = 0.5 * (extent_mm - spacing_mm * static_cast<double>(grid.size[a] - 1));
    first_index[axis] = first_mm / window.spacing_mm[axis] - 0.5;
  }
  grid.origin_P = window.to_mm(first_index);
  return grid;
}

/// 1-2-1 along one axis; the end values continue outside.
void smooth_along(volume::FloatGrid& grid, std::size_t axis) {
  const volume::FloatGrid before = grid;
  const std::int64_t last = grid.geometry.size[axis] - 1;
  parallel_for(grid.voxels.size(), 1 << 14, [&](std::size_t from, std::size_t to) {
    for (std::size_t n = from; n < to; ++n) {
      volume::Index3 low = grid.geometry.index_of(n);
      volume::Index3 high = low;
      low[axis] = std::max<std::int64_t>(low[axis] - 1, 0);
      high[axis] = std::min(high[axis] + 1, last);
      grid.voxels[n] = 0.25F * before[low] + 0.5F * before.voxels[n] + 0.25F * before[high];
    }
  });
}

/// Distance to the skin on a grid of 2 mm, without the voxel steps of a mask (standard deviation of the kernel 1.4 mm;
/// a ball's surface of radius r moves inwards by 2 mm²/r).
volume::FloatGrid smooth_skin_distance(const volume::FloatGrid& source, const volume::GridGeometry& window) {
  volume::FloatGrid skin(cubic_geometry(window, kSkinSpacing_mm, true));
  parallel_for(skin.voxels.size(), 1 << 12, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      const volume::Index3 ijk = skin.geometry.index_of(n);
      const Vec3 index = volume::to_vec3(ijk);
      skin.voxels[n] = static_cast<float>(volume::sample_linear(source, skin.geometry.to_mm(index)));
    }
  });
  for (std::size_t axis = 0; axis < 3; ++axis) smooth_along(skin, axis);
  return skin;
}

/// Rows of a coarse grid with the same axes, at the rows of a finer one.
class RowSampler {
 public:
  RowSampler(const volume::FloatGrid& coarse, const volume::GridGeometry& fine)
      : coarse_(coarse), offset_(coarse.geometry.to_index(fine.origin_P)), line_(line_size(coarse)) {
    step_ = fine.spacing_mm.cwiseQuotient(coarse.geometry.spacing_mm);
  }

  /// Values along the row (j, k) of the finer grid.
  void sample(std::int64_t j, std::int64_t k, std::vector<float>& out) {
    const auto [j0, j1, share_j] = neighbours(1, j);
    const auto [k0, k1, share_k] = neighbours(2, k);
    const auto fj = static_cast<float>(share_j), fk = static_cast<float>(share_k);
    const float* rows[4] = {row(j0, k0), row(j1, k0), row(j0, k1), row(j1, k1)};
    for (std::size_t n = 0; n < line_.size(); ++n) {
      const float low = rows[0][n] + fj * (rows[1][n] - rows[0][n]);
      const float high = rows[2][n] + fj * (rows[3][n] - rows[2][n]);
      line_[n] = low + fk * (high - low);
    }
    for (std::size_t i = 0; i < out.size(); ++i) {
      const auto [i0, i1, share_i] = neighbours(0, static_cast<std::int64_t>(i));
      const auto fi = static_cast<float>(share_i);
      const float low = line_[static_cast<std::size_t>(i0)];
      out[i] = low + fi * (line_[static_cast<std::size_t>(i1)] - low);
    }
  }

 private:
  static std::size_t line_size(const volume::FloatGrid& grid) {
    return static_cast<std::size_t>(grid.geometry.size[0]);
  }
  const float* row(std::int64_t j, std::int64_t k) const {
    return coarse_.voxels.data() + coarse_.geometry.offset({0, j, k});
  }
  volume::Neighbours neighbours(std::size_t axis, std::int64_t n) const {
    const auto a = static_cast<Eigen::Index>(axis);
    return volume::neighbours(offset_[a] + static_cast<double>(n) * step_[a], coarse_.geometry.size[axis]);
  }

  const volume::FloatGrid& coarse_;
  Vec3 offset_;
  Vec3 step_;
  std::vector<float> line_;
};

std::array<std::pair<std::int64_t, float>, 2> weighted(const volume::Neighbours& n) noexcept {
  const auto share = static_cast<float>(n.share);
  return {{{n.low, 1.0F - share}, {n.high, share}}};
}

/// Fills target slices one by one, each from the two adjacent source slices.
class SceneSlices {
 public:
  SceneSlices(const detail::TissueVolume& source, const volume::FloatGrid& skin, std::uint8_t skin_tissue,
              std::uint8_t inner_tissue, AcousticScene& scene)
      : source_(source),
        scene_(scene),
        skin_tissue_(skin_tissue),
        inner_tissue_(inner_tissue),
        offset_(source.geometry.to_index(scene.geometry.origin_P)),
        step_(scene.geometry.spacing_mm.cwiseQuotient(source.geometry.spacing_mm)),
        skin_rows_(skin, scene.geometry),
        blend_(source),
        votes_(source.geometry.size[0], source.geometry.size[1], taps(0), taps(1)),
        distance_mm_(static_cast<std::size_t>(scene.geometry.size[0])) {
    for (std::int64_t i = 0; i < scene.geometry.size[0]; ++i)
      columns_.push_back(volume::neighbours(offset_[0] + static_cast<double>(i) * step_[0], source.geometry.size[0]));
  }

  void fill(std::int64_t k) {
    across_ = volume::neighbours(offset_[2] + static_cast<double>(k) * step_[2], source_.geometry.size[2]);
    if (across_.low != slice_) blend_.set_slices(across_.low);
    slice_ = across_.low;
    blend_.blend(static_cast<float>(across_.share), tissue_);
    votes_.set_slice(tissue_);
    for (std::int64_t j = 0; j < scene_.geometry.size[1]; ++j) fill_row(j, k);
  }

 private:
  detail::AxisTaps taps(std::size_t axis) const {
    const auto a = static_cast<Eigen::Index>(axis);
    return detail::make_taps(source_.geometry.size[axis], scene_.geometry.size[axis], offset_[a], step_[a]);
  }

  void fill_row(std::int64_t j, std::int64_t k) {
    skin_rows_.sample(j, k, distance_mm_);
    along_v_ = volume::neighbours(offset_[1] + static_cast<double>(j) * step_[1], source_.geometry.size[1]);
    const std::size_t row = scene_.geometry.offset({0, j, k});
    for (std::size_t i = 0; i < distance_mm_.size(); ++i) {
      const auto distance_mm = static_cast<double>(distance_mm_[i]);
      if (distance_mm >= 0.0) continue;  // air
      std::uint8_t tissue = votes_.winner(i, static_cast<std::size_t>(j));
      if (tissue == detail::kNoTissue) tissue = inner_tissue_;
      scene_.texture[row + i] = texture(columns_[i], tissue);
      scene_.tissue[row + i] = distance_mm > -kSkin_mm ? skin_tissue_ : tissue;
    }
  }

  /// Linear between the surrounding source voxels of the tissue.
  std::int8_t texture(const volume::Neighbours& along_u, std::uint8_t tissue) const {
    float sum = 0.0F;
    float weight = 0.0F;
    for (const auto& [w, share_w] : weighted(across_)) {
      const std::uint8_t* tissues = source_.tissue_slice(w);
      const std::int8_t* textures = source_.texture_slice(w);
      for (const auto& [v, share_v] : weighted(along_v_)) {
        for (const auto& [u, share_u] : weighted(along_u)) {
          const std::int64_t n = v * source_.geometry.size[0] + u;
          const float share = tissues[n] == tissue ? share_u * share_v * share_w : 0.0F;
          sum += share * static_cast<float>(textures[n]);
          weight += share;
        }
      }
    }
    return weight > 0.0F ? static_cast<std::int8_t>(std::lround(sum / weight)) : std::int8_t{0};
  }

  const detail::TissueVolume& source_;
  AcousticScene& scene_;
  std::uint8_t skin_tissue_, inner_tissue_;
  Vec3 offset_, step_;  ///< Target voxel n lies at source index offset + n * step.
  RowSampler skin_rows_;
  detail::SliceBlend blend_;
  detail::TissueVotes votes_;
  std::vector<float> distance_mm_;
  std::vector<volume::Neighbours> columns_;
  volume::Neighbours along_v_{}, across_{};
  std::int64_t slice_ = -1;
  std::vector<std::uint8_t> tissue_;
};

Status check_table(const AcousticTable& table) {
  if (table.tissues.size() > 127)
    return fail(fmt::format("{} tissues exceed the limit of a scene", table.tissues.size()), "acoustic table",
                "use at most 127");
  if (!table.find("skin") || !table.find("adipose"))
    return fail("the acoustic table has no tissue \"skin\" or \"adipose\"", "acoustic table", "add it to the table");
  return {};
}

}  // namespace

Status check_acoustic_scene(const anatomy::VirtualPatient& patient, const AcousticTable& table) {
  TROCAR_TRY_STATUS(check_table(table));
  TROCAR_TRY_STATUS(detail::find_body_window(patient, kAirMargin_mm));
  return detail::check_tissues(patient.label_table, table);
}

Result<std::shared_ptr<const AcousticScene>> make_acoustic_scene(const anatomy::VirtualPatient& patient,
                                                                 AcousticTable table,
                                                                 const AcousticSceneOptions& options,
                                                                 const Progress& progress) {
  TROCAR_TRY_STATUS(check_table(table));
  const auto skin_tissue = table.find("skin");
  const auto inner_tissue = table.find("adipose");

  report(progress, "acoustic tissues", 0.0);
  TROCAR_TRY(const detail::BodyWindow window, detail::find_body_window(patient, kAirMargin_mm));
  TROCAR_TRY(detail::TissueVolume source, detail::make_tissue_volume(patient, window, table));
  report(progress, "texture", 0.1);
  detail::make_texture(patient, window, kTextureSigma_mm, source);

  report(progress, "acoustic scene", 0.4);
  auto scene = std::make_shared<AcousticScene>();
  scene->ends = find_scan_ends(patient);
  scene->motion = patient.motion;
  scene->skin_distance_mm = smooth_skin_distance(patient.skin_distance_mm, window.geometry);
  const double voxel_mm = std::min(source.geometry.spacing_mm[0], source.geometry.spacing_mm[1]);
  const double spacing_mm = std::max(options.spacing_mm, kLeastShareOfVoxel * voxel_mm);
  scene->geometry = cubic_geometry(window.geometry, spacing_mm, false);
  scene->table = std::move(table);
  scene->tissue.assign(scene->geometry.voxel_count(), 0);
  scene->texture.assign(scene->geometry.voxel_count(), 0);
  parallel_for(static_cast<std::size_t>(scene->geometry.size[2]), 8, [&](std::size_t first, std::size_t last) {
    SceneSlices slices(source, scene->skin_distance_mm, *skin_tissue, *inner_tissue, *scene);
    for (std::size_t k = first; k < last; ++k) slices.fill(static_cast<std::int64_t>(k));
  });
  detail::add_kidney_parts(*scene);
  report(progress, "borders", 0.9);
  mark_mixed_cells(*scene);
  detail::add_strands(*scene);
  report(progress, "acoustic scene", 1.0);
  return scene;
}

void mark_mixed_cells(AcousticScene& scene) {
  const volume::Index3& size = scene.geometry.size;
  TROCAR_CHECK(scene.tissue.size() == scene.geometry.voxel_count());
  constexpr auto kTissue = static_cast<std::uint8_t>(~kMixedCell);
  std::vector<std::uint8_t> marked(scene.tissue.size());
  parallel_for(static_cast<std::size_t>(size[1] * size[2]), 64, [&](std::size_t first, std::size_t last) {
    const auto width = static_cast<std::size_t>(size[0]);
    std::vector<std::uint8_t> differs(width + 1, 0);
    for (std::size_t row = first; row < last; ++row) {
      const std::uint8_t* own = scene.tissue.data() + row * width;
      const auto j = static_cast<std::int64_t>(row) % size[1];
      const auto k = static_cast<std::int64_t>(row) / size[1];
      // At the grid's far faces the last voxels continue.
      const std::size_t next_j = j + 1 < size[1] ? width : 0;
      const std::size_t next_k = k + 1 < size[2] ? width * static_cast<std::size_t>(size[1]) : 0;
      for (std::size_t i = 0; i < width; ++i)
        differs[i] = static_cast<std::uint8_t>((own[i] ^ own[i + next_j]) | (own[i] ^ own[i + next_k]) |
                                               (own[i] ^ own[i + next_j + next_k]));
      std::uint8_t* out = marked.data() + row * width;
      for (std::size_t i = 0; i < width; ++i) {
        const std::size_t next = i + 1 < width ? 1 : 0;
        const auto any =
            static_cast<std::uint8_t>((differs[i] | differs[i + next] | (own[i] ^ own[i + next])) & kTissue);
        out[i] = static_cast<std::uint8_t>((own[i] & kTissue) | (any != 0 ? kMixedCell : 0));
      }
    }
  });
  scene.tissue = std::move(marked);
}

}  // namespace trocar::ultrasound
