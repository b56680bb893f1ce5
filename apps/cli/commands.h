#pragma once

#include <CLI/App.hpp>

#include "output.h"

namespace trocar::cli {

// Each function adds its command with sub-commands to the program; parsing the command sets `action`.
void add_patient_commands(CLI::App& program, Action& action);
void add_patient_report_commands(CLI::App& patient, Action& action);   ///< Adds show, check and render to `patient`.
void add_patient_fetch_command(CLI::App& patient, Action& action);     ///< Adds fetch to `patient`.
void add_patient_variants_command(CLI::App& patient, Action& action);  ///< Adds variants to `patient`.
void add_plan_command(CLI::App& program, Action& action);
void add_register_command(CLI::App& program, Action& action);
void add_task_commands(CLI::App& program, Action& action);
void add_run_command(CLI::App& program, Action& action);
void add_session_commands(CLI::App& program, Action& action);
void add_session_metrics_command(CLI::App& session, Action& action);  ///< Adds metrics to `session`.
void add_learn_command(CLI::App& program, Action& action);
void add_results_commands(CLI::App& program, Action& action);
void add_exam_commands(CLI::App& program, Action& action);
void add_serve_command(CLI::App& program, Action& action);
void add_device_commands(CLI::App& program, Action& action);
void add_link_commands(CLI::App& program, Action& action);
void add_ultrasound_commands(CLI::App& program, Action& action);
// Sub-commands of `ultrasound`: image; sweep; reconstruct; stitch; keypoints; views and transducers.
void add_ultrasound_image_command(CLI::App& ultrasound, Action& action);
void add_ultrasound_sweep_command(CLI::App& ultrasound, Action& action);
void add_ultrasound_reconstruct_command(CLI::App& ultrasound, Action& action);
void add_ultrasound_stitch_command(CLI::App& ultrasound, Action& action);
void add_ultrasound_keypoints_command(CLI::App& ultrasound, Action& action);
void add_ultrasound_list_commands(CLI::App& ultrasound, Action& action);
void add_xray_command(CLI::App& program, Action& action);
void add_bench_command(CLI::App& program, Action& action);
/// Describes all commands of `program`, which must outlive `action`.
void add_completion_command(CLI::App& program, Action& action);

}  // namespace trocar::cli
