// trocar ultrasound: images, sweeps and volumes; each sub-command has its own file.

#include "cli/commands.h"

namespace trocar::cli {

void add_ultrasound_commands(Command& program, Action& action) {
  Command ultrasound = program.add_command("ultrasound", "Ultrasound images, sweeps and volumes");
  ultrasound.require_command();
  ultrasound.footer(
      "Examples:\n  trocar ultrasound image --patient abdomen --view liver-right-kidney --out kidney.png\n"
      "  trocar ultrasound reconstruct sweep.igs.mha --spacing 0.5 --out volume.nrrd\n"
      "  trocar ultrasound stitch left.nrrd middle.nrrd right.nrrd --out panorama.nrrd --transforms poses\n");
  add_ultrasound_image_command(ultrasound, action);
  add_ultrasound_sweep_command(ultrasound, action);
  add_ultrasound_reconstruct_command(ultrasound, action);
  add_ultrasound_stitch_command(ultrasound, action);
  add_ultrasound_keypoints_command(ultrasound, action);
  add_ultrasound_list_commands(ultrasound, action);
}

}  // namespace trocar::cli
