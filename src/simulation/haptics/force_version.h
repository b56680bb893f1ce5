#pragma once

namespace trocar::haptics {

/// Version of the forces: increases with every change after which a tick gives other forces or another motion for the
/// same inputs (tests/same_bits). Recordings contain it. 1: every program before the first release, whose recordings
/// have none.
inline constexpr int kForceVersion = 2;

}  // namespace trocar::haptics
