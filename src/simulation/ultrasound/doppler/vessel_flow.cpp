#include "ultrasound/doppler/vessel_flow.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/check.h"
#include "ultrasound/doppler/detail/vessel_flow_maker.h"

namespace trocar::ultrasound {

VesselFlow::Moment VesselFlow::moment(double time_s, double breath_phase) const noexcept {
  Moment values{};
  for (std::size_t n = 0; n < table_.waveforms.size(); ++n)
    values[n] = static_cast<float>(table_.waveforms[n].at(time_s, table_.heart_per_min, breath_phase));
  return values;
}

VesselFlow::Blood VesselFlow::at(const Vec3f& p_A, const Moment& moment) const noexcept {
  Blood blood;
  std::array<std::int32_t, 3> brick;
  std::array<std::int32_t, 3> cell;
  std::array<float, 3> part;
  for (std::size_t a = 0; a < 3; ++a) {
    const auto& row = index_of_P_[a];
    const float index = row[0] * p_A.x() + row[1] * p_A.y() + row[2] * p_A.z() + index_of_origin_[a];
    if (!(index >= 0.0F && index < static_cast<float>(kBrick * brick_count_[a]))) return blood;
    const auto whole = static_cast<std::int32_t>(index);
    part[a] = index - static_cast<float>(whole);
    brick[a] = whole >> kBrickBits;
    cell[a] = whole & (kBrick - 1);
  }
  const std::int32_t first =
      bricks_[static_cast<std::size_t>((brick[2] * brick_count_[1] + brick[1]) * brick_count_[0] + brick[0])];
  if (first < 0) return blood;
  const Cell* corner = cells_.data() + first + (cell[2] * kBrickSide + cell[1]) * kBrickSide + cell[0];
  for (int n = 0; n < 8; ++n) {
    const Cell& at = corner[(n & 1) + (n & 2) / 2 * kBrickSide + (n & 4) / 4 * kBrickSide * kBrickSide];
    if (at.share == 0) continue;
    const float weight = ((n & 1) != 0 ? part[0] : 1.0F - part[0]) * ((n & 2) != 0 ? part[1] : 1.0F - part[1]) *
                         ((n & 4) != 0 ? part[2] : 1.0F - part[2]);
    blood.share += weight * static_cast<float>(at.share);
    const float speed = weight * kSpeedStep_mm_per_s * moment[at.waveform];
    for (std::size_t a = 0; a < 3; ++a)
      blood.velocity_A[static_cast<Eigen::Index>(a)] += speed * static_cast<float>(at.velocity_A[a]);
  }
  blood.share /= 255.0F;
  return blood;
}

Vec3 VesselFlow::velocity_A(const Vec3& p_A, double time_s, double breath_phase) const noexcept {
  return at(p_A.cast<float>(), moment(time_s, breath_phase)).velocity_A.cast<double>();
}

bool is_vessel(const anatomy::Label& label) {
  return label.tissue == "vessel";
}

Result<std::shared_ptr<const VesselFlow>> make_vessel_flow(const anatomy::VirtualPatient& patient, FlowTable table,
                                                           const VesselFlowOptions& options, const Progress& progress,
                                                           const std::stop_token& stop) {
  TROCAR_CHECK(options.spacing_mm >= 0.3 && options.spacing_mm <= 3.0);
  TROCAR_CHECK(table.waveforms.size() <= VesselFlow::Moment{}.size());
  VesselFlowMaker maker(patient, std::move(table), options);
  const std::vector<anatomy::Label>& labels = patient.label_table.labels;
  for (std::size_t n = 0; n < labels.size(); ++n) {
    if (!is_vessel(labels[n])) continue;
    if (stop.stop_requested()) return fail("the blood flow was not computed: cancelled", patient.name, "ask again");
    report(progress, "following " + labels[n].name, static_cast<double>(n) / static_cast<double>(labels.size()));
    maker.add(labels[n]);
  }
  std::shared_ptr<const VesselFlow> flow = maker.finish();
  if (!flow->branches().empty()) return flow;
  return fail(flow->without_flow().empty() ? "no labelled vessel" : "no flow data for the labelled vessels",
              patient.name,
              flow->without_flow().empty()
                  ? "label some: aorta, inferior_vena_cava, portal_vein_and_splenic_vein, hepatic_veins"
                  : fmt::format("add a row to flow.toml for {}", fmt::join(flow->without_flow(), ", ")));
}

}  // namespace trocar::ultrasound
