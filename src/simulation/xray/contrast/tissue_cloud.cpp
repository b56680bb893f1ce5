#include "xray/contrast/tissue_cloud.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/result.h"
#include "volume/resample.h"
#include "volume/sampling.h"
#include "xray/contrast/contrast_table.h"

namespace trocar::xray {
namespace {

constexpr std::int64_t kGrowth = 8;        ///< Voxels by which the window grows at a time, at least.
constexpr double kShown_mg_per_ml = 5e-3;  ///< Less does not spread: 0.1 mg/cm² in 20 cm, below the noise.
constexpr double kStability = 0.16;        ///< Largest mixing * step / spacing² of explicit diffusion (limit: 1/6).
constexpr double kSameTip_mm = 0.5;        ///< A tip that moves less fills the same place.
constexpr double kSeedReach_mm = 5.0;      ///< Around the tip, in which the organ's nearest voxel is looked for.
constexpr double kFarFront_mm = 1e5;       ///< A front from which all voxels are full.

volume::Index3 sum(const volume::Index3& a, const volume::Index3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

bool is_fluid(const ContrastMedium& medium) {
  return medium.place == ContrastPlace::kFluid || medium.place == ContrastPlace::kBowel;
}

/// Voxels of the lattice within kSeedReach_mm along an axis.
std::int64_t seed_reach(const volume::GridGeometry& lattice) {
  return static_cast<std::int64_t>(kSeedReach_mm / lattice.spacing_mm[0]);
}

volume::Index3 nearest_index(const volume::GridGeometry& g, const Vec3& p_P) {
  const Vec3 index = g.to_index(p_P);
  volume::Index3 at;
  for (std::size_t a = 0; a < 3; ++a)
    at[a] = std::clamp<std::int64_t>(std::llround(index[static_cast<Eigen::Index>(a)]), 0, g.size[a] - 1);
  return at;
}

}  // namespace

TissueCloud::TissueCloud(std::shared_ptr<const anatomy::VirtualPatient> patient, const ContrastTable& table,
                         double spacing_mm)
    : patient_(std::move(patient)),
      media_(table.media),
      lattice_(volume::isotropic_geometry(patient_->labels.geometry, spacing_mm)) {
  TROCAR_CHECK(spacing_mm >= 1.0 && spacing_mm <= 5.0);
  organ_of_label_ = anatomy::lesions_as_organs(patient_->label_table);
  medium_of_organ_.fill(static_cast<std::uint8_t>(media_.size() - 1));
  has_medium_.fill(true);
  for (const anatomy::Label& label : patient_->label_table.labels) {
    medium_of_organ_[label.id] = static_cast<std::uint8_t>(table.medium_of(label.tissue));
    has_medium_[label.id] = label.tissue != "bile_duct" && label.tissue != "vessel";
  }
}

TissueCloud::Organ TissueCloud::organ_at(const Vec3& p_P) const {
  const std::uint8_t label = volume::sample_nearest<std::uint8_t>(patient_->labels, p_P, 0);
  if (label != 0) return has_medium_[label] ? Organ{organ_of_label_[label]} : kNoOrgan;
  const bool is_inside = !patient_->skin_distance_mm.empty() &&
                         volume::sample_nearest<float>(patient_->skin_distance_mm, p_P, 1.0F) < 0.0F;
  return is_inside ? Organ{0} : kNoOrgan;
}

/// At a speck of a label without medium: the organ of the nearest point of a small cube that has one.
TissueCloud::Organ TissueCloud::organ_near(const Vec3& p_P) const {
  Organ best = organ_at(p_P);
  double best_mm = std::numeric_limits<double>::infinity();
  if (best != kNoOrgan) return best;
  const std::int64_t reach = seed_reach(lattice_);
  for (std::int64_t k = -reach; k <= reach; ++k)
    for (std::int64_t j = -reach; j <= reach; ++j)
      for (std::int64_t i = -reach; i <= reach; ++i) {
        const Vec3 away = volume::to_vec3({i, j, k}).cwiseProduct(lattice_.spacing_mm);
        const Organ organ = organ_at(p_P + away);
        if (organ == kNoOrgan || away.norm() >= best_mm) continue;
        best_mm = away.norm();
        best = organ;
      }
  return best;
}

const ContrastMedium* TissueCloud::medium_at(const Vec3& p_P) const {
  const Organ organ = p_P.allFinite() ? organ_at(p_P) : kNoOrgan;
  return organ == kNoOrgan ? nullptr : &medium_of(static_cast<std::uint8_t>(organ));
}

std::size_t TissueCloud::offset_in(const Box& box, const volume::Index3& at) {
  const volume::Index3& low = box[0];
  const std::int64_t nx = box[1][0] - low[0] + 1, ny = box[1][1] - low[1] + 1;
  return static_cast<std::size_t>(((at[2] - low[2]) * ny + at[1] - low[1]) * nx + at[0] - low[0]);
}

/// Grows the window so that it contains a voxel and its neighbours (within the lattice).
void TissueCloud::include(const volume::Index3& at) {
  Box wanted = is_used_ ? window_ : Box{at, at};
  bool is_enough = is_used_;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::int64_t low = std::max<std::int64_t>(at[a] - 1, 0);
    const std::int64_t high = std::min(at[a] + 1, lattice_.size[a] - 1);
    const std::int64_t growth = std::max(kGrowth, (wanted[1][a] - wanted[0][a]) / 4);
    if (low < wanted[0][a]) wanted[0][a] = std::max<std::int64_t>(low - growth, 0);
    if (high > wanted[1][a]) wanted[1][a] = std::min(high + growth, lattice_.size[a] - 1);
    is_enough = is_enough && wanted[0][a] == window_[0][a] && wanted[1][a] == window_[1][a];
  }
  if (is_enough) return;
  const Box old_window = std::exchange(window_, wanted);
  const std::vector<double> old_mg = std::move(iodine_mg_), old_ml = std::move(fluid_ml_);
  const std::vector<Organ> old_organ = std::move(organ_);
  std::size_t count = 1;
  for (std::size_t a = 0; a < 3; ++a) count *= static_cast<std::size_t>(window_[1][a] - window_[0][a] + 1);
  iodine_mg_.assign(count, 0.0);
  fluid_ml_.assign(count, 0.0);
  change_mg_.assign(count, 0.0);
  organ_.assign(count, kNoOrgan);
  std::size_t n = 0;
  for (std::int64_t k = window_[0][2]; k <= window_[1][2]; ++k)
    for (std::int64_t j = window_[0][1]; j <= window_[1][1]; ++j)
      for (std::int64_t i = window_[0][0]; i <= window_[1][0]; ++i, ++n) {
        const volume::Index3 voxel{i, j, k};
        bool was_inside = is_used_;
        for (std::size_t a = 0; a < 3; ++a)
          was_inside = was_inside && voxel[a] >= old_window[0][a] && voxel[a] <= old_window[1][a];
        if (was_inside) {
          const std::size_t m = offset_in(old_window, voxel);
          iodine_mg_[n] = old_mg[m];
          fluid_ml_[n] = old_ml[m];
          organ_[n] = old_organ[m];
        } else {
          organ_[n] = organ_at(lattice_.centre_mm(voxel));
        }
      }
  if (!is_used_) active_ = {at, at};
  is_used_ = true;
  is_mixed_.assign(count, 0);
  faces_.clear();
  // In the order of memory, which makes the diffusion faster.
  std::sort(mixed_.begin(), mixed_.end(),
            [this](const Mixed& a, const Mixed& b) { return offset(a.at) < offset(b.at); });
  for (const Mixed& voxel : mixed_) link(voxel.at);
}

/// Marks a voxel of fluid and adds its faces to the neighbours that are marked.
void TissueCloud::link(const volume::Index3& at) {
  const std::size_t n = offset(at);
  is_mixed_[n] = 1;
  for (const volume::Index3& step : detail::kNeighbours) {
    const volume::Index3 to = sum(at, step);
    if (!lattice_.contains(to)) continue;
    const std::size_t m = offset(to);
    if (is_mixed_[m] != 0 && organ_[m] == organ_[n])
      faces_.push_back({static_cast<std::uint32_t>(n), static_cast<std::uint32_t>(m)});
  }
}

/// A voxel of fluid takes part in the diffusion from now on.
void TissueCloud::add_mixed(const volume::Index3& at) {
  include(at);
  if (is_mixed_[offset(at)] != 0) return;
  mixed_.push_back({at, false});
  link(at);
  activate(at);
}

/// The active box contains a voxel from now on.
void TissueCloud::activate(const volume::Index3& at) {
  for (std::size_t a = 0; a < 3; ++a) {
    active_[0][a] = std::min(active_[0][a], at[a]);
    active_[1][a] = std::max(active_[1][a], at[a]);
  }
}

/// The organ's voxel nearest to the tip; a structure thinner than the voxels gets the tip's own voxel.
volume::Index3 TissueCloud::seed_of(const Vec3& tip_P, Organ organ) {
  const volume::Index3 middle = nearest_index(lattice_, tip_P);
  volume::Index3 best = middle;
  double best_mm = std::numeric_limits<double>::infinity();
  const std::int64_t reach = seed_reach(lattice_);
  for (std::int64_t k = -reach; k <= reach; ++k)
    for (std::int64_t j = -reach; j <= reach; ++j)
      for (std::int64_t i = -reach; i <= reach; ++i) {
        const volume::Index3 at = sum(middle, {i, j, k});
        if (!lattice_.contains(at)) continue;
        include(at);
        const double mm = (lattice_.centre_mm(at) - tip_P).norm();
        if (organ_[offset(at)] != organ || mm >= best_mm) continue;
        best_mm = mm;
        best = at;
      }
  include(best);
  organ_[offset(best)] = organ;
  return best;
}

void TissueCloud::start_site(const Vec3& tip_P, Organ organ) {
  if (site_.organ == organ && site_.front_mm > 0.0 && (site_.tip_P - tip_P).norm() < kSameTip_mm) return;
  const ContrastMedium& medium = medium_of(static_cast<std::uint8_t>(organ));
  const volume::Index3 seed = seed_of(tip_P, organ);
  site_ = {tip_P, organ, lattice_.spacing_mm[0], detail::StainSite(lattice_, tip_P, seed, medium)};
}

/// Appends the next voxel of the site's organ; false if the organ has no more.
bool TissueCloud::expand_site() {
  const auto is_same_organ = [this](const volume::Index3& at) {
    include(at);
    return organ_[offset(at)] == site_.organ;
  };
  return site_.way.expand(is_same_organ, [this](const volume::Index3& at) { return is_tract(at); });
}

/// Whether a voxel borders on a vessel or duct.
bool TissueCloud::is_tract(const volume::Index3& at) {
  for (const volume::Index3& step : detail::kNeighbours) {
    const volume::Index3 to = sum(at, step);
    if (lattice_.contains(to) && organ_[offset(to)] == kNoOrgan) return true;
  }
  return false;
}

void TissueCloud::inject(const Vec3& tip_P, double ml, double iodine_mg_per_ml) {
  const Organ organ = organ_near(tip_P);
  if (organ == kNoOrgan) {
    washed_away_mg_ += ml * iodine_mg_per_ml;
    return;
  }
  if (is_fluid(medium_of(static_cast<std::uint8_t>(organ)))) {
    pour(tip_P, organ, ml * iodine_mg_per_ml);
  } else {
    fill(tip_P, organ, ml, iodine_mg_per_ml);
  }
}

bool TissueCloud::is_fluid_near(const Vec3& p_P) const {
  const Organ organ = organ_near(p_P);
  return organ != kNoOrgan && is_fluid(medium_of(static_cast<std::uint8_t>(organ)));
}

/// Volume that the site's voxels lack for the present front, and its growth with the front.
double TissueCloud::wanted_ml(double room_ml, double& ml_per_mm) const {
  double ml = 0.0;
  ml_per_mm = 0.0;
  for (const detail::StainSite::Voxel& voxel : site_.way.voxels()) {
    if (voxel.reach_mm >= site_.front_mm) break;
    const double share = detail::StainSite::share(voxel, site_.front_mm);
    const double lack_ml = room_ml * share - fluid_ml_[offset(voxel.at)];
    if (lack_ml <= 0.0) continue;
    ml += lack_ml;
    ml_per_mm += room_ml * (1.0 - share) * voxel.uptake / voxel.reach_mm;
  }
  return ml;
}

/// Moves the site's front until its voxels lack the volume; returns what they lack, less if the organ is full.
double TissueCloud::move_front(double room_ml, double ml) {
  for (;;) {
    bool has_more = true;
    while (has_more && (site_.way.voxels().empty() || site_.way.voxels().back().reach_mm < site_.front_mm))
      has_more = expand_site();
    double ml_per_mm = 0.0;
    const double wanted = wanted_ml(room_ml, ml_per_mm);
    if (wanted >= ml || (!has_more && site_.front_mm > kFarFront_mm)) return wanted;
    const double least_mm = site_.front_mm * (has_more ? 1e-3 : 1.0), most_mm = std::max(site_.front_mm, least_mm);
    site_.front_mm += std::clamp((ml - wanted) / std::max(ml_per_mm, 1e-12), least_mm, most_mm);
  }
}

/// Fills the room of the voxels, the more the nearer they are to the tip.
void TissueCloud::fill(const Vec3& tip_P, Organ organ, double ml, double iodine_mg_per_ml) {
  start_site(tip_P, organ);
  const double room_ml = medium_of(static_cast<std::uint8_t>(organ)).space * lattice_.voxel_volume_mm3() / kMm3PerMl;
  const double wanted = move_front(room_ml, ml);
  const double part = wanted > ml ? ml / wanted : 1.0;
  double left_ml = ml;
  for (const detail::StainSite::Voxel& voxel : site_.way.voxels()) {
    if (voxel.reach_mm >= site_.front_mm) break;
    const std::size_t v = offset(voxel.at);
    const double lack_ml = room_ml * detail::StainSite::share(voxel, site_.front_mm) - fluid_ml_[v];
    const double part_ml = std::min(part * lack_ml, left_ml);
    if (part_ml <= 0.0) continue;
    if (fluid_ml_[v] <= 0.0) filled_.push_back(voxel.at);
    fluid_ml_[v] += part_ml;
    iodine_mg_[v] += part_ml * iodine_mg_per_ml;
    left_ml -= part_ml;
    activate(voxel.at);
  }
  // Without room: into the blood. Otherwise only rounding is left.
  washed_away_mg_ += left_ml * iodine_mg_per_ml;
}

/// Puts iodine into the fluid at the tip.
void TissueCloud::pour(const Vec3& tip_P, Organ organ, double iodine_mg) {
  const volume::Index3 seed = seed_of(tip_P, organ);
  add_mixed(seed);
  iodine_mg_[offset(seed)] += iodine_mg;
}

void TissueCloud::step(double dt_s) {
  if (!is_used_) return;
  fade(dt_s);
  diffuse(dt_s);
}

void TissueCloud::fade(double dt_s) {
  std::array<double, 256> kept{};
  for (std::size_t organ = 0; organ < kept.size(); ++organ) {
    const ContrastMedium& medium = media_[medium_of_organ_[organ]];
    kept[organ] = medium.fade_s > 0.0 ? std::exp(-dt_s / medium.fade_s) : 1.0;
  }
  for (const volume::Index3& at : filled_) {
    const std::size_t n = offset(at);
    const double rest_mg = iodine_mg_[n] * kept[organ_[n]];
    washed_away_mg_ += iodine_mg_[n] - rest_mg;
    iodine_mg_[n] = rest_mg;
    fluid_ml_[n] *= kept[organ_[n]];
  }
}

void TissueCloud::diffuse(double dt_s) {
  if (mixed_.empty()) return;
  double most = 0.0;
  for (const ContrastMedium& medium : media_) most = std::max(most, medium.mixing_mm2_per_s);
  const double spacing_mm = lattice_.spacing_mm.minCoeff();
  const double longest_s = kStability * spacing_mm * spacing_mm / most;
  const auto steps = static_cast<int>(std::ceil(dt_s / longest_s));
  for (int n = 0; n < steps; ++n) {
    diffuse_once(dt_s / steps);
    spread();
  }
}

/// One explicit step in flux form: each voxel gives to its neighbour what the neighbour gets.
void TissueCloud::diffuse_once(double dt_s) {
  const double spacing_mm = lattice_.spacing_mm.minCoeff();
  std::array<double, 256> share{};
  for (std::size_t organ = 0; organ < share.size(); ++organ)
    share[organ] = media_[medium_of_organ_[organ]].mixing_mm2_per_s * dt_s / (spacing_mm * spacing_mm);
  for (const auto& [n, m] : faces_) {
    const double moved_mg = share[organ_[n]] * (iodine_mg_[n] - iodine_mg_[m]);
    change_mg_[n] -= moved_mg;
    change_mg_[m] += moved_mg;
  }
  for (const Mixed& voxel : mixed_) {
    const std::size_t n = offset(voxel.at);
    iodine_mg_[n] += change_mg_[n];
    change_mg_[n] = 0.0;
  }
}

/// Takes in the neighbours of the voxels at which iodine has arrived.
void TissueCloud::spread() {
  const double least_mg = kShown_mg_per_ml * lattice_.voxel_volume_mm3() / kMm3PerMl;
  std::vector<volume::Index3> reached;
  for (Mixed& voxel : mixed_) {
    if (voxel.has_spread || iodine_mg_[offset(voxel.at)] < least_mg) continue;
    voxel.has_spread = true;
    for (const volume::Index3& step : detail::kNeighbours) {
      const volume::Index3 to = sum(voxel.at, step);
      if (lattice_.contains(to) && organ_[offset(to)] == organ_[offset(voxel.at)]) reached.push_back(to);
    }
  }
  for (const volume::Index3& at : reached) add_mixed(at);
}

double TissueCloud::iodine_mg() const {
  double total = 0.0;
  for (const double mg : iodine_mg_) total += mg;
  return total;
}

double TissueCloud::fluid_ml() const {
  double total = 0.0;
  for (const double ml : fluid_ml_) total += ml;
  return total;
}

double TissueCloud::iodine_mg_in(std::uint8_t label) const {
  double total = 0.0;
  for (std::size_t n = 0; n < organ_.size(); ++n)
    if (organ_[n] == organ_of_label_[label]) total += iodine_mg_[n];
  return total;
}

std::shared_ptr<const volume::FloatGrid> TissueCloud::grid_mg_per_ml() const {
  if (!is_used_) return nullptr;
  volume::GridGeometry geometry = lattice_;
  // One empty voxel around it, so that the grid ends at 0.
  for (std::size_t a = 0; a < 3; ++a) geometry.size[a] = active_[1][a] - active_[0][a] + 3;
  geometry.origin_P = lattice_.to_mm(volume::to_vec3(active_[0]) - Vec3::Ones());
  auto grid = std::make_shared<volume::FloatGrid>(geometry, 0.0F);
  const double ml = lattice_.voxel_volume_mm3() / kMm3PerMl;
  float most = 0.0F;
  for (std::int64_t k = active_[0][2]; k <= active_[1][2]; ++k)
    for (std::int64_t j = active_[0][1]; j <= active_[1][1]; ++j) {
      std::size_t n = offset({active_[0][0], j, k});
      const volume::Index3 first{1, j - active_[0][1] + 1, k - active_[0][2] + 1};
      float* out = grid->voxels.data() + geometry.offset(first);
      for (std::int64_t i = active_[0][0]; i <= active_[1][0]; ++i, ++n, ++out) {
        *out = static_cast<float>(iodine_mg_[n] / ml);
        most = std::max(most, *out);
      }
    }
  return static_cast<double>(most) < kShown_mg_per_ml ? nullptr : grid;
}

}  // namespace trocar::xray
