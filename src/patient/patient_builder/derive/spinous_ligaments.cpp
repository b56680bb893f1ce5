#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "patient_builder/derive/detail/canal.h"

namespace trocar::patient_builder::detail {
namespace {

// Assumed lengths.
constexpr double kBandMm = 10.0;             // a spinous process lies this near to the canal's middle
constexpr double kDeepestTipMm = 90.0;       // from the canal's centre to its tip
constexpr double kSpinousMm = 10.0;          // shorter than this behind the wall it is a lamina
constexpr double kBluntMm = 8.0;             // the tip's rounded end
constexpr double kLongestTipGapMm = 40.0;    // between two tips
constexpr double kInterspinousHalfMm = 3.0;  // half the width
constexpr double kSupraspinousHalfMm = 4.0;
constexpr double kSupraspinousMm = 4.0;  // thickness
// The supraspinous ligament ends at L4 or L5 (Rissanen 1960): it is made down to the interspace L4-L5.
constexpr std::uint8_t kLastSupraspinous = kL5;

/// The tip of a spinous process in one axial slice, or the line between two tips. Voxel indices.
struct Tip {
  double i = 0.0, j = 0.0;            ///< j: its border.
  std::uint8_t above = 0, below = 0;  ///< Places of the vertebrae; the same in a spinous process. 0: none.

  bool is_found() const noexcept { return above != 0; }
  bool is_gap() const noexcept { return above != below; }
};

class SpinousLigaments {
 public:
  SpinousLigaments(DerivedLabels& labels, const SpineLabels& spine, const Canal& canal, const PosteriorWall& wall)
      : labels_(labels), spine_(spine), canal_(canal), wall_(wall), tips_(canal.slices.size()) {
    for (std::int64_t k = canal.first_k; k <= canal.last_k(); ++k) tip(k) = find_tip(k);
    remove_lamina_levels();
    bridge_gaps();
  }

  void add_interspinous() {
    const std::uint8_t id = labels_.add("interspinous_ligament");
    for (std::int64_t k = canal_.first_k; k <= canal_.last_k(); ++k) {
      const CanalSlice* slice = canal_.at(k);
      if (slice == nullptr || !tip(k).is_found()) continue;
      const PosteriorWall::Cell& c = wall_.at(std::lround(slice->i), k);
      if (!c.is_known() || !(tip(k).is_gap() || c.is_gap())) continue;
      paint_plane(*slice, c.face_j, tip(k), k, id);
    }
  }

  void add_supraspinous() {
    const std::uint8_t id = labels_.add("supraspinous_ligament");
    const Vec3& spacing = labels_.geometry().spacing_mm;
    for (std::int64_t k = canal_.first_k; k <= canal_.last_k(); ++k) {
      const Tip& t = tip(k);
      if (!t.is_found() || t.below > kLastSupraspinous || (t.below == kLastSupraspinous && !t.is_gap())) continue;
      const auto first = static_cast<std::int64_t>(std::ceil(t.j));
      for (std::int64_t j = first; j == first || static_cast<double>(j) - t.j <= kSupraspinousMm / spacing.y(); ++j)
        paint_row(t.i, kSupraspinousHalfMm, j, k, id);
    }
  }

 private:
  Tip& tip(std::int64_t k) { return tips_[static_cast<std::size_t>(k - canal_.first_k)]; }

  Tip find_tip(std::int64_t k) const {
    const CanalSlice* slice = canal_.at(k);
    if (slice == nullptr) return {};
    const volume::GridGeometry& g = labels_.geometry();
    const auto steps = [](double mm, double spacing_mm) { return static_cast<std::int64_t>(mm / spacing_mm); };
    const auto middle = std::lround(slice->i), start = std::lround(slice->j);
    const std::int64_t band = steps(kBandMm, g.spacing_mm.x());
    for (std::int64_t j = std::min(g.size[1] - 1, start + steps(kDeepestTipMm, g.spacing_mm.y())); j > start; --j) {
      double sum = 0.0, count = 0.0;
      std::uint8_t place = 0;
      for (std::int64_t i = std::max<std::int64_t>(0, middle - band); i <= std::min(g.size[0] - 1, middle + band);
           ++i) {
        const std::uint8_t here = spine_.place[labels_.at(g.offset({i, j, k}))];
        if (here == 0) continue;
        place = here;
        sum += static_cast<double>(i);
        count += 1.0;
      }
      if (place != 0) return {sum / count, static_cast<double>(j) + 0.5, place, place};
    }
    return {};
  }

