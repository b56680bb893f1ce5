#include "cli/bench_arguments.h"

#include "cli/patient_option.h"

namespace trocar::cli {

void add_bench_options(Command& command, BenchArguments& a) {
  command.add_option("NAME", a.names, "Benchmarks to run, see --list; default: all");
  command.add_flag("--list", a.is_list, "List the benchmarks with their options");
  command.add_flag("--json", a.is_json, "Print one JSON object; with several benchmarks a list under \"benches\"");
  command.add_option("--patient", a.source.folder_or_name, "Patient folder, or an embedded patient's name");
  command.add_option("--patient-seed", a.source.seed, "Random seed for the anatomy of an embedded patient")
      .seed()
      .show_default();
  add_cache_option(command, a.source);
  command.add_option("--task", a.options.task, "Task whose paths are planned").show_default();
  command.add_option("--paths", a.options.paths, "paths: number of planned paths")
      .whole_number_within(1, 100000)
      .show_default();
  command.add_flag("--unlabelled", a.options.is_unlabelled,
                   "paths: leave out the fat, muscle and gas that a build finds from HU in a partly segmented patient");
  command.add_option(
      "--force-model", a.force_model,
      "paths, speeds: force model, insertion, proxy or combined; default: proxy in paths, all in speeds");
  const auto motions = command.add_option("--motions", a.options.motions, "passivity: number of random closed motions")
                           .whole_number_within(1, 1000000)
                           .show_default();
  const auto model = command
                         .add_option("--model", a.options.model,
                                     "passivity: force model of a needle, or a face on the skin; default: all")
                         .one_of({"insertion", "proxy", "combined", "probe", "finger"});
  command.add_option("--only", a.options.only, "passivity: run one random motion, by its number")
      .whole_number_within(0, 999999)
      .excludes(motions)
      .excludes(model);
  command.add_option("--seed", a.options.seed, "Random seed for the choice of paths and the motion")
      .seed()
      .show_default();
  command.add_option("--seconds", a.options.seconds, "Measuring time of live servers")
      .number_within(1.0, 86400.0, "s")
      .show_default();
  command.add_option("--rate", a.options.rates_hz, "Rate of the live servers; can be given several times")
      .number_within(250.0, 4000.0, "Hz")
      .show_default();
  command.add_option("--sequence", a.options.sequence,
                     "likeness: recorded ultrasound (.igs.mha) for the comparison of images");
  command.add_option("--out", a.options.out, "Folder to create for the benchmark's files");
  command.footer(
      "Examples:\n  trocar bench --list\n  trocar bench slice --json\n  trocar bench paths --patient my_patient "
      "--paths 2000\n");
}

}  // namespace trocar::cli
