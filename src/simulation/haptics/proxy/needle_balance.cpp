#include "haptics/proxy/needle_balance.h"

#include <algorithm>

namespace trocar::haptics {
NeedleBalance balance_needle(const NeedleDrive& drive, double tissue_n_per_mm, double proxy_mm) noexcept {
  const CouplingParams& coupling = drive.coupling;
  const double push_n = coupling.stiffness_n_per_mm * (drive.ahead_mm - drive.before_mm) -
                        tissue_n_per_mm * (drive.before_mm - proxy_mm) - drive.bed_n;
  const double slip_n = push_n - std::clamp(push_n, -drive.friction.dry_n, drive.friction.dry_n);
  const double denominator = coupling.stiffness_n_per_mm + tissue_n_per_mm + drive.bed_n_per_mm +
                             (coupling.damping_ns_per_mm + drive.friction.viscous_ns_per_mm) / drive.dt_s;
  NeedleBalance balance;
  const double way_mm = slip_n / denominator;
  balance.needle_mm = drive.before_mm + way_mm;
  balance.on_tip_n = tissue_n_per_mm * (balance.needle_mm - proxy_mm);
  balance.on_bed_n = drive.bed_n + drive.bed_n_per_mm * way_mm;
  balance.on_shaft_n = coupling.stiffness_n_per_mm * (drive.ahead_mm - balance.needle_mm) -
                       coupling.damping_ns_per_mm * way_mm / drive.dt_s - balance.on_tip_n - balance.on_bed_n;
  const double follow = slip_n != 0.0 ? tissue_n_per_mm / denominator : 0.0;
  balance.tip_n_per_mm = tissue_n_per_mm * (1.0 - follow);
  return balance;
}

}  // namespace trocar::haptics