  /// Slices that contain only a lamina, or only the upper or lower end of the process.
  void remove_lamina_levels() {
    const double spacing_mm = labels_.geometry().spacing_mm.y();
    std::array<double, 28> farthest{};
    for (const Tip& t : tips_) farthest[t.above] = std::max(farthest[t.above], t.j);
    for (std::int64_t k = canal_.first_k; k <= canal_.last_k(); ++k) {
      Tip& t = tip(k);
      if (!t.is_found()) continue;
      const PosteriorWall::Cell& c = wall_.at(std::lround(canal_.at(k)->i), k);
      const bool is_lamina = c.is_known() && (t.j - c.face_j) * spacing_mm < kSpinousMm;
      if (is_lamina || (farthest[t.above] - t.j) * spacing_mm > kBluntMm) t = {};
    }
  }

  void bridge_gaps() {
    const auto longest = static_cast<std::int64_t>(kLongestTipGapMm / labels_.geometry().spacing_mm.z());
    std::int64_t below_k = canal_.first_k - 1;
    for (std::int64_t k = canal_.first_k; k <= canal_.last_k(); ++k) {
      if (!tip(k).is_found()) continue;
      if (below_k >= canal_.first_k && k - below_k > 1 && k - below_k <= longest) {
        const Tip low = tip(below_k), high = tip(k);
        for (std::int64_t m = below_k + 1; are_neighbours(high.above, low.above) && m < k; ++m) {
          const double f = static_cast<double>(m - below_k) / static_cast<double>(k - below_k);
          tip(m) = {low.i + f * (high.i - low.i), low.j + f * (high.j - low.j), high.above, low.above};
        }
      }
      below_k = k;
    }
  }

  /// From the canal's wall to the tip, in the plane between them.
  void paint_plane(const CanalSlice& slice, double face_j, const Tip& t, std::int64_t k, std::uint8_t id) {
    for (auto j = static_cast<std::int64_t>(std::ceil(face_j)); static_cast<double>(j) < t.j; ++j) {
      const double f = (static_cast<double>(j) - face_j) / std::max(t.j - face_j, 1.0);
      paint_row(slice.i + f * (t.i - slice.i), kInterspinousHalfMm, j, k, id);
    }
  }

  void paint_row(double middle_i, double half_mm, std::int64_t j, std::int64_t k, std::uint8_t id) {
    const volume::GridGeometry& g = labels_.geometry();
    const double half = half_mm / g.spacing_mm.x();
    const std::int64_t nearest = std::lround(middle_i);
    const auto reach = static_cast<std::int64_t>(std::ceil(half));
    for (std::int64_t i = nearest - reach; i <= nearest + reach; ++i) {
      const bool is_inside = i == nearest || std::abs(static_cast<double>(i) - middle_i) <= half;
      if (is_inside && g.contains({i, j, k})) labels_.paint(g.offset({i, j, k}), id);
    }
  }

  DerivedLabels& labels_;
  const SpineLabels& spine_;
  const Canal& canal_;
  const PosteriorWall& wall_;
  std::vector<Tip> tips_;
};

}  // namespace

void derive_spinous_ligaments(DerivedLabels& labels, const SpineLabels& spine, const Canal& canal,
                              const PosteriorWall& wall, const DeriveChoice& choice) {
  const auto is_wanted = [&](const char* name) { return choice.has(name) && !labels.is_labelled(name); };
  const bool inter = is_wanted("interspinous_ligament"), supra = is_wanted("supraspinous_ligament");
  if (!inter && !supra) return;
  SpinousLigaments ligaments(labels, spine, canal, wall);
  if (inter) ligaments.add_interspinous();
  if (supra) ligaments.add_supraspinous();
}

}  // namespace trocar::patient_builder::detail
