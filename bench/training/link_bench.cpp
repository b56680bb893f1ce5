// Encoding and decoding of batches of ticks: what a server pays 200 times a second for each client, and a client for
// each server.

#include <fmt/format.h>

#include <array>

#include "bench/benchmarks.h"
#include "bench/calibration.h"
#include "core/random.h"
#include "link/codec.h"

namespace trocar::bench {
namespace {

constexpr int kBatchesPerRound = 4000;  ///< Batches a round.

struct Measured {
  Figures encode, decode, calibration;
};

/// A batch as the needle's server sends it: forces and poses that differ from tick to tick.
link::ServerMessage make_batch(std::size_t ticks) {
  Random random(1);
  const auto vector = [&] { return Vec3(random.normal(), random.normal(), random.normal()); };
  link::StateBatch batch;
  batch.samples.resize(ticks);
  for (telemetry::TickSample& sample : batch.samples) {
    sample.time_s = random.uniform();
    sample.tip_mm = sample.device_mm = vector();
    sample.axis = vector().normalized();
    sample.f_total_n = sample.device_f_n = vector();
    sample.f_friction_n = random.normal();
    sample.phase = telemetry::InsertionPhase::kInserted;
    sample.gate_mode = telemetry::GateMode::kOn;
  }
  return {1, 1, std::move(batch)};
}

Result<Measured> measure_round(const link::ServerMessage& message) {
  std::vector<double> encode_us, decode_us, calibration_us;
  double sum = 1.0;
  for (int i = 0; i < kBatchesPerRound; ++i) {
    link::Bytes bytes;
    encode_us.push_back(time_us([&] { bytes = link::encode(message); }));
    std::optional<Result<link::ServerMessage>> decoded;
    decode_us.push_back(time_us([&] { decoded = link::decode_server_message(bytes); }));
    if (!*decoded) return tl::unexpected(decoded->error());
    calibration_us.push_back(time_us([&] { sum = calibration_arithmetic(sum); }));
  }
  if (sum > 1e9) return fail("the calibration gave a wrong number", "link", "run the benchmark again");
  return Measured{figures_of(std::move(encode_us)), figures_of(std::move(decode_us)),
                  figures_of(std::move(calibration_us))};
}

/// The best median of each, over the rounds.
Result<Measured> measure(const link::ServerMessage& message) {
  TROCAR_TRY(Measured best, measure_round(message));
  for (int round = 1; round < kRounds; ++round) {
    TROCAR_TRY(const Measured next, measure_round(message));
    for (Figures Measured::*figures : {&Measured::encode, &Measured::decode, &Measured::calibration})
      if (*(next.*figures).median < *(best.*figures).median) best.*figures = next.*figures;
  }
  return best;
}

}  // namespace

Result<std::vector<CaseResult>> run_link_benchmark() {
  std::vector<CaseResult> results;
  // Ticks of a batch at 1 kHz and at 4 kHz, and of the largest one.
  for (const std::size_t ticks : {std::size_t{5}, std::size_t{20}, link::kMostSamples}) {
    TROCAR_TRY(const Measured measured, measure(make_batch(ticks)));
    if (results.empty())
      results.push_back({"calibration/arithmetic", "us", measured.calibration, {}, "a fixed loop, after each batch"});
    results.push_back({fmt::format("link/encode-{}", ticks), "us", measured.encode, {}, "one batch"});
    results.push_back({fmt::format("link/decode-{}", ticks), "us", measured.decode, {}, "one batch"});
  }
  return results;
}

}  // namespace trocar::bench
