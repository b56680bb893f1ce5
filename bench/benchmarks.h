#pragma once

#include <vector>

#include "bench/harness.h"

/// Functions of the benchmark files for registry.cpp, one line per benchmark.
namespace trocar::bench {

/// Slices and points of a volume, against vtkImageReslice.
Result<std::vector<CaseResult>> run_slice_benchmark();
/// One haptic tick, compared with a fixed arithmetic calculation.
Result<std::vector<CaseResult>> run_haptics_benchmark();
/// A whole attempt of 30 simulated seconds, and the whole process.
Result<std::vector<CaseResult>> run_session_benchmark();
/// Opening a case of an embedded patient: the first time and again, with its parts and the peak of memory.
Result<std::vector<CaseResult>> run_open_benchmark(const Options& options);
Result<std::vector<CaseResult>> run_cancel_benchmark(const Options& options);
/// Forces of an insertion into the embedded patient: peaks, drops, second insertion.
Result<std::vector<CaseResult>> run_insertion_benchmark(const Options& options);
/// Partly segmented data compared with fully segmented data along planned paths: the study of the Luebeck group.
Result<std::vector<CaseResult>> run_paths_benchmark(const Options& options);
/// Novices with many seeds on the embedded patient and on the real CTs: scores, and the path constraint tick by tick.
Result<std::vector<CaseResult>> run_cohort_benchmark(const Options& options);
/// The expert of every task with each structure on the way to the target: score and verdict.
Result<std::vector<CaseResult>> run_harm_benchmark(const Options& options);
/// Force along one needle path as a curve, by each force model.
Result<std::vector<CaseResult>> run_curves_benchmark(const Options& options);
/// Peaks of the layers of the same paths from 1 to 50 mm/s; the figure is that at 50 over that at 1 mm/s.
Result<std::vector<CaseResult>> run_speeds_benchmark(const Options& options);
/// Every tissue, force model, device and holder in closed loop: the loop comes to rest and generates no energy.
Result<std::vector<CaseResult>> run_stability_benchmark(const Options& options);
/// Needle pushed on bone and through the ligamentum flavum, by device and force model.
Result<std::vector<CaseResult>> run_coupling_benchmark(const Options& options);
Result<std::vector<CaseResult>> run_contact_benchmark(const Options& options);
/// Random closed motions of a prescribed tool: the force models return no more energy than they were given.
Result<std::vector<CaseResult>> run_passivity_benchmark(const Options& options);
/// Slow loops on every simulated device with a moving hand: time to zero force, force, travel.
Result<std::vector<CaseResult>> run_faults_benchmark(const Options& options);
/// Fingertip and transducer on the embedded patient: force (N) per place, and time of a tick.
Result<std::vector<CaseResult>> run_palpation_benchmark();
/// Encoding and decoding of batches of ticks.
Result<std::vector<CaseResult>> run_link_benchmark();
/// A stop after 150 starts, 10,000 times, and control passed under such a flood: no stop is lost, time until it is
/// seen.
Result<std::vector<CaseResult>> run_stops_benchmark(const Options& options);
/// Two live servers, a drawing client and a busy process: rate, lateness, ticks, missed deadlines.
Result<std::vector<CaseResult>> run_servers_benchmark(const Options& options);
/// Volumes from tracked freehand sweeps; with the test data, compared with the volume of PLUS.
Result<std::vector<CaseResult>> run_ct_us_benchmark(const Options& options);
Result<std::vector<CaseResult>> run_reconstruct_benchmark();
/// 3D SIFT: keypoints, descriptors, matches of 13,500 by 13,500.
Result<std::vector<CaseResult>> run_sift_benchmark();
/// Stitched volumes with known poses: generated ones, sweeps of the embedded patient, parts of recorded sweeps.
Result<std::vector<CaseResult>> run_stitch_benchmark(const Options& options);
/// Simulated ultrasound compared with a recorded sweep: gray levels, speckle size, an image of both.
Result<std::vector<CaseResult>> run_likeness_benchmark(const Options& options);
/// Ultrasound frames of the embedded patient while the transducer moves.
Result<std::vector<CaseResult>> run_ultrasound_benchmark(const Options& options);
/// Frames of the panorama engine while the transducer moves: fully covered, half covered, with a needle.
Result<std::vector<CaseResult>> run_panorama_benchmark(const Options& options);
/// Cost of an ultrasound frame against scanlines, depth, planes, threads and level of detail.
Result<std::vector<CaseResult>> run_ultrasound_cost_benchmark(const Options& options);
/// X-ray projections beside plastimatch's, the polyenergetic signal, frames of a turning C-arm.
Result<std::vector<CaseResult>> run_xray_benchmark(const Options& options);
/// Live ultrasound beside two live servers and a drawing thread: renewed pictures a second.
Result<std::vector<CaseResult>> run_live_benchmark(const Options& options);
/// `trocar serve` with 100,000 simulated attempts: the first answer of every page, 200 readers at the same time.
Result<std::vector<CaseResult>> run_serve_benchmark(const Options& options);

}  // namespace trocar::bench
