#include "ultrasound/doppler/detail/vessel_flow_maker.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/parallel.h"
#include "ultrasound/doppler/detail/flow_network.h"
#include "volume/distance.h"
#include "volume/resample.h"
#include "volume/sampling.h"

namespace trocar::ultrasound {
namespace {

constexpr double kJoins_mm =
    6.0;  ///< Length of a vessel counted as part of the vessel that it joins. Assumed, range 3..10.
constexpr double kVesselMargin_mm = 9.0;
constexpr double kMostSpeed_mm_per_s = 3200.0;

/// A point of a branch with lumen, and its neighbours.
struct Owner {
  const VesselBranch* branch;
  std::size_t point;
};

/// Unit tangent of the flow, and distance from the centreline, at a position near one of its points.
struct Nearby {
  Vec3 flow_P;
  double from_middle_mm;
};
Nearby look_nearby(const Owner& owner, const Vec3& p_P) {
  const std::vector<VesselPoint>& points = owner.branch->points;
  const VesselPoint& point = points[owner.point];
  const Vec3 away = p_P - point.p_P;
  const double along_mm = away.dot(point.flow_P);
  Nearby near{point.flow_P, (away - along_mm * point.flow_P).norm()};
  // Towards the neighbour on the side of the position.
  for (const std::ptrdiff_t step : {-1, 1}) {
    const auto n = static_cast<std::ptrdiff_t>(owner.point) + step;
    if (n < 0 || n >= static_cast<std::ptrdiff_t>(points.size())) continue;
    const VesselPoint& next = points[static_cast<std::size_t>(n)];
    const Vec3 way = next.p_P - point.p_P;
    const double length2 = way.squaredNorm();
    const double share = length2 > 1e-12 ? away.dot(way) / length2 : 0.0;
    if (share <= 0.0) continue;
    near.flow_P = (point.flow_P + std::min(share, 1.0) * (next.flow_P - point.flow_P)).normalized();
  }
  return near;
}

/// The point whose tube contains a position most deeply.
const Owner& find_owner(const std::vector<Owner>& owners, const Vec3& p_P) {
  const Owner* best = owners.data();
  double least = std::numeric_limits<double>::infinity();
  for (const Owner& owner : owners) {
    const VesselPoint& point = owner.branch->points[owner.point];
    const double power = (p_P - point.p_P).squaredNorm() - point.radius_mm * point.radius_mm;
    if (power >= least) continue;
    least = power;
    best = &owner;
  }
  return *best;
}

/// The profile extends from the centreline to the actual wall: sections need not be round.
Vec3 velocity_at(const Owner& owner, const Vec3& p_P, double depth_mm) {
  const Nearby near = look_nearby(owner, p_P);
  const double inside_mm = std::max(depth_mm, 0.0);
  const double rho = near.from_middle_mm / std::max(near.from_middle_mm + inside_mm, 1e-6);
  const double speed = owner.branch->points[owner.point].peak_mm_per_s;
  return speed * (1.0 - std::pow(rho, owner.branch->profile_exponent)) * near.flow_P;
}

}  // namespace

VesselFlowMaker::VesselFlowMaker(const anatomy::VirtualPatient& patient, FlowTable table,
                                 const VesselFlowOptions& options)
    : patient_(patient), options_(options), flow_(std::make_shared<VesselFlow>()) {
  VesselFlow& flow = *flow_;
  flow.table_ = std::move(table);
  flow.geometry_ = volume::isotropic_geometry(patient.labels.geometry, options.spacing_mm);
  const Vec3 zero = flow.geometry_.to_index(Vec3::Zero());
  for (std::size_t a = 0; a < 3; ++a) {
    const auto row = static_cast<Eigen::Index>(a);
    flow.brick_count_[a] = static_cast<std::int32_t>((flow.geometry_.size[a] + kBrick - 1) / kBrick);
    for (Eigen::Index c = 0; c < 3; ++c)
      flow.index_of_P_[a][static_cast<std::size_t>(c)] =
          static_cast<float>(flow.geometry_.R_PV(c, row) / flow.geometry_.spacing_mm[row]);
    flow.index_of_origin_[a] = static_cast<float>(zero[row]);
  }
  flow.bricks_.assign(static_cast<std::size_t>(flow.brick_count_[0]) * static_cast<std::size_t>(flow.brick_count_[1]) *
                          static_cast<std::size_t>(flow.brick_count_[2]),
                      -1);
}

/// Vessels connected to the blood flow of this one.
std::array<bool, 256> VesselFlowMaker::find_joining(const anatomy::Label& label) const {
  std::array<bool, 256> joins{};
  for (const anatomy::Label& other : patient_.label_table.labels) {
    const FlowRule* rule = flow_->table_.find(other.name, patient_.label_table);
    joins[other.id] = other.id != label.id && rule != nullptr && is_named(label.name, rule->near);
  }
  return joins;
}

VesselFlowMaker::Box VesselFlowMaker::box_of(const anatomy::Label& label) const {
  const volume::GridGeometry& source = patient_.labels.geometry;
  Box box{source.size, {-1, -1, -1}};
  for (std::size_t n = 0; n < patient_.labels.voxels.size(); ++n) {
    if (patient_.labels.voxels[n] != label.id) continue;
    const volume::Index3 at = source.index_of(n);
    for (std::size_t a = 0; a < 3; ++a) {
      box.low[a] = std::min(box.low[a], at[a]);
      box.high[a] = std::max(box.high[a], at[a]);
    }
  }
  if (box.high[0] < 0) return box;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto margin =
        static_cast<std::int64_t>(std::ceil(kVesselMargin_mm / source.spacing_mm[static_cast<Eigen::Index>(a)]));
    box.low[a] = std::max<std::int64_t>(box.low[a] - margin, 0);
    box.high[a] = std::min(box.high[a] + margin, source.size[a] - 1);
  }
  return box;
}

