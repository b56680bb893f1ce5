#include "bench/benchmarks.h"

namespace trocar::bench {

// To add a benchmark, add its function to benchmarks.h and a line here.
const std::vector<Benchmark>& all_benchmarks() {
  static const std::vector<Benchmark> benchmarks{
      {"slice", "trilinear slices of a CT volume on one core, compared with VTK on two cores", run_slice_benchmark},
      {"haptics", "one haptic tick, call by call, with a fixed calculation for comparison", run_haptics_benchmark},
      {"session", "30 simulated seconds at 1 kHz with recording, and the whole process", run_session_benchmark},
      {"insertion",
       "forces along the planned path: skin under the needle, peaks by speed, drops, second insertion",
       run_insertion_benchmark,
       {"--patient", "--patient-seed"}},
      {"palpation", "fingertip and transducer on the skin: forces by position, and one tick", run_palpation_benchmark},
      {"paths",
       "forces of partly against fully segmented data along planned paths",
       run_paths_benchmark,
       {"--patient", "--patient-seed", "--task", "--paths", "--force-model", "--seed", "--out"}},
      {"cohort",
       "40 scripted novices on each patient: scores, and the path constraint's inward part and steps; minutes",
       run_cohort_benchmark,
       {"--patient", "--patient-seed", "--force-model"}},
      {"curves",
       "force along one needle path by each force model, and its punctures; plots with --out",
       run_curves_benchmark,
       {"--patient", "--patient-seed", "--force-model", "--out"}},
      {"stability",
       "every tissue, force model and device in closed loop, 60 simulated seconds each: minutes",
       run_stability_benchmark,
       {"--force-model", "--seed"}},
      {"coupling", "spring and damping of every device's coupling varied up to the limits of stability: minutes",
       run_coupling_benchmark},
      {"contact",
       "bone and the loss of resistance behind the ligamentum flavum, by device and force model",
       run_contact_benchmark,
       {"--force-model", "--seed"}},
      {"faults", "loops of 1 to 1000 ms on every simulated device with a moving hand, in simulated time",
       run_faults_benchmark},
      {"reconstruct", "volumes from tracked freehand sweeps; real ones against PLUS' own", run_reconstruct_benchmark},
      {"ultrasound", "B-mode frames of the embedded patient while the transducer moves, and what they allocate",
       run_ultrasound_benchmark},
      {"ultrasound-cost", "a B-mode frame by scanlines, depth, planes, threads and level of detail",
       run_ultrasound_cost_benchmark},
      {"panorama", "pictures sliced from a panorama while the transducer moves: covered, half covered, with a needle",
       run_panorama_benchmark},
      {"live",
       "live ultrasound of a moving transducer beside two 1 kHz servers and a drawing thread: pictures a second",
       run_live_benchmark,
       {"--seconds", "--force-model"}},
      {"link", "batches of ticks encoded and decoded, beside a fixed piece of arithmetic", run_link_benchmark},
      {"servers",
       "two live haptic servers, a drawing client and a busy process: lateness, ticks, missed deadlines",
       run_servers_benchmark,
       {"--seconds", "--rate", "--force-model"}},
      {"likeness",
       "simulated ultrasound of the liver compared with a recorded sweep: gray levels, speckle; an image with --out",
       run_likeness_benchmark,
       {"--patient", "--sequence", "--out"}},
  };
  return benchmarks;
}

}  // namespace trocar::bench
