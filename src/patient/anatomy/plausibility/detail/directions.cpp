#include "anatomy/plausibility/detail/directions.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>

#include "anatomy/derive/detail/spine_labels.h"
#include "anatomy/detail/structure_pattern.h"

namespace trocar::anatomy::detail {
namespace {

/// Centroid of a group of structures and its volume.
struct Place {
  Vec3 sum_P = Vec3::Zero();
  double voxels = 0.0;
  Vec3 middle_P() const { return sum_P / voxels; }
};

constexpr double kSmallest_ml = 0.5;

/// The places of structures by the group that they belong to: "liver", "spine", "kidney".
class Places {
 public:
  Places(const volume::LabelGrid& labels, const LabelTable& table) : labels_(labels) {
    sum_up();
    for (const Label& label : table.labels) {
      if (label.is_derived) continue;
      const std::string plain = without_side(plain_name(label.name));
      add(group_of(plain, label), label.id);
      if (const int place = vertebra_place(label.name); place > 0) vertebrae_[place] = places_[label.id];
    }
  }

  /// `name` as in a segmentation, or "spine", "lung", "heart".
  std::optional<Vec3> find(std::string_view name) const {
    const auto found = groups_.find(plain_name(name));
    if (found == groups_.end()) return std::nullopt;
    const double ml = found->second.voxels * labels_.geometry.voxel_volume_mm3() / 1000.0;
    return ml < kSmallest_ml ? std::nullopt : std::optional(found->second.middle_P());
  }
  /// Middles of the vertebrae from head to feet.
  std::vector<Vec3> vertebrae() const {
    std::vector<Vec3> middles;
    for (const auto& [place, where] : vertebrae_)
      if (where.voxels > 0.0) middles.push_back(where.middle_P());
    return middles;
  }

 private:
  static std::string group_of(const std::string& plain, const Label& label) {
    if (vertebra_place(label.name) > 0) return "spine";
    if (plain.starts_with("lung")) return "lung";
    if (plain.starts_with("heart") || plain == "atrium" || plain == "ventricle") return "heart";
    return plain;
  }
  void add(const std::string& group, std::uint8_t id) {
    groups_[group].sum_P += places_[id].sum_P;
    groups_[group].voxels += places_[id].voxels;
  }
  void sum_up() {
    const volume::GridGeometry& g = labels_.geometry;
    std::array<std::array<double, 4>, 256> sums{};
    std::size_t n = 0;
    for (std::int64_t k = 0; k < g.size[2]; ++k)
      for (std::int64_t j = 0; j < g.size[1]; ++j)
        for (std::int64_t i = 0; i < g.size[0]; ++i, ++n) {
          auto& sum = sums[labels_.voxels[n]];
          sum[0] += static_cast<double>(i), sum[1] += static_cast<double>(j), sum[2] += static_cast<double>(k);
          sum[3] += 1.0;
        }
    for (std::size_t id = 1; id < 256; ++id) {
      if (sums[id][3] == 0.0) continue;
      const Vec3 middle = Vec3(sums[id][0], sums[id][1], sums[id][2]) / sums[id][3];
      places_[id] = {g.to_mm(middle) * sums[id][3], sums[id][3]};
    }
  }

  const volume::LabelGrid& labels_;
  std::array<Place, 256> places_{};
  std::map<std::string, Place, std::less<>> groups_;
  std::map<int, Place> vertebrae_;
};

void vote(AxisVotes& votes, double offset_mm, double clear_mm, const std::string& wrong) {
  if (offset_mm > clear_mm) ++votes.right;
  if (offset_mm >= -clear_mm) return;
  ++votes.wrong;
  votes.wrong_ones.push_back(wrong);
}

/// Organs of one side; `sign` is their side along x of P (left is positive).
struct OneSided {
  std::string_view name;
  double sign;
  double clear_mm;
};
constexpr std::array kOneSided{
    OneSided{"liver", -1, 15}, OneSided{"gallbladder", -1, 10}, OneSided{"spleen", 1, 15},  OneSided{"stomach", 1, 10},
    OneSided{"heart", 1, 5},   OneSided{"duodenum", -1, 10},    OneSided{"pancreas", 1, 15}};

AxisVotes vote_left_right(const Places& places) {
  AxisVotes votes;
  // The spine is in the middle; without one, the middle between a right and a left organ tells nothing new.
  if (const auto spine = places.find("spine")) {
    for (const OneSided& organ : kOneSided)
      if (const auto place = places.find(organ.name))
        vote(votes, organ.sign * (place->x() - spine->x()), organ.clear_mm,
             fmt::format("{} on the {}", organ.name, organ.sign > 0.0 ? "right" : "left"));
  } else if (const auto liver = places.find("liver")) {
    for (const char* name : {"spleen", "stomach"})
      if (const auto left = places.find(name))
        vote(votes, left->x() - liver->x(), 30.0, fmt::format("{} right of the liver", name));
  }
  const auto aorta = places.find("aorta"), cava = places.find("inferior_vena_cava");
  if (aorta && cava) vote(votes, aorta->x() - cava->x(), 5.0, "aorta right of the inferior vena cava");
  return votes;
}

AxisVotes vote_front_back(const Places& places) {
  AxisVotes votes;
  const auto spine = places.find("spine");
  if (!spine) return votes;
  for (const char* name : {"aorta", "inferior_vena_cava", "liver", "stomach", "pancreas", "small_bowel", "duodenum",
                           "urinary_bladder", "heart", "colon"})
    if (const auto place = places.find(name))
      vote(votes, spine->y() - place->y(), 5.0, fmt::format("{} behind the spine", name));
  if (const auto back = places.find("autochthon"))
    vote(votes, back->y() - spine->y(), 5.0, "back muscles in front of the spine");
  return votes;
}

AxisVotes vote_up_down(const Places& places) {
  AxisVotes votes;
  const std::vector<Vec3> vertebrae = places.vertebrae();
  for (std::size_t n = 1; n < vertebrae.size(); ++n)
    vote(votes, vertebrae[n - 1].z() - vertebrae[n].z(), 5.0, "vertebrae from feet to head");
  constexpr std::array<std::pair<const char*, const char*>, 7> kAbove{{{"lung", "urinary_bladder"},
                                                                       {"heart", "urinary_bladder"},
                                                                       {"lung", "kidney"},
                                                                       {"liver", "urinary_bladder"},
                                                                       {"liver", "femur"},
                                                                       {"kidney", "femur"},
                                                                       {"kidney", "urinary_bladder"}}};
  for (const auto& [upper, lower] : kAbove) {
    const auto above = places.find(upper), below = places.find(lower);
    if (above && below) vote(votes, above->z() - below->z(), 20.0, fmt::format("{} below {}", upper, lower));
  }
  return votes;
}

}  // namespace

std::array<AxisVotes, 3> vote_directions(const volume::LabelGrid& labels, const LabelTable& table) {
  const Places places(labels, table);
  return {vote_left_right(places), vote_front_back(places), vote_up_down(places)};
}

}  // namespace trocar::anatomy::detail