/// The part of the flow's grid that covers a box of the labels.
volume::GridGeometry VesselFlowMaker::flow_grid_over(const Box& box) const {
  const volume::GridGeometry& source = patient_.labels.geometry;
  volume::GridGeometry piece = flow_->geometry_;
  Vec3 low;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double scale = source.spacing_mm[axis] / piece.spacing_mm[axis];
    const auto first = static_cast<std::int64_t>(std::floor(static_cast<double>(box.low[a]) * scale));
    const auto end = static_cast<std::int64_t>(std::ceil(static_cast<double>(box.high[a] + 1) * scale));
    piece.size[a] = std::min(end, flow_->geometry_.size[a]) - first;
    low[axis] = static_cast<double>(first);
  }
  piece.origin_P = flow_->geometry_.to_mm(low);
  return piece;
}

volume::FloatGrid VesselFlowMaker::depth_of(const volume::MaskGrid& mask, const volume::GridGeometry& target) const {
  const volume::FloatGrid distance_mm = volume::signed_distance_mm(mask);
  volume::FloatGrid depth_mm(target);
  parallel_for(depth_mm.voxels.size(), 4096, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n)
      depth_mm.voxels[n] =
          static_cast<float>(-volume::sample_linear(distance_mm, target.centre_mm(target.index_of(n))));
  });
  return depth_mm;
}

VesselFlowMaker::Lumen VesselFlowMaker::find_lumen(const anatomy::Label& label) const {
  const Box box = box_of(label);
  if (box.high[0] < 0) return {};
  volume::GridGeometry cut = patient_.labels.geometry;
  for (std::size_t a = 0; a < 3; ++a) cut.size[a] = box.high[a] - box.low[a] + 1;
  cut.origin_P = patient_.labels.geometry.centre_mm(box.low);
  volume::MaskGrid own(cut);
  volume::MaskGrid joining(cut);
  const std::array<bool, 256> joins = find_joining(label);
  bool has_joining = false;
  for (std::size_t n = 0; n < own.voxels.size(); ++n) {
    const volume::Index3 at = cut.index_of(n);
    const std::uint8_t id = patient_.labels[{at[0] + box.low[0], at[1] + box.low[1], at[2] + box.low[2]}];
    own.voxels[n] = id == label.id ? 1 : 0;
    joining.voxels[n] = joins[id] ? 1 : 0;
    has_joining = has_joining || joins[id];
  }
  const volume::GridGeometry target = flow_grid_over(box);
  Lumen lumen{depth_of(own, target), {}};
  if (!has_joining) {
    lumen.joined = lumen.own;
    return lumen;
  }
  const volume::FloatGrid from_own_mm = volume::distance_to_mask_mm(own);
  for (std::size_t n = 0; n < own.voxels.size(); ++n)
    if (joining.voxels[n] != 0 && static_cast<double>(from_own_mm.voxels[n]) <= kJoins_mm) own.voxels[n] = 1;
  lumen.joined = depth_of(own, target);
  return lumen;
}

void VesselFlowMaker::add(const anatomy::Label& label) {
  const FlowRule* rule = flow_->table_.find(label.name, patient_.label_table);
  const Lumen lumen = rule != nullptr ? find_lumen(label) : Lumen{};
  const std::vector<volume::CentrelineTree> trees =
      lumen.own.empty() ? std::vector<volume::CentrelineTree>{}
                        : volume::find_centrelines(lumen.joined, options_.least_vessel_mm3);
  if (trees.empty()) {
    flow_->without_flow_.push_back(label.name);
    return;
  }
  double widest_mm = 0.0;
  for (const volume::CentrelineTree& tree : trees)
    for (const volume::CentrelineNode& node : tree.nodes) widest_mm = std::max(widest_mm, node.radius_mm);
  const auto sources = detail::find_sources(patient_, label.id, *rule, trees);
  const std::size_t first_branch = flow_->branches_.size();
  for (std::size_t t = 0; t < trees.size(); ++t)
    add_tree(trees[t], detail::flows_from_root(trees[t], sources[t]), label, *rule, widest_mm);
  fill(lumen, first_branch);
}

