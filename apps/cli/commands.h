#pragma once

#include <string>
#include <vector>

#include "cli/action.h"
#include "cli/output.h"

namespace trocar::cli {

// Each function adds its command with sub-commands to the program; parsing the command sets `action`.
void add_patient_commands(Command& program, Action& action);
void add_patient_report_commands(Command& patient, Action& action);   ///< Adds show, check and render to `patient`.
void add_patient_fetch_command(Command& patient, Action& action);     ///< Adds fetch to `patient`.
void add_patient_export_command(Command& patient, Action& action);    ///< Adds export to `patient`.
void add_patient_motion_command(Command& patient, Action& action);    ///< Adds motion to `patient`.
void add_patient_variants_command(Command& patient, Action& action);  ///< Adds variants to `patient`.
void add_plan_command(Command& program, Action& action);
void add_register_command(Command& program, Action& action);
void add_task_commands(Command& program, Action& action);
void add_run_command(Command& program, Action& action);
void add_session_commands(Command& program, Action& action);
void add_session_metrics_command(Command& session, Action& action);  ///< Adds metrics to `session`.
void add_learn_command(Command& program, Action& action);
void add_results_commands(Command& program, Action& action);
void add_exam_commands(Command& program, Action& action);
void add_serve_command(Command& program, Action& action);
void add_device_commands(Command& program, Action& action);
void add_link_commands(Command& program, Action& action);
void add_ultrasound_commands(Command& program, Action& action);
// Sub-commands of `ultrasound`: image; sweep; reconstruct; stitch; keypoints; views and transducers.
void add_ultrasound_image_command(Command& ultrasound, Action& action);
void add_ultrasound_sweep_command(Command& ultrasound, Action& action);
void add_ultrasound_reconstruct_command(Command& ultrasound, Action& action);
void add_ultrasound_stitch_command(Command& ultrasound, Action& action);
void add_ultrasound_keypoints_command(Command& ultrasound, Action& action);
void add_ultrasound_list_commands(Command& ultrasound, Action& action);
void add_xray_command(Command& program, Action& action);
/// `words` is the whole command line, which trocar-bench reads again.
void add_bench_command(Command& program, Action& action, std::vector<std::string> words);
/// Describes all commands of `program`, which must outlive `action`.
void add_completion_command(Command& program, Action& action);

}  // namespace trocar::cli