void VesselFlowMaker::add_tree(const volume::CentrelineTree& tree, const std::vector<bool>& from_root,
                               const anatomy::Label& label, const FlowRule& rule, double widest_mm) {
  for (std::size_t n = 0; n < tree.nodes.size(); ++n) {
    const volume::CentrelineNode& node = tree.nodes[n];
    if (n == 0 || node.parent != static_cast<int>(n) - 1)
      flow_->branches_.push_back({label.id, rule.name, rule.waveform, rule.profile_exponent, {}});
    const double narrowed = std::pow(node.radius_mm / widest_mm, rule.narrowing_exponent);
    const double peak_mm_per_s = std::min(10.0 * rule.peak_cm_per_s * narrowed, kMostSpeed_mm_per_s);
    flow_->branches_.back().points.push_back({node.p_P, from_root[n] ? node.tangent_P : Vec3(-node.tangent_P),
                                              node.radius_mm, peak_mm_per_s, !node.is_within_parent});
  }
}

/// Velocities of the label's lumen.
void VesselFlowMaker::fill(const Lumen& lumen, std::size_t first_branch) {
  std::vector<Owner> owners;
  for (std::size_t b = first_branch; b < flow_->branches_.size(); ++b)
    for (std::size_t n = 0; n < flow_->branches_[b].points.size(); ++n)
      if (flow_->branches_[b].points[n].is_in_own_tube) owners.push_back({&flow_->branches_[b], n});
  const volume::GridGeometry& geometry = lumen.own.geometry;
  const auto edge_mm = static_cast<float>(0.5 * geometry.spacing_mm.mean());
  std::vector<std::size_t> voxels;
  for (std::size_t n = 0; n < lumen.own.voxels.size(); ++n)
    if (lumen.own.voxels[n] > -edge_mm) voxels.push_back(n);
  std::vector<VesselFlow::Cell> cells(voxels.size());
  parallel_for(voxels.size(), 256, [&](std::size_t first, std::size_t last) {
    for (std::size_t m = first; m < last; ++m) {
      const std::size_t n = voxels[m];
      const Vec3 p_P = geometry.centre_mm(geometry.index_of(n));
      const Owner& owner = find_owner(owners, p_P);
      const Vec3 velocity_P = velocity_at(owner, p_P, static_cast<double>(lumen.joined.voxels[n]));
      for (std::size_t a = 0; a < 3; ++a)
        cells[m].velocity_A[a] = static_cast<std::int16_t>(
            std::lround(velocity_P[static_cast<Eigen::Index>(a)] / static_cast<double>(kSpeedStep_mm_per_s)));
      const float share = std::min(0.5F + 0.5F * lumen.own.voxels[n] / edge_mm, 1.0F);
      cells[m].share = static_cast<std::uint8_t>(std::lround(255.0F * share));
      cells[m].waveform = static_cast<std::uint8_t>(owner.branch->waveform);
    }
  });
  const Vec3 low = flow_->geometry_.to_index(geometry.origin_P);
  for (std::size_t m = 0; m < voxels.size(); ++m) {
    volume::Index3 at = geometry.index_of(voxels[m]);
    for (std::size_t a = 0; a < 3; ++a) at[a] += std::llround(low[static_cast<Eigen::Index>(a)]);
    if (cells[m].share > 0) store(at, cells[m]);
  }
}

VesselFlow::Cell& VesselFlowMaker::cell(std::int64_t brick, std::int64_t offset) {
  std::int32_t& first = flow_->bricks_[static_cast<std::size_t>(brick)];
  if (first < 0) {
    first = static_cast<std::int32_t>(flow_->cells_.size());
    flow_->cells_.resize(flow_->cells_.size() + static_cast<std::size_t>(kBrickSide * kBrickSide * kBrickSide));
  }
  return flow_->cells_[static_cast<std::size_t>(first + offset)];
}

/// Stores into every brick with this voxel: its own, and those whose last row it is. Where vessels meet, the cell with
/// more lumen is kept.
void VesselFlowMaker::store(const volume::Index3& at, const VesselFlow::Cell& value) {
  for (int n = 0; n < 8; ++n) {
    volume::Index3 brick, within;
    bool has = true;
    for (std::size_t a = 0; a < 3; ++a) {
      const bool is_last = (n >> a & 1) != 0;
      brick[a] = at[a] / kBrick - (is_last ? 1 : 0);
      within[a] = is_last ? kBrick : at[a] % kBrick;
      has = has && !(is_last && (at[a] % kBrick != 0 || brick[a] < 0));
    }
    if (!has) continue;
    const auto& count = flow_->brick_count_;
    VesselFlow::Cell& kept = cell((brick[2] * count[1] + brick[1]) * count[0] + brick[0],
                                  (within[2] * kBrickSide + within[1]) * kBrickSide + within[0]);
    if (kept.share < value.share) kept = value;
  }
}

std::shared_ptr<const VesselFlow> VesselFlowMaker::finish() {
  flow_->cells_.shrink_to_fit();
  return std::move(flow_);
}

}  // namespace trocar::ultrasound
